# SPDX-License-Identifier: Zlib
#
# cmake -DSCRATCH=<folder> -P self_check_instantiations.cmake
#
# Holds check_instantiations.cmake against a small tree made in SCRATCH that is whole, and against the same
# with one line less.

cmake_minimum_required(VERSION 3.22)

set(members "template <class Scalar>\nvoid C<Scalar>::move(int by) {\n    run(by);\n}\n
template <class Scalar>\nauto C<Scalar>::read() const\n    -> Reading {}\n
template <class Scalar>\ntemplate <class Visit>\nvoid C<Scalar>::visit(const Visit& visit) {}\n\n")
set(lines "template void C<float>::move(int)" "template auto C<float>::read() const"
          "template void C<double>::move(int)" "template auto C<double>::read() const")

function(run_check)
    list(JOIN ARGN "$<SEMICOLON>\n" text)
    string(REPLACE "$<SEMICOLON>" ";" text "${text}")
    file(WRITE ${SCRATCH}/broadphase/c.cpp "${members}${text};\n")
    execute_process(
        COMMAND ${CMAKE_COMMAND} -DROOT=${SCRATCH}
                -P ${CMAKE_CURRENT_LIST_DIR}/check_instantiations.cmake
        RESULT_VARIABLE status OUTPUT_VARIABLE output ERROR_VARIABLE output)
    set(status ${status} PARENT_SCOPE)
    set(output "${output}" PARENT_SCOPE)
endfunction()

run_check(${lines})
if(NOT status EQUAL 0)
    message(FATAL_ERROR "A tree that is whole was refused:\n${output}")
endif()
run_check("template class C<float>" "template class C<double>")
if(NOT status EQUAL 0)
    message(FATAL_ERROR "A tree that instantiates classes was refused:\n${output}")
endif()
foreach(line IN LISTS lines)
    set(others ${lines})
    list(REMOVE_ITEM others "${line}")
    run_check(${others})
    string(REGEX MATCH "C<[a-z]+>::[a-z]+" member "${line}")
    if(status EQUAL 0 OR NOT output MATCHES "c.cpp: ${member}\\(\\) is defined here")
        message(FATAL_ERROR "Not noticed: ${line} is missing.\n${output}")
    endif()
endforeach()

file(REMOVE_RECURSE ${SCRATCH})
file(MAKE_DIRECTORY ${SCRATCH}/broadphase)
execute_process(
    COMMAND ${CMAKE_COMMAND} -DROOT=${SCRATCH} -P ${CMAKE_CURRENT_LIST_DIR}/check_instantiations.cmake
    RESULT_VARIABLE status OUTPUT_QUIET ERROR_QUIET)
if(status EQUAL 0)
    message(FATAL_ERROR "A tree without sources must not pass as checked.")
endif()
