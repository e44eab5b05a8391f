# SPDX-License-Identifier: Zlib
#
# cmake -DGIT=<git> -DSCRIPT=<commit.cmake> -DFOLDER=<folder> -P commit_test.cmake
#
# What commit.cmake writes of a checkout, of one with changes, and of a folder that is none, though it lies within
# one; and that it leaves a file alone which says so already.

cmake_minimum_required(VERSION 3.22)

# A hook of a checkout that runs this has variables that lead every git into that checkout.
execute_process(
    COMMAND ${GIT} rev-parse --local-env-vars
    OUTPUT_VARIABLE variables OUTPUT_STRIP_TRAILING_WHITESPACE COMMAND_ERROR_IS_FATAL ANY)
string(REPLACE "\n" ";" variables "${variables}")
foreach(variable IN LISTS variables)
    unset(ENV{${variable}})
endforeach()

function(git)
    execute_process(
        COMMAND ${GIT} -c user.name=n -c user.email=n@example.org -c commit.gpgsign=false ${ARGN}
        WORKING_DIRECTORY ${FOLDER} OUTPUT_QUIET COMMAND_ERROR_IS_FATAL ANY)
endfunction()

function(expect root pattern)
    execute_process(
        COMMAND ${CMAKE_COMMAND} -DGIT=${GIT} -DROOT=${root} -DVERSION=1.2.3 -DOUTPUT=${FOLDER}/build/commit.cpp
                -P ${SCRIPT}
        COMMAND_ERROR_IS_FATAL ANY)
    file(READ ${FOLDER}/build/commit.cpp source)
    if(NOT source MATCHES "return \"${pattern}\";")
        message(FATAL_ERROR "Of ${root}, not ${pattern}:\n${source}")
    endif()
endfunction()

file(REMOVE_RECURSE ${FOLDER})
file(MAKE_DIRECTORY ${FOLDER}/within ${FOLDER}/build)
file(WRITE ${FOLDER}/file "one")
git(init --quiet)
git(add file)
git(commit --quiet -m "One")
expect(${FOLDER} "[0-9a-f]+")
file(TIMESTAMP ${FOLDER}/build/commit.cpp before "%s")
execute_process(COMMAND ${CMAKE_COMMAND} -E sleep 1.1)
expect(${FOLDER} "[0-9a-f]+")
file(TIMESTAMP ${FOLDER}/build/commit.cpp after "%s")
if(NOT after STREQUAL before)
    message(FATAL_ERROR "The file was written again.")
endif()
file(WRITE ${FOLDER}/file "other")
expect(${FOLDER} "[0-9a-f]+-dirty")
expect(${FOLDER}/within "1[.]2[.]3")
