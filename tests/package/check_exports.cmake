# SPDX-License-Identifier: Zlib
#
# cmake -DNM=<nm> -DLIBRARIES=<file>[,<file>...] -P check_exports.cmake
#
# What the shared libraries export is hashphase's: no template of Eigen, Bullet or the standard library,
# and of hashphase::detail only what code in public headers calls, or the program and the tests.

cmake_minimum_required(VERSION 3.22)

string(CONCAT offered
       "(CameraInverse|FewPairs|FirstException::r|Kernels|Motions<|PairState<|Population<|QueryScope|Ranks|"
       "SparseExchange|Store<|Table<|"
       "firstContactExactly|instructionSet|isAvailable|kernels|nameOf|parallelForNoexcept|"
       "cameraError|exceptionOf|footprintError|frustum(Error|Planes)|hasRoomFor|"
       "raise(InvalidArgument|LengthError|OutOfRange)|reportBrokenAssert|reportMessage|"
       "search(Boxes|Volume)|useInstructionSet|f(32|64)::WorldAabbs::update)")

string(REPLACE "," ";" libraries "${LIBRARIES}")
foreach(library IN LISTS libraries)
    execute_process(COMMAND ${NM} -D -C --defined-only ${library} OUTPUT_VARIABLE output
                    COMMAND_ERROR_IS_FATAL ANY)
    string(REGEX REPLACE "[][;]" "_" output "${output}") # which CMake's lists make much of
    string(REGEX MATCHALL "[^\n]+" symbols "${output}")
    list(LENGTH symbols count)
    if(count EQUAL 0)
        message(FATAL_ERROR "${library} exports nothing.")
    endif()
    foreach(symbol IN LISTS symbols)
        string(REGEX REPLACE "^[0-9a-f]* *[A-Za-z] " "" name "${symbol}")
        # A function's own name, without what stands before it, and before its arguments.
        if(NOT name MATCHES "^([^(]* )?hashphase::")
            list(APPEND breaches "${library}: ${name}")
        elseif(name MATCHES "^([^(<]* )?hashphase::detail::"
               AND NOT name MATCHES "^([^(]* )?hashphase::detail::${offered}")
            list(APPEND breaches "${library}: ${name}")
        endif()
    endforeach()
    message(STATUS "${library}: ${count} symbols")
endforeach()
if(breaches)
    list(JOIN breaches "\n" breaches)
    message(FATAL_ERROR "This should be hidden:\n${breaches}")
endif()
