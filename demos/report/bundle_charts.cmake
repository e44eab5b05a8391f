# SPDX-License-Identifier: Zlib
#
# cmake -DNPM=<npm> -DNODE=<node> -DFOLDER=<folder> -P bundle_charts.cmake
#
# Installs the packages of package-lock.json in FOLDER/node_modules, unless they are there, and
# writes FOLDER/chart_scripts.cpp from them. Where that cannot be done, the source says why and the
# reports have tables only: a build never fails for want of npm or of a network.

cmake_minimum_required(VERSION 3.22)

function(write_without_charts reason)
    message(WARNING "The reports of hashphase will have no charts: ${reason}")
    file(WRITE ${FOLDER}/chart_scripts.cpp
         "#include <demos/report/chart_scripts.hpp>\n\n"
         "namespace hashphase::demos {\n\n"
         "ChartScripts chartScripts() {\n"
         "    return {{}, {}, R\"why(${reason})why\"};\n"
         "}\n\n"
         "}  // namespace hashphase::demos\n")
endfunction()

file(MAKE_DIRECTORY ${FOLDER})
if(NOT NPM OR NOT NODE)
    write_without_charts("The program was built without npm.")
    return()
endif()

set(installed ${FOLDER}/node_modules/.installed)
file(SHA256 ${CMAKE_CURRENT_LIST_DIR}/package-lock.json lock)
if(EXISTS ${installed})
    file(READ ${installed} installedLock)
endif()
if(NOT installedLock STREQUAL lock)
    file(COPY ${CMAKE_CURRENT_LIST_DIR}/package.json ${CMAKE_CURRENT_LIST_DIR}/package-lock.json
         DESTINATION ${FOLDER})
    # npm reads a closed input as a refusal of whatever it may want to ask.
    execute_process(
        COMMAND ${NPM} ci --ignore-scripts --no-audit --no-fund --prefer-offline
                --fetch-retries=1 --fetch-timeout=30000
        WORKING_DIRECTORY ${FOLDER}
        INPUT_FILE /dev/null
        RESULT_VARIABLE status OUTPUT_VARIABLE output ERROR_VARIABLE output
        TIMEOUT 120)
    if(NOT status EQUAL 0)
        message(STATUS "npm ci: ${output}\nTo have it tried again, delete ${FOLDER}.")
        write_without_charts("When the program was built, npm could not install what draws them.")
        return()
    endif()
    file(WRITE ${installed} ${lock})
endif()

execute_process(
    COMMAND ${NODE} ${CMAKE_CURRENT_LIST_DIR}/bundle_charts.mjs ${FOLDER}/node_modules
            ${FOLDER}/chart_scripts.cpp
    COMMAND_ERROR_IS_FATAL ANY)
