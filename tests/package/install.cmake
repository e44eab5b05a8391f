# SPDX-License-Identifier: Zlib
#
# Installs the build in BUILD to PREFIX, from which whatever an earlier run left is removed first; lets the target
# `uninstall` remove it, which leaves files of others; and installs it again. HEADERS is our folder of headers there.

cmake_minimum_required(VERSION 3.22)

function(install_all)
    execute_process(
        COMMAND ${CMAKE_COMMAND} --install ${BUILD} --config ${CONFIG} --prefix ${PREFIX}
        OUTPUT_QUIET COMMAND_ERROR_IS_FATAL ANY)
endfunction()

# Fails unless what the target says matches the expression.
function(uninstall_all expression)
    execute_process(
        COMMAND ${CMAKE_COMMAND} --build ${BUILD} --config ${CONFIG} --target uninstall
        OUTPUT_VARIABLE output ERROR_VARIABLE output)
    string(REGEX REPLACE "[ \n]+" " " said "${output}")
    if(NOT said MATCHES "${expression}")
        message(FATAL_ERROR "The target `uninstall` is to say \"${expression}\":\n${output}")
    endif()
endfunction()

# What a user has installed from this folder can be removed after the test, too.
set(manifest ${BUILD}/install_manifest.txt)
set(kept ${PREFIX}_manifest.txt)
if(EXISTS ${manifest} AND NOT EXISTS ${kept}) # which a run that failed has left
    file(RENAME ${manifest} ${kept})
endif()

file(REMOVE_RECURSE ${PREFIX})
install_all()
file(STRINGS ${BUILD}/install_manifest.txt files)
list(GET files 0 missing)
file(REMOVE ${missing})
list(LENGTH files count)
math(EXPR count "${count} - 1")
set(foreign ${HEADERS}/broadphase/of_others.hpp)
file(WRITE ${PREFIX}/${foreign} "")
uninstall_all("Removed ${count} files and [1-9][0-9]* folders[.] Not found: 1 files[.]")
file(GLOB_RECURSE left RELATIVE ${PREFIX} ${PREFIX}/*)
if(NOT left STREQUAL foreign)
    message(FATAL_ERROR "`uninstall` is to leave ${foreign}, but leaves: ${left}")
endif()
file(GLOB_RECURSE folders LIST_DIRECTORIES true RELATIVE ${PREFIX} ${PREFIX}/*)
list(FILTER folders INCLUDE REGEX "(^|/)hashphase(/|$)")
if(NOT folders STREQUAL "${HEADERS};${HEADERS}/broadphase;${foreign}")
    message(FATAL_ERROR "`uninstall` is to leave no empty folder of ours, but leaves: ${folders}")
endif()
uninstall_all("There is nothing to remove")

file(REMOVE_RECURSE ${PREFIX})
install_all()
file(REMOVE ${manifest})
if(EXISTS ${kept})
    file(RENAME ${kept} ${manifest})
endif()
