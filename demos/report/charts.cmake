# SPDX-License-Identifier: Zlib
#
# Sets HASHPHASE_CHART_SCRIPTS to the source that holds the JavaScript of the reports' charts, made
# while the rest compiles. npm brings Vega-Lite, in the versions of package-lock.json.

find_program(HASHPHASE_NPM npm)
find_program(HASHPHASE_NODE NAMES node nodejs)
mark_as_advanced(HASHPHASE_NPM HASHPHASE_NODE)
set(HASHPHASE_REPORT_CHARTS AUTO CACHE STRING
    "Draw charts in reports (npm brings what draws them): ON, OFF, or AUTO, where npm is found")
set_property(CACHE HASHPHASE_REPORT_CHARTS PROPERTY STRINGS AUTO ON OFF)
if(HASHPHASE_REPORT_CHARTS STREQUAL "AUTO" AND NOT (HASHPHASE_NPM AND HASHPHASE_NODE))
    message(STATUS "hashphase: the reports will have tables but no charts, because npm was not "
                   "found (Debian, Ubuntu: npm)")
endif()

set(chartsFolder ${CMAKE_CURRENT_BINARY_DIR}/charts)
set(HASHPHASE_CHART_SCRIPTS ${chartsFolder}/chart_scripts.cpp)
set(chartsTools)
if(HASHPHASE_REPORT_CHARTS)
    set(chartsTools -DNPM=${HASHPHASE_NPM} -DNODE=${HASHPHASE_NODE})
endif()
add_custom_command(
    OUTPUT ${HASHPHASE_CHART_SCRIPTS}
    COMMAND ${CMAKE_COMMAND} -DFOLDER=${chartsFolder} ${chartsTools}
            -P ${CMAKE_CURRENT_LIST_DIR}/bundle_charts.cmake
    DEPENDS ${CMAKE_CURRENT_LIST_DIR}/bundle_charts.cmake
            ${CMAKE_CURRENT_LIST_DIR}/bundle_charts.mjs
            ${CMAKE_CURRENT_LIST_DIR}/chart_axes.js
            ${CMAKE_CURRENT_LIST_DIR}/chart_files.mjs
            ${CMAKE_CURRENT_LIST_DIR}/charts.js
            ${CMAKE_CURRENT_LIST_DIR}/method_looks.js
            ${CMAKE_CURRENT_LIST_DIR}/package.json
            ${CMAKE_CURRENT_LIST_DIR}/package-lock.json
            ${CMAKE_CURRENT_LIST_DIR}/page.js
    COMMENT "Bundling the scripts that draw charts"
    VERBATIM)
