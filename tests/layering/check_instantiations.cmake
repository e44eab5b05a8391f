# SPDX-License-Identifier: Zlib
#
# cmake -DROOT=<repository> -P check_instantiations.cmake
#
# The members of a class template may be defined in several sources. The one with "template class C<float>;",
# or "template struct", instantiates those that stand above that line; each of the others has to name its own, one by one, or
# they are missing in a library, while a build that compiles sources together has them by chance. Names
# every member that is not named as often as it is defined, by file.

cmake_minimum_required(VERSION 3.22)

set(word "[A-Za-z_0-9]+")
file(GLOB_RECURSE files RELATIVE ${ROOT} ${ROOT}/broadphase/*.cpp ${ROOT}/integration/*.cpp)
set(missingCount 0)
set(memberCount 0)
foreach(file IN LISTS files)
    file(READ ${ROOT}/${file} text)
    string(PREPEND text "\n")
    string(REPLACE ";" "," text "${text}")
    # Not those that are templates themselves, which whoever calls them instantiates.
    string(REGEX REPLACE "template <(class|typename) Scalar>\ntemplate <[^\n]*\n" "// " text "${text}")
    string(REGEX MATCHALL "\ntemplate <(class|typename) Scalar>\n[^{,]*[ \n&*>]${word}<Scalar>::~?${word}\\("
           definitions "${text}")
    set(members "")
    foreach(definition IN LISTS definitions)
        string(FIND "${text}" "${definition}" place)
        string(REGEX MATCH "${word}<Scalar>::~?${word}\\($" member "${definition}")
        string(REGEX MATCH "^${word}" class "${member}")
        string(FIND "${text}" "\ntemplate class ${class}<float>," whole)
        if(whole EQUAL -1)
            string(FIND "${text}" "\ntemplate struct ${class}<float>," whole)
        endif()
        math(EXPR memberCount "${memberCount} + 1")
        if(whole LESS place)
            list(APPEND members "${member}")
        endif()
    endforeach()
    set(names ${members})
    list(REMOVE_DUPLICATES names)
    foreach(name IN LISTS names)
        string(REPLACE "(" "\\(" pattern "${name}")
        set(defined ${members})
        list(FILTER defined INCLUDE REGEX "^${pattern}$")
        list(LENGTH defined definedCount)
        foreach(scalar IN ITEMS float double)
            string(REPLACE "<Scalar>" "<${scalar}>" line "${pattern}")
            string(REGEX MATCHALL "\ntemplate [^\n]*${line}" lines "${text}")
            list(LENGTH lines lineCount)
            if(lineCount LESS definedCount)
                string(REPLACE "<Scalar>" "<${scalar}>" member "${name}")
                message(NOTICE "${file}: ${member}) is defined here, ${definedCount} times, and \
instantiated ${lineCount} times.")
                math(EXPR missingCount "${missingCount} + 1")
            endif()
        endforeach()
    endforeach()
endforeach()

if(memberCount EQUAL 0)
    message(FATAL_ERROR "No member was found below ${ROOT}: nothing was checked.")
elseif(missingCount GREATER 0)
    message(FATAL_ERROR "${missingCount} instantiations are missing.")
endif()
message(STATUS "${memberCount} members are instantiated where they are defined.")
