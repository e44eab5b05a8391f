# SPDX-License-Identifier: Zlib
#
# cmake -DROOT=<repository> -DBINARY=<scratch folder> -DCOMPILER=<C++ compiler> -P check_build_types.cmake
#
# One build folder with all build types: assertions are compiled into all of them but Release and
# MinSizeRel. Of the presets for an installation, library-checked has them, library has not. Configures, and builds
# nothing.

cmake_minimum_required(VERSION 3.22)

set(types Debug Release RelWithDebInfo MinSizeRel)
file(REMOVE_RECURSE ${BINARY})
execute_process(
    COMMAND
        ${CMAKE_COMMAND} -S ${ROOT} -B ${BINARY} -G "Ninja Multi-Config"
        -DCMAKE_CXX_COMPILER=${COMPILER} "-DCMAKE_CONFIGURATION_TYPES=${types}"
        -DCMAKE_EXPORT_COMPILE_COMMANDS=ON -DHASHPHASE_BUILD_DEMOS=OFF -DHASHPHASE_BUILD_TESTS=OFF
    OUTPUT_QUIET COMMAND_ERROR_IS_FATAL ANY)

file(READ ${BINARY}/compile_commands.json commands)
foreach(type IN LISTS types)
    set(expected 1)
    if(type MATCHES "^(Release|MinSizeRel)$")
        set(expected 0)
    endif()
    if(NOT commands MATCHES
       "-DHASHPHASE_ENABLE_ASSERTS=${expected} [^\n]*dir/${type}/grid.cpp.o")
        message(SEND_ERROR "${type} is not compiled with HASHPHASE_ENABLE_ASSERTS=${expected}.")
    endif()
endforeach()

file(READ ${BINARY}/integration/package/hashphase.pc pkgConfigFile)
if(pkgConfigFile MATCHES "[$]<")
    message(SEND_ERROR "pkg-config does not understand: ${pkgConfigFile}")
endif()

foreach(preset IN ITEMS library=0 library-checked=1)
    string(REGEX MATCH "(.*)=(.*)" preset "${preset}")
    set(preset ${CMAKE_MATCH_1})
    set(expected ${CMAKE_MATCH_2})
    file(REMOVE_RECURSE ${BINARY})
    execute_process(
        COMMAND ${CMAKE_COMMAND} -S ${ROOT} --preset ${preset} -B ${BINARY} -DCMAKE_CXX_COMPILER=${COMPILER}
        WORKING_DIRECTORY ${ROOT}
        OUTPUT_QUIET COMMAND_ERROR_IS_FATAL ANY)
    # What compiles the libraries, and what their users are told.
    foreach(file IN ITEMS compile_commands.json integration/package/hashphase.pc)
        file(READ ${BINARY}/${file} text)
        string(REGEX MATCHALL "HASHPHASE_ENABLE_ASSERTS=." found "${text}")
        list(REMOVE_DUPLICATES found)
        if(NOT found STREQUAL "HASHPHASE_ENABLE_ASSERTS=${expected}")
            message(SEND_ERROR "The preset ${preset} has \"${found}\" in ${file}.")
        endif()
    endforeach()
endforeach()
