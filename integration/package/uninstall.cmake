# SPDX-License-Identifier: Zlib
#
# cmake -DMANIFEST=<install_manifest.txt> -DFOLDERS=<folder>,<folder>... -P uninstall.cmake
#
# Removes the files that the last `cmake --install` of a build folder has installed, then our own folders that are
# empty by now: FOLDERS, relative to the prefix, and those below them.

cmake_minimum_required(VERSION 3.22)

if(NOT EXISTS ${MANIFEST})
    message(FATAL_ERROR "There is nothing to remove: ${MANIFEST} does not exist. It lists the files of the last "
                        "`cmake --install` without --component.")
endif()

string(REPLACE "," ";" FOLDERS "${FOLDERS}")
function(is_ours folder result)
    set(${result} FALSE PARENT_SCOPE)
    foreach(own IN LISTS FOLDERS)
        string(FIND "${folder}/" "/${own}/" place)
        if(NOT place EQUAL -1)
            set(${result} TRUE PARENT_SCOPE)
        endif()
    endforeach()
endfunction()

file(STRINGS ${MANIFEST} files)
set(folders "")
set(fileCount 0)
set(missingCount 0)
foreach(file IN LISTS files)
    set(file "$ENV{DESTDIR}${file}")
    get_filename_component(folder "${file}" DIRECTORY)
    is_ours("${folder}" isOurs)
    while(isOurs)
        list(APPEND folders "${folder}")
        get_filename_component(folder "${folder}" DIRECTORY)
        is_ours("${folder}" isOurs)
    endwhile()
    if(NOT EXISTS "${file}" AND NOT IS_SYMLINK "${file}")
        math(EXPR missingCount "${missingCount} + 1")
        continue()
    endif()
    file(REMOVE "${file}")
    if(EXISTS "${file}" OR IS_SYMLINK "${file}")
        message(FATAL_ERROR "${file} cannot be removed. Try again as the user who installed it.")
    endif()
    message(STATUS "Removed: ${file}")
    math(EXPR fileCount "${fileCount} + 1")
endforeach()

# Inner ones before outer ones.
list(REMOVE_DUPLICATES folders)
list(SORT folders ORDER DESCENDING)
set(folderCount 0)
foreach(folder IN LISTS folders)
    file(GLOB left "${folder}/*" "${folder}/.*")
    list(FILTER left EXCLUDE REGEX "/[.][.]?$")
    if(IS_DIRECTORY "${folder}" AND NOT left)
        file(REMOVE_RECURSE "${folder}")
        message(STATUS "Removed: ${folder}")
        math(EXPR folderCount "${folderCount} + 1")
    endif()
endforeach()

file(REMOVE ${MANIFEST})
message(STATUS "Removed ${fileCount} files and ${folderCount} folders. Not found: ${missingCount} files.")
