# SPDX-License-Identifier: Zlib
#
# WebAssembly by Clang and WASI, with exceptions and without threads, as Emscripten has it; run by Node.js.
# HASHPHASE_WEB is the folder where tests/checks/web.sh has built the C++ library and others.

set(CMAKE_SYSTEM_NAME Generic)
set(CMAKE_SYSTEM_PROCESSOR wasm32)
set(CMAKE_TRY_COMPILE_PLATFORM_VARIABLES HASHPHASE_WEB)

foreach(language IN ITEMS C CXX)
    set(CMAKE_${language}_COMPILER_TARGET wasm32-wasi)
    # No GoogleTest that takes the standard output aside, which wants dup().
    set(CMAKE_${language}_FLAGS_INIT
        "-fwasm-exceptions -D_WASI_EMULATED_SIGNAL -D_WASI_EMULATED_PROCESS_CLOCKS -DGTEST_HAS_STREAM_REDIRECTION=0")
endforeach()
set(CMAKE_C_COMPILER clang-19)
set(CMAKE_CXX_COMPILER clang++-19)
find_program(CMAKE_AR llvm-ar-19 REQUIRED)
find_program(CMAKE_RANLIB llvm-ranlib-19 REQUIRED)
string(APPEND CMAKE_CXX_FLAGS_INIT
       " -nostdinc++ -isystem ${HASHPHASE_WEB}/include/c++/v1 -isystem ${CMAKE_CURRENT_LIST_DIR}")
# The stack is what the guide asks for; below it is nothing, so that what needs more ends the program.
set(CMAKE_EXE_LINKER_FLAGS_INIT "-L${HASHPHASE_WEB}/lib -Wl,-z,stack-size=1048576 -Wl,--stack-first")
set(CMAKE_CXX_STANDARD_LIBRARIES
    "-lc++ -lc++abi -lunwind -lwasi-emulated-signal -lwasi-emulated-process-clocks -lc-printscan-long-double")
set(CMAKE_EXECUTABLE_SUFFIX .wasm)

set(CMAKE_CROSSCOMPILING_EMULATOR node --no-warnings --single-threaded ${CMAKE_CURRENT_LIST_DIR}/run.mjs)

set(CMAKE_FIND_ROOT_PATH ${HASHPHASE_WEB})
set(CMAKE_FIND_ROOT_PATH_MODE_PROGRAM NEVER)
foreach(kind IN ITEMS LIBRARY INCLUDE PACKAGE)
    set(CMAKE_FIND_ROOT_PATH_MODE_${kind} ONLY)
endforeach()
