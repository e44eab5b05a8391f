# SPDX-License-Identifier: Zlib
#
# cmake -DNM=<nm> -DKERNELS=<number> -DOBJECTS=<file>[,<file>...] -P check_symbols.cmake
#
# Of functions that several objects of a program have, the linker keeps one, from whichever it likes. So
# - the kernels of AVX2 and AVX-512, of which there are this number, have none: a processor without would run
#   their instructions;
# - no object of the libraries has one for a type of Eigen's that is aligned by the compiler's options: a
#   program with other options would read what it has not aligned.

cmake_minimum_required(VERSION 3.22)

# Two or four numbers to a column or row, and no Eigen::DontAlign (2) in its options.
set(numbers "(float|double), ")
set(aligned "(Matrix|Array)<${numbers}(1, [24]|[24], [124]), [01],|Hyperplane<${numbers}3, 0>|AlignedBox<double, 2>")

string(REPLACE "," ";" objects "${OBJECTS}")
list(FILTER objects EXCLUDE REGEX "cmake_pch")  # precompiled headers
set(kernelCount 0)
foreach(object IN LISTS objects)
    execute_process(COMMAND ${NM} -C --defined-only ${object} OUTPUT_VARIABLE output
                    COMMAND_ERROR_IS_FATAL ANY)
    string(REGEX REPLACE "[][;]" "_" output "${output}") # which CMake's lists make much of
    # Of a constant in an expression, and of a column of another matrix, the type is named, and there is none.
    set(plain "Eigen::(Matrix|Array)<[^<>]*>")
    string(REGEX REPLACE "scalar_(constant|identity)_op<[a-z]+>, ${plain}" "" output "${output}")
    string(REGEX REPLACE "(mapbase_evaluator<Eigen::Block<${plain}( const)?, [0-9, ]+, (true|false)>), ${plain}"
           "\\1" output "${output}")
    string(REGEX MATCHALL "[^\n]* [WVu] [^\n]*" weak "${output}")
    set(pattern "${aligned}")
    if(object MATCHES "kernels_avx")
        math(EXPR kernelCount "${kernelCount} + 1")
        set(pattern ".")
    endif()
    foreach(symbol IN LISTS weak)
        if(symbol MATCHES "${pattern}" AND NOT symbol MATCHES " DW\\.ref\\.")
            list(APPEND breaches "${object}: ${symbol}")
        endif()
    endforeach()
endforeach()
list(LENGTH objects count)
message(STATUS "${count} objects, ${kernelCount} of them kernels of AVX")
if(NOT kernelCount EQUAL KERNELS)
    message(FATAL_ERROR "${KERNELS} kernels of AVX were expected.")
endif()
if(count EQUAL 0)
    message(FATAL_ERROR "There are no objects to look at.")
endif()
if(breaches)
    list(JOIN breaches "\n" breaches)
    message(FATAL_ERROR "These may take the place of a program's own:\n${breaches}")
endif()
