# SPDX-License-Identifier: Zlib
#
# Files that go into pages as they are: scripts and style sheets, as strings in C++ sources.

# hashphase_bundle_script(<name> <file>...): sets <name> to the files' code, one after another within
# a function of its own, and <name>Sha256 to its hash. What is no script becomes a string: boxes.glsl is BOXES_GLSL.
function(hashphase_bundle_script name)
    set(code "(() => {\n\"use strict\";\n")
    foreach(file IN LISTS ARGN)
        set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${CMAKE_CURRENT_SOURCE_DIR}/${file})
        file(READ ${file} text)
        if(file MATCHES "([a-z]+)\\.(glsl|html)$")
            string(TOUPPER ${CMAKE_MATCH_1}_${CMAKE_MATCH_2} constant)
            set(text "const ${constant} = `${text}`;\n")
        endif()
        string(APPEND code "${text}")
    endforeach()
    string(APPEND code "})();\n")
    foreach(end IN ITEMS ")js\"" "</script" "<!--")
        string(FIND "${code}" "${end}" found)
        if(NOT found EQUAL -1)
            message(FATAL_ERROR "${ARGN}: ${end} would end the script, or the string that it is in.")
        endif()
    endforeach()
    string(SHA256 hash "${code}")
    set(${name} "${code}" PARENT_SCOPE)
    set(${name}Sha256 ${hash} PARENT_SCOPE)
endfunction()

# hashphase_bundle_style(<name> <file>): sets <name> to the style sheet.
function(hashphase_bundle_style name file)
    set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${CMAKE_CURRENT_SOURCE_DIR}/${file})
    file(READ ${file} text)
    set(${name} "${text}" PARENT_SCOPE)
endfunction()

hashphase_bundle_script(navigationScript report/navigation.js)
hashphase_bundle_style(pageStyle report/page.css)
configure_file(report/page_files.cpp.in page_files.cpp @ONLY)

hashphase_bundle_script(
    replayScript report/method_looks.js replay/replay_data.js replay/replay_camera.js replay/shaders/background.glsl
    replay/shaders/light.glsl replay/shaders/ground.glsl replay/shaders/objects.glsl
    replay/shaders/boxes.glsl replay/shaders/spheres.glsl replay/shaders/pairs.glsl
    replay/replay_drawing.js replay/replay_legend.js replay/replay.html replay/replay.js)
hashphase_bundle_style(replayStyle replay/replay.css)
configure_file(replay/replay_files.cpp.in replay_files.cpp @ONLY)
set(HASHPHASE_PAGE_FILES ${CMAKE_CURRENT_BINARY_DIR}/page_files.cpp
                         ${CMAKE_CURRENT_BINARY_DIR}/replay_files.cpp)
