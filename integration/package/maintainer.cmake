# SPDX-License-Identifier: Zlib
#
# cmake [-DFOLDER=<folder>] -P maintainer.cmake: prints who maintains the Debian packages, or says what to set. FOLDER
# is where git is asked; without it, here.

cmake_minimum_required(VERSION 3.22)

# Sets `result` to "<name> <<address>>": DEBFULLNAME and DEBEMAIL, or else what git knows of its user in `folder`. Empty
# where one of the two is unknown.
function(hashphase_find_maintainer folder result)
    find_program(HASHPHASE_GIT git)
    mark_as_advanced(HASHPHASE_GIT)
    set(maintainer "")
    foreach(part IN ITEMS DEBFULLNAME=user.name DEBEMAIL=user.email)
        string(REGEX MATCH "(.*)=(.*)" part "${part}")
        set(value "$ENV{${CMAKE_MATCH_1}}")
        if(NOT value AND HASHPHASE_GIT)
            execute_process(
                COMMAND ${HASHPHASE_GIT} config ${CMAKE_MATCH_2}
                WORKING_DIRECTORY ${folder}
                OUTPUT_VARIABLE value
                OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET)
        endif()
        list(APPEND maintainer "${value}")
    endforeach()
    set(${result} "" PARENT_SCOPE)
    if("${maintainer}" MATCHES "^([^;]+);([^;<> ]+@[^;<> ]+)$")
        set(${result} "${CMAKE_MATCH_1} <${CMAKE_MATCH_2}>" PARENT_SCOPE)
    endif()
endfunction()

if(CMAKE_SCRIPT_MODE_FILE STREQUAL CMAKE_CURRENT_LIST_FILE)
    if(NOT FOLDER)
        set(FOLDER ${CMAKE_CURRENT_LIST_DIR})
    endif()
    hashphase_find_maintainer(${FOLDER} maintainer)
    if(NOT maintainer)
        message(FATAL_ERROR "Debian packages name a maintainer. Set DEBFULLNAME and DEBEMAIL, or git's user.name and "
                            "user.email.")
    endif()
    message(STATUS "The maintainer is ${maintainer}")
endif()
