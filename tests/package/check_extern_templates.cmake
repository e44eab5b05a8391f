# SPDX-License-Identifier: Zlib
#
# cmake -DROOT=<repository> -P check_extern_templates.cmake
#
# A class template that headers declare `extern` is exported. Of one that is hidden, the compiler may leave
# an inline function to the library, whose users would not find it: whether it does, depends on how they
# optimise. Where it is instantiated, MSVC is told to export it.

cmake_minimum_required(VERSION 3.22)

file(GLOB_RECURSE headers RELATIVE ${ROOT} ${ROOT}/broadphase/*.hpp ${ROOT}/integration/*.hpp)
file(GLOB_RECURSE sources ${ROOT}/broadphase/*.cpp ${ROOT}/integration/*.cpp)
set(instances "")
foreach(source IN LISTS sources)
    file(STRINGS ${source} lines REGEX "^template (class|struct) ")
    string(APPEND instances "${lines}\n")
endforeach()
set(count 0)
foreach(header IN LISTS headers)
    file(READ ${ROOT}/${header} text)
    string(REGEX MATCHALL "extern template (class|struct) [A-Za-z]+" declarations "${text}")
    foreach(declaration IN LISTS declarations)
        math(EXPR count "${count} + 1")
        string(REGEX REPLACE ".* " "" name "${declaration}")
        if(NOT text MATCHES "(class|struct) HASHPHASE_[A-Z0-9_]+_TEMPLATE_EXPORT ${name}[ \n]")
            list(APPEND breaches "${header}: ${name} is extern, and hidden")
        endif()
        if(NOT instances MATCHES "template (class|struct) HASHPHASE_INSTANCE_EXPORT ${name}<float>")
            list(APPEND breaches "${header}: ${name} has no HASHPHASE_INSTANCE_EXPORT where it is instantiated")
        endif()
    endforeach()
endforeach()
if(breaches)
    list(REMOVE_DUPLICATES breaches)
    list(JOIN breaches "\n" breaches)
    message(FATAL_ERROR "${breaches}")
elseif(count EQUAL 0)
    message(FATAL_ERROR "${ROOT} has no extern templates.")
endif()
message(STATUS "${count} extern templates")
