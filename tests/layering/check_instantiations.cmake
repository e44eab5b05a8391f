# SPDX-License-Identifier: Zlib
#
# cmake -DROOT=<repository> -P check_instantiations.cmake
#
# The members of a class template may be defined in several sources. The one that ends with "template class
# C<float>;" instantiates those that stand above that line; each of the others has to name its own, one by
# one, or they are missing in a library, while a build that compiles sources together has them by chance.
# Names every member that is not named, by file.

cmake_minimum_required(VERSION 3.22)

file(GLOB_RECURSE files RELATIVE ${ROOT} ${ROOT}/broadphase/*.cpp ${ROOT}/integration/*.cpp)
set(missingCount 0)
set(memberCount 0)
foreach(file IN LISTS files)
    file(READ ${ROOT}/${file} text)
    string(PREPEND text "\n")
    string(REPLACE ";" "," text "${text}")
    # Not those that are templates themselves, which whoever calls them instantiates.
    string(REGEX REPLACE "template <class Scalar>\ntemplate <[^\n]*\n" "// " text "${text}")
    string(REGEX MATCHALL
           "\ntemplate <class Scalar>\n[^{]*[ \n&*>]([A-Za-z]+)<Scalar>::~?[A-Za-z]+\\(" definitions
           "${text}")
    foreach(definition IN LISTS definitions)
        string(REGEX MATCH "([A-Za-z]+)<Scalar>::(~?[A-Za-z]+)\\($" ignored "${definition}")
        set(class "${CMAKE_MATCH_1}")
        set(member "${CMAKE_MATCH_2}")
        math(EXPR memberCount "${memberCount} + 1")
        foreach(scalar IN ITEMS float double)
            string(REGEX MATCH
                   "\ntemplate (class ${class}<${scalar}>,|[^\n]*${class}<${scalar}>::${member}\\()"
                   found "${text}")
            if(NOT found)
                message(NOTICE "${file}: ${class}<${scalar}>::${member}() is defined here and not \
instantiated.")
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
