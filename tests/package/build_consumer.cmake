# SPDX-License-Identifier: Zlib
#
# Configures and builds the consumer in FOLDER, in the scratch folder BINARY. EXPECT is `compiles`, or
# `runs`: the program then reports the one overlapping pair; or a regular expression for the linker's
# complaint.

cmake_minimum_required(VERSION 3.22)

file(REMOVE_RECURSE ${BINARY})
execute_process(
    COMMAND ${CMAKE_COMMAND} -S ${FOLDER} -B ${BINARY} -G ${GENERATOR} -DCMAKE_BUILD_TYPE=Debug
            -DCMAKE_CXX_FLAGS_DEBUG= -DCMAKE_CXX_COMPILER=${COMPILER} -DCMAKE_PREFIX_PATH=${PREFIX} ${VARIABLES}
    RESULT_VARIABLE status OUTPUT_VARIABLE output ERROR_VARIABLE output)
if(NOT status EQUAL 0)
    message(FATAL_ERROR "The consumer cannot be configured:\n${output}")
endif()

execute_process(
    COMMAND ${CMAKE_COMMAND} --build ${BINARY} --config Debug --target consumer
    RESULT_VARIABLE status OUTPUT_VARIABLE output ERROR_VARIABLE output)
if(NOT EXPECT MATCHES "^(runs|compiles)$")
    if(status EQUAL 0)
        message(FATAL_ERROR "The consumer links, but must not.")
    elseif(NOT output MATCHES "${EXPECT}")
        message(FATAL_ERROR "The consumer fails, but not by \"${EXPECT}\":\n${output}")
    endif()
    message(STATUS "Does not link, as it should: ${CMAKE_MATCH_0}")
    return()
elseif(NOT status EQUAL 0)
    message(FATAL_ERROR "The consumer cannot be built:\n${output}")
endif()
if(EXPECT STREQUAL "compiles")
    return()
endif()

find_program(consumer consumer PATHS ${BINARY} ${BINARY}/Debug NO_DEFAULT_PATH REQUIRED)
execute_process(COMMAND ${consumer} RESULT_VARIABLE status OUTPUT_VARIABLE output)
if(NOT status EQUAL 0 OR NOT output STREQUAL "pairs: 1\n")
    message(FATAL_ERROR "The consumer ends with status ${status} and prints:\n${output}")
endif()
