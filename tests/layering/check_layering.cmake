# SPDX-License-Identifier: Zlib
#
# cmake -DROOT=<repository> -P check_layering.cmake
#
# Who may include whom, checked on every #include below broadphase/ and integration/:
#   broadphase/             itself, Eigen, the standard library
#   broadphase/simd/        the compiler's SIMD intrinsics as well, and it alone
#   integration/<client>/   itself, what broadphase/ offers, Eigen, the standard library
#   integration/culling/, integration/picking/
#                           integration/camera/ as well
#   integration/bullet/     Bullet as well, and it alone
#   integration/tbb/        oneTBB as well, and it alone
#   integration/mpi/        integration/distributed/ and MPI as well, and it alone
#   integration/effects/    the other clients as well
#   integration/package/    whatever users include: its sources are their programs
# What broadphase/ offers are the headers in the folder itself, and its helpers in core/ and geometry/. The
# other folders are its own.
# A few headers have moved, and forward from where they were to where they are: they include that one header,
# and nobody here includes them.
# demos/ and tests/ may include everything, and nobody else includes them.
#
# Only a few files ask which compiler, processor or system they are compiled for: checked on every #if below
# broadphase/, integration/, demos/ and tests/.
#
# A class template that is exported is exported by each of its declarations: Clang goes by the first one it sees.
#
# Names every breach by file, line and rule.

cmake_minimum_required(VERSION 3.22)

set(standard "[a-z_0-9]+")
set(simd "([a-z]*intrin|arm_neon|wasm_simd128)\\.h")
set(eigen "Eigen/[A-Za-z]+")
set(offered "broadphase/((core|geometry)/)?[^/]+")
set(moved broadphase/crowd.hpp broadphase/frustum.hpp broadphase/ground_footprint.hpp
          broadphase/nearest.hpp integration/picking/view.hpp)
set(movedTo broadphase/radius_search.hpp integration/camera/frustum.hpp integration/camera/ground_footprint.hpp
            integration/ai/nearest.hpp integration/camera/camera.hpp)
set(bullet "(bt[A-Z][A-Za-z0-9]*\\.h|(LinearMath|Bullet[A-Z][A-Za-z]*)/.+)")

# Sets `allowed`, a regular expression for what stands between < and >, and `rule`, a sentence.
macro(get_rule file)
    list(FIND moved "${file}" place)
    if(NOT place EQUAL -1)
        list(GET movedTo ${place} allowed)
        set(rule "what has moved to ${allowed} includes only that")
    elseif("${file}" MATCHES "^broadphase/simd/")
        set(allowed "(broadphase/.+|${simd}|${eigen}|${standard})")
        set(rule "broadphase/simd/ includes only broadphase/, SIMD intrinsics, Eigen and the \
standard library")
    elseif("${file}" STREQUAL "broadphase/core/compiler.hpp")
        set(allowed "(intrin\\.h|${standard})")
        set(rule "the words of compilers include only intrin.h and the standard library")
    elseif("${file}" MATCHES "^broadphase/")
        set(allowed "(broadphase/.+|${eigen}|${standard})")
        set(rule "broadphase/ includes only itself, Eigen and the standard library")
    elseif("${file}" MATCHES "^integration/bullet/")
        set(allowed "(${offered}|integration/bullet/.+|${bullet}|${eigen}|${standard})")
        set(rule "integration/bullet/ includes only itself, what broadphase/ offers, Bullet, Eigen and \
the standard library")
    elseif("${file}" MATCHES "^integration/tbb/")
        set(allowed "(${offered}|(integration/tbb|tbb)/.+|${standard})")
        set(rule "integration/tbb/ includes only itself, broadphase/, oneTBB and the standard library")
    elseif("${file}" MATCHES "^integration/mpi/")
        set(allowed "(${offered}|integration/(distributed|mpi)/.+|mpi\\.h|${eigen}|${standard})")
        set(rule "integration/mpi/ includes only itself, integration/distributed/, broadphase/, MPI, Eigen and \
the standard library")
    elseif("${file}" MATCHES "^integration/package/")
        set(allowed "(${offered}|integration/.+|${bullet}|${eigen}|${standard})")
        set(rule "integration/package/ includes only what users of hashphase include")
    elseif("${file}" MATCHES "^integration/effects/")
        set(allowed "(${offered}|integration/.+|${eigen}|${standard})")
        set(rule "integration/effects/ includes only the clients, broadphase/, Eigen and the \
standard library")
    elseif("${file}" MATCHES "^integration/(culling|picking)/")
        set(allowed "(${offered}|integration/(camera|${CMAKE_MATCH_1})/.+|${eigen}|${standard})")
        set(rule "integration/${CMAKE_MATCH_1}/ includes only itself, integration/camera/, broadphase/, \
Eigen and the standard library")
    elseif("${file}" MATCHES "^integration/([^/]+)/")
        set(allowed "(${offered}|integration/${CMAKE_MATCH_1}/.+|${eigen}|${standard})")
        set(rule "integration/${CMAKE_MATCH_1}/ includes only itself, broadphase/, Eigen and the \
standard library")
    else()
        set(allowed "")
        set(rule "integration/ holds no sources, only a folder for each client")
    endif()
