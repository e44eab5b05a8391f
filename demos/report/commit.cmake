# SPDX-License-Identifier: Zlib
#
# cmake -DGIT=<git> -DROOT=<source folder> -DVERSION=<version> -DOUTPUT=<C++ file> -P commit.cmake
#
# Writes the source of sourceCommit() (provenance.hpp): what git calls the state of ROOT, "1a2b3c4d-dirty", or the
# version where ROOT is no checkout. A file that says so already stays as it is.

cmake_minimum_required(VERSION 3.22)

set(commit ${VERSION})
if(GIT AND EXISTS ${ROOT}/.git)
    execute_process(
        COMMAND ${GIT} describe --always --dirty
        WORKING_DIRECTORY ${ROOT}
        RESULT_VARIABLE status OUTPUT_VARIABLE described ERROR_QUIET OUTPUT_STRIP_TRAILING_WHITESPACE)
    if(status EQUAL 0)
        set(commit ${described})
    endif()
endif()
set(source "#include <demos/report/provenance.hpp>

namespace hashphase::demos {

const char* sourceCommit() noexcept {
    return \"${commit}\";
}

}  // namespace hashphase::demos
")
set(before "")
if(EXISTS ${OUTPUT})
    file(READ ${OUTPUT} before)
endif()
if(NOT before STREQUAL source)
    file(WRITE ${OUTPUT} "${source}")
endif()
