# SPDX-License-Identifier: Zlib
#
# cmake -DROOT=<repository> -DSCRATCH=<folder> -DCOMPILER=<compiler> -DUSER=<kind>
#       -DINCLUDES=<folder>,<folder>... -P strict_users.cmake
#
# Compiles strict_user.cpp, which includes all that is installed and uses every client, as a user of
# that kind does; our headers are found by -I, so that warnings about them are the user's:
#   careful     has all warnings made errors, and our assertions; includes foreign_macros.hpp before all
#               else, and has C++26 if there is
#   engine      has neither exceptions nor RTTI, and Bullet in double precision; every word of
#               foreign_macros.hpp is a syntax error where our headers use it

cmake_minimum_required(VERSION 3.22)
set(here ${CMAKE_CURRENT_LIST_DIR})

# Sets `result` to the first of the standards that the compiler knows.
function(find_standard result)
    file(WRITE ${SCRATCH}/empty.cpp "")
    foreach(standard IN LISTS ARGN)
        execute_process(COMMAND ${COMPILER} -std=${standard} -fsyntax-only ${SCRATCH}/empty.cpp
                        RESULT_VARIABLE status ERROR_QUIET)
        if(status EQUAL 0)
            set(${result} -std=${standard} PARENT_SCOPE)
            return()
        endif()
    endforeach()
    message(FATAL_ERROR "${COMPILER} knows none of ${ARGN}.")
endfunction()

# Sets `result` to those of the options that the compiler knows.
function(find_options result)
    set(known "")
    foreach(option IN LISTS ARGN)
        execute_process(COMMAND ${COMPILER} -Werror ${option} -fsyntax-only ${SCRATCH}/empty.cpp
                        RESULT_VARIABLE status ERROR_QUIET)
        if(status EQUAL 0)
            list(APPEND known ${option})
        endif()
    endforeach()
    set(${result} ${known} PARENT_SCOPE)
endfunction()

# Two lists of #include: all of our headers, and what they include that is none of ours.
file(GLOB_RECURSE headers RELATIVE ${ROOT} ${ROOT}/broadphase/*.hpp ${ROOT}/integration/*.hpp)
list(FILTER headers EXCLUDE REGEX "core/(hide|restore)_macros|^integration/(mpi|package|tbb)/")
list(LENGTH headers headerCount)
if(headerCount EQUAL 0)
    message(FATAL_ERROR "No header was found below ${ROOT}: nothing was compiled.")
endif()
set(ours "")
set(theirs "")
foreach(header IN LISTS headers)
    string(APPEND ours "#include <${header}>\n")
    file(STRINGS ${ROOT}/${header} includes REGEX "^#include <")
    list(APPEND theirs ${includes})
endforeach()
list(FILTER theirs EXCLUDE REGEX "<(broadphase|integration)/|(intrin|arm_neon|wasm_simd128)\\.h>")
list(REMOVE_DUPLICATES theirs)
list(JOIN theirs "\n" theirs)
file(WRITE ${SCRATCH}/our_headers.hpp "${ours}")

file(STRINGS ${here}/foreign_macros.hpp words REGEX "^#define ")
list(TRANSFORM words REPLACE "^#define ([A-Za-z_0-9]+(\\([^)]*\\))?).*" "#define \\1 @\n")
string(CONCAT poison ${words})
file(WRITE ${SCRATCH}/poison.hpp "${theirs}\n#include <cstdio>\n${poison}")

if(USER STREQUAL "careful")
    find_standard(standard c++26 c++2c c++23 c++2b)
    find_options(
        options -Wall -Wextra -Wpedantic -Wconversion -Wsign-conversion -Wshadow -Wold-style-cast
        -Wnull-dereference -Wdouble-promotion -Wuseless-cast -Wnon-virtual-dtor
        -Woverloaded-virtual -Wextra-semi -Wundef -Wcast-align -Wcast-qual -Wfloat-conversion
        -Wimplicit-fallthrough -Wredundant-decls -Wunused)
    list(APPEND options -Werror -DHASHPHASE_ENABLE_ASSERTS=1 -include ${here}/foreign_macros.hpp)
elseif(USER STREQUAL "engine")
    find_standard(standard c++20)
    find_options(options -fno-exceptions -fno-rtti -fno-threadsafe-statics -funsigned-char -fshort-enums)
    list(APPEND options -DNDEBUG -DBT_USE_DOUBLE_PRECISION -include ${SCRATCH}/poison.hpp)
else()
    message(FATAL_ERROR "There is no user \"${USER}\".")
endif()

string(REPLACE "," ";" includes "${INCLUDES}")
list(TRANSFORM includes PREPEND "-isystem")
execute_process(
    COMMAND ${COMPILER} ${standard} -fsyntax-only ${options} -I${ROOT} -I${SCRATCH} ${includes}
            ${here}/strict_user.cpp
    RESULT_VARIABLE status)
if(NOT status EQUAL 0)
    message(FATAL_ERROR "${COMPILER} does not compile our headers for the ${USER} user: ${options}")
endif()
message(STATUS "${headerCount} headers hold for the ${USER} user (${standard}).")