endmacro()

function(get_line_number text offset result)
    string(SUBSTRING "${text}" 0 ${offset} before)
    string(REGEX MATCHALL "\n" breaks "${before}")
    list(LENGTH breaks count)
    math(EXPR line "${count} + 1")
    set(${result} ${line} PARENT_SCOPE)
endfunction()

file(GLOB_RECURSE files RELATIVE ${ROOT} ${ROOT}/broadphase/*.[hci]* ${ROOT}/integration/*.[hci]*)
list(FILTER files INCLUDE REGEX "\\.(h|hpp|hh|inl|ipp|c|cc|cpp|cxx)$")
list(TRANSFORM moved REPLACE "(.+)" "<\\1>" OUTPUT_VARIABLE movedNames)
set(breachCount 0)
set(includeCount 0)
foreach(file IN LISTS files)
    get_rule("${file}")
    file(READ ${ROOT}/${file} text)
    string(PREPEND text "\n")
    string(REGEX MATCHALL "\n[ \t]*#[ \t]*include[ \t]*(<[^>\n]*>|[^ \t\n]+)" includes "${text}")
    foreach(include IN LISTS includes)
        math(EXPR includeCount "${includeCount} + 1")
        string(REGEX MATCH "include[ \t]*(.+)" name "${include}")
        set(name "${CMAKE_MATCH_1}")
        if(name MATCHES "^\"")
            set(broken "our own headers are included from the repository root, in angle brackets")
        elseif(NOT name MATCHES "^<${allowed}>$" OR name MATCHES "\\.\\./")
            set(broken "${rule}")
        elseif("${name}" IN_LIST movedNames)
            set(broken "that header has moved")
        else()
            continue()
        endif()
        string(FIND "${text}" "${include}" offset)
        get_line_number("${text}" ${offset} line)
        message(NOTICE "${file}:${line}: #include ${name}: ${broken}.")
        math(EXPR breachCount "${breachCount} + 1")
    endforeach()
endforeach()

# The words that tell a compiler, a library, a processor or a system, and who may ask for them.
string(CONCAT platforms "__(OPTIMIZE|GNUC|clang|GLIBC|GLIBCXX|LIBCPP|MINGW|SSE|AVX|SANITIZE|wasm|EMSCRIPTEN|linux|"
       "unix|APPLE|ANDROID|x86_64|i386|aarch64|arm|ARM|cpp_|has_|STDC_IEC)|_(MSC_|MSVC|WIN32|M_[A-Z]|LIBCPP|CPPUNWIND|CPPRTTI)")
string(CONCAT knowing "^(broadphase/core/compiler\\.hpp|broadphase/export\\.hpp|broadphase/simd/dispatch\\.cpp|"
       "demos/try/.*)$")
file(GLOB_RECURSE others RELATIVE ${ROOT} ${ROOT}/demos/*.[hci]* ${ROOT}/tests/*.[hci]*)
set(conditionCount 0)
foreach(file IN LISTS files others)
    if(NOT file MATCHES "\\.(h|hpp|inl|c|cpp|in)$" OR file MATCHES "${knowing}")
        continue()
    endif()
    file(STRINGS ${ROOT}/${file} conditions REGEX "^[ \t]*#[ \t]*(if|elif)")
    foreach(condition IN LISTS conditions)
        math(EXPR conditionCount "${conditionCount} + 1")
        if(condition MATCHES "${platforms}")
            message(NOTICE "${file}: ${condition}: compilers, processors and systems are told apart in "
                           "broadphase/core/compiler.hpp, or by CMake's choice of a source.")
            math(EXPR breachCount "${breachCount} + 1")
        endif()
    endforeach()
endforeach()
if(conditionCount EQUAL 0)
    message(FATAL_ERROR "No #if was found below ${ROOT}: nothing was checked.")
endif()

set(exported "")
foreach(pass IN ITEMS collect compare)
    foreach(file IN LISTS files)
        file(STRINGS ${ROOT}/${file} declarations REGEX "^(class|struct) ([A-Z_]+_TEMPLATE_EXPORT )?[A-Za-z]+")
        foreach(declaration IN LISTS declarations)
            if(pass STREQUAL collect AND declaration MATCHES "_TEMPLATE_EXPORT ([A-Za-z]+)")
                list(APPEND exported ${CMAKE_MATCH_1})
            elseif(pass STREQUAL compare AND declaration MATCHES "^(class|struct) ([A-Za-z]+)([^<]*)$"
                   AND CMAKE_MATCH_2 IN_LIST exported)
                message(NOTICE "${file}: a declaration without the macro that exports ${CMAKE_MATCH_2}.")
                math(EXPR breachCount "${breachCount} + 1")
            endif()
        endforeach()
    endforeach()
endforeach()

list(LENGTH files fileCount)
if(includeCount EQUAL 0)
    message(FATAL_ERROR "No #include was found below ${ROOT}: nothing was checked.")
elseif(breachCount GREATER 0)
    message(FATAL_ERROR "${breachCount} of ${includeCount} includes, conditions or declarations break the rules.")
endif()
message(STATUS "${includeCount} includes in ${fileCount} files keep to the layering.")
