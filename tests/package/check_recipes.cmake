# SPDX-License-Identifier: Zlib
#
# cmake -DROOT=<repository> -DVERSION=<version> -P check_recipes.cmake
#
# The recipes for vcpkg and Conan are of this version, and give CMake options that exist.

cmake_minimum_required(VERSION 3.22)

set(recipes ${ROOT}/integration/package)
file(READ ${recipes}/vcpkg/hashphase/vcpkg.json manifest)
string(JSON version GET "${manifest}" version)
if(NOT version STREQUAL VERSION)
    message(FATAL_ERROR "vcpkg.json is of version ${version}, the project of ${VERSION}.")
endif()

# The same expression as in conanfile.py.
file(READ ${ROOT}/CMakeLists.txt project)
if(NOT project MATCHES "\n +VERSION ([0-9.]+)\n" OR NOT CMAKE_MATCH_1 STREQUAL VERSION)
    message(FATAL_ERROR "conanfile.py does not find version ${VERSION} in CMakeLists.txt.")
endif()

foreach(recipe IN ITEMS vcpkg/hashphase/portfile.cmake conan/conanfile.py)
    file(READ ${recipes}/${recipe} text)
    # Not what the compiler is told, by HASHPHASE_<name>=.
    string(REGEX MATCHALL "(-D|\")HASHPHASE_[A-Z_]+" options "${text}")
    if(NOT options)
        message(FATAL_ERROR "${recipe} gives no option.")
    endif()
    foreach(option IN LISTS options)
        string(REGEX REPLACE "^(-D|\")" "" option "${option}")
        if(NOT project MATCHES "(option|set)\\(${option} ")
            message(FATAL_ERROR "${recipe} gives ${option}, which is no option of CMakeLists.txt.")
        endif()
    endforeach()
endforeach()
