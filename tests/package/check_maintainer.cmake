# SPDX-License-Identifier: Zlib
#
# cmake -DROOT=<repository> -DSCRATCH=<folder> -P check_maintainer.cmake
#
# The maintainer of the Debian packages is who makes them, by DEBFULLNAME and DEBEMAIL or else by git; where he is
# unknown, a sentence says what to set. make-deb --help tells of it.

cmake_minimum_required(VERSION 3.22)

set(script ${ROOT}/integration/package/maintainer.cmake)
file(REMOVE_RECURSE ${SCRATCH})
file(MAKE_DIRECTORY ${SCRATCH}/home ${SCRATCH}/here)

# expect(<expression> [<variable>=<value>...]): what the script prints matches, with these variables of the environment.
function(expect expression)
    execute_process(
        COMMAND
            ${CMAKE_COMMAND} -E env --unset=DEBFULLNAME --unset=DEBEMAIL --unset=XDG_CONFIG_HOME
            --unset=GIT_CONFIG_GLOBAL --unset=GIT_DIR GIT_CONFIG_NOSYSTEM=1 GIT_CEILING_DIRECTORIES=${SCRATCH}
            HOME=${SCRATCH}/home ${ARGN} ${CMAKE_COMMAND} -DFOLDER=${SCRATCH}/here -P ${script}
        OUTPUT_VARIABLE printed ERROR_VARIABLE printed)
    string(REGEX REPLACE "[ \n]+" " " printed "${printed}")
    if(NOT printed MATCHES "${expression}")
        message(SEND_ERROR "With \"${ARGN}\", \"${expression}\" is expected:\n${printed}")
    endif()
endfunction()

set(unknown "Set DEBFULLNAME and DEBEMAIL, or git's user.name and user.email[.]")
expect("${unknown}")
expect("${unknown}" "DEBFULLNAME=Ada Lovelace")
expect("${unknown}" DEBEMAIL=ada@example.org)
expect("${unknown}" "DEBFULLNAME=Ada Lovelace" DEBEMAIL=ada)
expect("-- The maintainer is Ada Lovelace <ada@example[.]org>" "DEBFULLNAME=Ada Lovelace" DEBEMAIL=ada@example.org)

file(WRITE ${SCRATCH}/home/.gitconfig "[user]\n    name = Grace Hopper\n    email = grace@example.org\n")
expect("-- The maintainer is Grace Hopper <grace@example[.]org>")
expect("-- The maintainer is Grace Hopper <ada@example[.]org>" DEBEMAIL=ada@example.org)
expect("-- The maintainer is Ada Lovelace <ada@example[.]org>" "DEBFULLNAME=Ada Lovelace" DEBEMAIL=ada@example.org)

execute_process(COMMAND ${ROOT}/integration/package/make-deb --help OUTPUT_VARIABLE help COMMAND_ERROR_IS_FATAL ANY)
if(NOT help MATCHES "DEBFULLNAME" OR NOT help MATCHES "DEBEMAIL")
    message(SEND_ERROR "make-deb --help does not tell whom the packages name as their maintainer:\n${help}")
endif()
