# SPDX-License-Identifier: Zlib
#
# cmake -DROOT=<repository> -DBINARY=<scratch folder> -DCOMPILER=<C++ compiler> -P check_optimisation.cmake
#
# A project that takes hashphase in by FetchContent and sets no build type gets optimised libraries without
# assertions, and one warning that says so; unless it sets a type, a level of optimisation or HASHPHASE_ASSERTS. In a
# Debug build it gets optimised libraries with assertions, unless it sets a level or HASHPHASE_DEBUG_OPTIMISE.
# Configures, and builds nothing.

cmake_minimum_required(VERSION 3.22)

# Checks the level of optimisation in the last option of it, and the assertions, with which the source is compiled.
function(check_source case commands source level asserts)
    string(REGEX MATCHALL "\"command\": [^\n]*/${source}\"" command "${commands}")
    list(LENGTH command count)
    string(REGEX MATCHALL " -O[^ ]*" levels "${command}")
    list(POP_BACK levels last)
    string(STRIP "${last}" last)
    if(NOT count EQUAL 1 OR NOT last STREQUAL level OR NOT command MATCHES "-DHASHPHASE_ENABLE_ASSERTS=${asserts} ")
        message(SEND_ERROR "${case}: ${source} is to be compiled with \"${level}\" and "
                           "HASHPHASE_ENABLE_ASSERTS=${asserts}:\n${command}")
    endif()
endfunction()

# expect(<case> <warning> <level> <asserts> [<argument>...]): given these arguments, CMake prints a warning with this
# text and no other, or none where it is empty; our source is compiled with this level of optimisation, and ours and
# the program's own with or without assertions.
function(expect case warning level asserts)
    file(REMOVE_RECURSE ${BINARY}/${case})
    execute_process(
        COMMAND
            ${CMAKE_COMMAND} -E env --unset=CXXFLAGS --unset=CMAKE_BUILD_TYPE ${CMAKE_COMMAND} -S
            ${CMAKE_CURRENT_LIST_DIR}/fetch_content -B ${BINARY}/${case} -G Ninja -DHASHPHASE=${ROOT}
            -DCMAKE_CXX_COMPILER=${COMPILER} -DCMAKE_EXPORT_COMPILE_COMMANDS=ON ${ARGN}
        OUTPUT_QUIET ERROR_VARIABLE printed COMMAND_ERROR_IS_FATAL ANY)
    string(REGEX REPLACE "[ \n]+" " " printed "${printed}")
    string(REGEX MATCHALL "CMake Warning" warnings "${printed}")
    set(expected "")
    if(warning)
        set(expected "CMake Warning")
    endif()
    string(FIND "${printed}" "${warning}" place)
    if(NOT warnings STREQUAL expected OR place EQUAL -1)
        message(SEND_ERROR "${case}: CMake is to warn \"${warning}\", but prints:\n${printed}")
    endif()
    file(READ ${BINARY}/${case}/compile_commands.json commands)
    check_source(${case} "${commands}" broadphase/grid.cpp "${level}" ${asserts})
    set(ownLevel "")
    if(ARGN MATCHES "(CMAKE_CXX_FLAGS[A-Z_]*=|CONSUMER_OPTIONS=.*:)(-O[a-z0-9]+)")
        set(ownLevel ${CMAKE_MATCH_2})
    endif()
    check_source(${case} "${commands}" "tests/package/[a-z_]+[.]cpp" "${ownLevel}" ${asserts})
endfunction()

expect(untyped "CMAKE_BUILD_TYPE is empty. The hashphase libraries are compiled with -O2 and without assertions."
       -O2 0)
expect(asserting "The hashphase libraries are compiled with -O2 and with assertions." -O2 1 -DHASHPHASE_ASSERTS=ON)
expect(levelled "" -O1 1 -DCMAKE_CXX_FLAGS=-O1)
expect(release "" -O3 0 -DCMAKE_BUILD_TYPE=Release -DCMAKE_CXX_FLAGS_RELEASE=-O3)
expect(debug "" -O2 1 -DCMAKE_BUILD_TYPE=Debug)
expect(debug-option "" -Og 1 -DCMAKE_BUILD_TYPE=Debug "-DCONSUMER_OPTIONS=$<$<CONFIG:Debug>:-Og>")
expect(debug-levelled "" -Og 1 -DCMAKE_BUILD_TYPE=Debug -DCMAKE_CXX_FLAGS_DEBUG=-Og)
expect(debug-unoptimised "" "" 1 -DCMAKE_BUILD_TYPE=Debug -DHASHPHASE_DEBUG_OPTIMISE=OFF)
