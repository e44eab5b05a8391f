# SPDX-License-Identifier: Zlib
#
# Installs the build in BUILD to PREFIX, from which whatever an earlier run left is removed first.

cmake_minimum_required(VERSION 3.22)

file(REMOVE_RECURSE ${PREFIX})
execute_process(
    COMMAND ${CMAKE_COMMAND} --install ${BUILD} --config ${CONFIG} --prefix ${PREFIX}
    COMMAND_ERROR_IS_FATAL ANY)
