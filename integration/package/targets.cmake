# SPDX-License-Identifier: Zlib
#
# What every library and program of hashphase has in common.

include_guard(GLOBAL)
include(CheckLinkerFlag)
include(GNUInstallDirs)

if(MSVC AND MSVC_VERSION LESS 1930)
    message(FATAL_ERROR "hashphase needs Visual Studio 2022 or newer, but MSVC_VERSION is ${MSVC_VERSION}. Use a "
                        "newer compiler.")
endif()

# The run-time libraries of MSVC for Debug and for the rest do not mix: one folder has room for both of ours.
if(MSVC AND NOT DEFINED CMAKE_DEBUG_POSTFIX)
    set(CMAKE_DEBUG_POSTFIX d)
endif()

# Before version 1.0 every minor version may change what programs have compiled in; from then on only
# a major version may (integration/guide/abi.md).
if(PROJECT_VERSION_MAJOR EQUAL 0)
    set(HASHPHASE_ABI_VERSION ${PROJECT_VERSION_MAJOR}.${PROJECT_VERSION_MINOR})
    set(HASHPHASE_COMPATIBILITY SameMinorVersion)
else()
    set(HASHPHASE_ABI_VERSION ${PROJECT_VERSION_MAJOR})
    set(HASHPHASE_COMPATIBILITY SameMajorVersion)
endif()

# Unoptimised libraries take 20 times as long. Within a project that sets no level of optimisation they are optimised
# all the same: in Debug builds with assertions, and if the project sets no build type, as in a Release build.
get_directory_property(options COMPILE_OPTIONS)
set(levelOption "(^|[ ;:])-O")
if(MSVC)
    set(levelOption "(^|[ ;:])[-/]O")
endif()
set(HASHPHASE_OPTIMISATION "")
if("${CMAKE_CXX_FLAGS} ${options}" MATCHES "${levelOption}")
    # as the project says
elseif(NOT multiConfig AND NOT CMAKE_BUILD_TYPE)
    set(HASHPHASE_OPTIMISATION -O2)
    if(MSVC)
        set(HASHPHASE_OPTIMISATION /O2)
    endif()
    set(assertions "without assertions")
    if(HASHPHASE_ASSERTS STREQUAL "AUTO")
        set(HASHPHASE_ASSERTS OFF)
    elseif(HASHPHASE_ASSERTS)
        set(assertions "with assertions")
    endif()
    message(
        WARNING "hashphase: CMAKE_BUILD_TYPE is empty. The hashphase libraries are compiled with "
                "${HASHPHASE_OPTIMISATION} and ${assertions}. Your own files, with the hashphase templates that "
                "they use, are compiled without optimisation. Set the type: cmake -DCMAKE_BUILD_TYPE=Release, or "
                "RelWithDebInfo, or Debug.")
elseif(HASHPHASE_DEBUG_OPTIMISE AND NOT MSVC AND NOT CMAKE_CXX_FLAGS_DEBUG MATCHES "${levelOption}")
    # MSVC's options for Debug, /RTC1, exclude /O2.
    set(HASHPHASE_OPTIMISATION $<$<CONFIG:Debug>:-O2>)
    if(multiConfig OR CMAKE_BUILD_TYPE STREQUAL "Debug")
        message(STATUS "hashphase: the libraries are compiled with -O2 in Debug builds too; "
                       "-DHASHPHASE_DEBUG_OPTIMISE=OFF leaves them unoptimised")
    endif()
endif()

# Warnings, reproducible floating point and plain C++20 for a target of our own. The headers of
# Bullet, Eigen and GoogleTest come from imported targets and count as system headers.
function(hashphase_own_target target)
    target_compile_features(${target} PUBLIC cxx_std_20)
    target_compile_options(${target} PRIVATE ${HASHPHASE_OPTIMISATION})
    # For shared libraries, where there are any.
    get_property(isShareable GLOBAL PROPERTY TARGET_SUPPORTS_SHARED_LIBS)
    set_target_properties(
        ${target} PROPERTIES CXX_EXTENSIONS OFF POSITION_INDEPENDENT_CODE "${isShareable}")
    if(HASHPHASE_QUICK_BUILD AND CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
        # A gigabyte before the compiler looks for memory to give back: a tenth of its time.
        target_compile_options(${target} PRIVATE --param=ggc-min-heapsize=1048576)
    endif()
    # Contracted multiply-adds would make results depend on the machine that the library is built for, and a
    # box would no longer be filed where it is looked for. MSVC makes none since Visual Studio 2022. Nor may
    # what else is built tell the libraries to leave NaN, the order of additions or other threads out of account.
    if(MSVC)
        target_compile_options(
            ${target} PRIVATE /W4 /permissive- /Zc:__cplusplus /bigobj /utf-8 /fp:precise
                              $<IF:$<CXX_COMPILER_ID:MSVC>,/Zc:preprocessor,/clang:-ffp-contract=off>)
        if(BUILD_SHARED_LIBS)
            # That a class of a DLL has members of the standard library is meant (integration/guide/abi.md). The
            # installed headers are the system's, of which nobody is warned.
            set(meant $<$<COMPILE_LANGUAGE:CXX>:/wd4251> $<$<COMPILE_LANGUAGE:CXX>:/wd4275>)
            target_compile_options(${target} PRIVATE ${meant} INTERFACE "$<BUILD_INTERFACE:${meant}>")
        endif()
    elseif(CMAKE_CXX_COMPILER_ID MATCHES "GNU|Clang")
        set(falseAlarms "")
        if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU" AND CMAKE_CXX_COMPILER_VERSION VERSION_LESS 13)
            set(falseAlarms -Wno-restrict) # of text + std::string: its bug 105651
        endif()
        target_compile_options(
            ${target}
            PRIVATE -Wall -Wextra -Wpedantic -Wconversion -Wshadow -fno-fast-math
                    -fno-finite-math-only -fno-unsafe-math-optimizations -ffp-contract=off
                    -fthreadsafe-statics
                    $<$<CXX_COMPILER_ID:Clang,AppleClang>:-Wno-overlength-strings>
                    ${falseAlarms}
                    $<$<BOOL:${HASHPHASE_WARNINGS_AS_ERRORS}>:-Werror>)
    endif()
endfunction()

# In quick builds, GCC 12 takes the standard library's precompiled headers for ours, inlines more, and
# warns of what is not so.
function(hashphase_calm_warnings target)
    if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
        target_compile_options(
            ${target} PRIVATE -Wno-array-bounds -Wno-maybe-uninitialized -Wno-restrict
                              -Wno-stringop-overflow -Wno-stringop-overread)
    endif()
endfunction()

# hashphase_precompile_headers(<target> [AS <owner>] [ALSO <header>...]): in a quick build, compiles what
# most sources include once for the target, which takes as long as three sources save; or takes what was
# compiled for another one, whose code is as independent of its position and as optimised. (Clang wants
# all definitions to be the same as well.)
function(hashphase_precompile_headers target)
    cmake_parse_arguments(PARSE_ARGV 1 arg "" "AS" "ALSO")
    if(NOT HASHPHASE_QUICK_BUILD)
        return()
    endif()
    if(NOT arg_AS)
        target_precompile_headers(
            ${target} PRIVATE <Eigen/Geometry> <algorithm> <memory> <span> <vector> ${arg_ALSO})
    elseif(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
        target_precompile_headers(${target} REUSE_FROM ${arg_AS})
    endif()
    hashphase_calm_warnings(${target})
endfunction()

# hashphase_compile_together(<target>): in a quick build, compiles twelve sources at a time as one, because
# most of what they take are the same headers and templates. So they share their names.
function(hashphase_compile_together target)
    if(HASHPHASE_QUICK_BUILD)
        set_target_properties(${target} PROPERTIES UNITY_BUILD ON UNITY_BUILD_BATCH_SIZE 12)
        hashphase_calm_warnings(${target})
        if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
            # A source that another one includes is taken for a header.
            target_compile_options(${target} PRIVATE -Wno-subobject-linkage)
        endif()
    endif()
endfunction()

# What users of the libraries are told, by CMake and by pkg-config, so that both sides agree
# (integration/guide/abi.md).
set(HASHPHASE_DEFINITIONS "")
foreach(definition IN ITEMS ENABLE_ASSERTS=HASHPHASE_ASSERTS USE_SCALAR=HASHPHASE_SCALAR
                            SHARED=BUILD_SHARED_LIBS)
    string(REGEX MATCH "(.*)=(.*)" definition "${definition}")
    set(name HASHPHASE_${CMAKE_MATCH_1})
    set(value "${${CMAKE_MATCH_2}}")
    if(value STREQUAL "AUTO" AND multiConfig)
        list(APPEND HASHPHASE_DEFINITIONS ${name}=$<NOT:$<CONFIG:Release,MinSizeRel>>)
    elseif(NOT value OR (value STREQUAL "AUTO" AND CMAKE_BUILD_TYPE MATCHES "^(Release|MinSizeRel)$"))
        list(APPEND HASHPHASE_DEFINITIONS ${name}=0)
    else()
        list(APPEND HASHPHASE_DEFINITIONS ${name}=1)
    endif()
endforeach()

# hashphase_find_libraries_from(<target> <folder>): what is installed in the folder finds our shared
# libraries wherever the prefix is. Where the system's are it needs no telling, and packages must not.
function(hashphase_find_libraries_from target folder)
    if(BUILD_SHARED_LIBS AND UNIX AND NOT APPLE AND NOT CMAKE_INSTALL_PREFIX STREQUAL "/usr")
        file(RELATIVE_PATH way ${CMAKE_INSTALL_PREFIX}/${folder}
             ${CMAKE_INSTALL_PREFIX}/${CMAKE_INSTALL_LIBDIR})
        set_target_properties(${target} PROPERTIES INSTALL_RPATH "$ORIGIN/${way}")
    endif()
endfunction()

# hashphase_install_program(<target>...): among the tools.
function(hashphase_install_program)
    foreach(target IN LISTS ARGN)
        hashphase_find_libraries_from(${target} ${CMAKE_INSTALL_BINDIR})
    endforeach()
    install(TARGETS ${ARGN} RUNTIME COMPONENT hashphase_tools)
endfunction()

# hashphase_add_library(<component> [STATIC] SOURCES <file>... LINKS <target>...)
#
# Adds hashphase::<component>, with the repository root as its include folder, and installs it in an
# export set of its own, so that an installed component asks only for what it needs itself.
function(hashphase_add_library component)
    cmake_parse_arguments(PARSE_ARGV 1 arg "STATIC" "" "SOURCES;LINKS")
    string(REPLACE "-" "_" target hashphase_${component})
    set(kind "")
    if(arg_STATIC)
        set(kind STATIC)
    endif()
    add_library(${target} ${kind} ${arg_SOURCES})
    add_library(hashphase::${component} ALIAS ${target})
    hashphase_own_target(${target})
    target_include_directories(
        ${target} PUBLIC $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}>
                         $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}/hashphase>)
    target_link_libraries(${target} PUBLIC ${arg_LINKS})
    set_target_properties(
        ${target}
        PROPERTIES EXPORT_NAME ${component}
                   VERSION ${PROJECT_VERSION}
                   SOVERSION ${HASHPHASE_ABI_VERSION}
                   CXX_VISIBILITY_PRESET hidden
                   VISIBILITY_INLINES_HIDDEN ON)
    if(BUILD_SHARED_LIBS AND NOT arg_STATIC)
        if(NOT WIN32)
            # Makes no difference, but to precompiled headers, which must not differ in it.
            set_target_properties(${target} PROPERTIES DEFINE_SYMBOL "")
        endif()
        if(UNIX AND NOT APPLE AND NOT HASHPHASE_SANITIZE)
            # What another library hides is found out here, not by who links both. The standard
            # library's templates are never hidden by the compiler.
            target_link_options(
                ${target} PRIVATE -Wl,--no-undefined
                -Wl,--version-script=${PROJECT_SOURCE_DIR}/integration/package/exports.map)
            set_property(
                TARGET ${target} APPEND
                PROPERTY LINK_DEPENDS ${PROJECT_SOURCE_DIR}/integration/package/exports.map)
        endif()
    endif()
    if(TARGET hashphase_broadphase AND NOT component STREQUAL "broadphase")
        hashphase_precompile_headers(${target} AS hashphase_broadphase)
    endif()
    hashphase_compile_together(${target})  # what is packaged as well as what is measured
    hashphase_find_libraries_from(${target} ${CMAKE_INSTALL_LIBDIR})
    install(
        TARGETS ${target}
        EXPORT hashphase-${component}-targets
        RUNTIME COMPONENT hashphase_libraries
        LIBRARY COMPONENT hashphase_libraries NAMELINK_COMPONENT hashphase_development
        ARCHIVE COMPONENT hashphase_development)
    set_property(GLOBAL APPEND PROPERTY HASHPHASE_COMPONENTS ${component})
endfunction()

# Installs the headers of the current folder under include/hashphase, at the same relative path.
function(hashphase_install_headers)
    file(RELATIVE_PATH folder ${PROJECT_SOURCE_DIR} ${CMAKE_CURRENT_SOURCE_DIR})
    install(
        DIRECTORY ${CMAKE_CURRENT_SOURCE_DIR}/
        DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/hashphase/${folder}
        COMPONENT hashphase_development
        FILES_MATCHING
        PATTERN "*.hpp")
endfunction()

# In a quick build, links everything in the calling directory and below by LLVM's linker where it is
# there: in an eighth to a third of the time.
function(hashphase_link_quickly)
    if(HASHPHASE_QUICK_BUILD AND CMAKE_CXX_COMPILER_ID MATCHES "GNU|Clang")
        check_linker_flag(CXX -fuse-ld=lld HASHPHASE_HAS_LLD)
        if(HASHPHASE_HAS_LLD)
            add_link_options(-fuse-ld=lld)
        endif()
    endif()
endfunction()

# In a quick build by Ninja, compiles no more at once in the calling directory and below than the machine
# has memory for.
function(hashphase_spare_memory)
    if(HASHPHASE_QUICK_BUILD AND PROJECT_IS_TOP_LEVEL)
        cmake_host_system_information(RESULT megabytes QUERY TOTAL_PHYSICAL_MEMORY)
        math(EXPR jobs "1 + ${megabytes} / 1500")
        set_property(GLOBAL APPEND PROPERTY JOB_POOLS hashphase_compile=${jobs})
        set(CMAKE_JOB_POOL_COMPILE hashphase_compile PARENT_SCOPE)
    endif()
endfunction()

# Applies HASHPHASE_SANITIZE to everything in the calling directory and below.
function(hashphase_enable_sanitizers)
    if(HASHPHASE_SANITIZE STREQUAL "address")
        set(flags -fsanitize=address,undefined,float-cast-overflow -fno-sanitize-recover=all)
    elseif(HASHPHASE_SANITIZE STREQUAL "thread")
        set(flags -fsanitize=thread)
    elseif(HASHPHASE_SANITIZE)
        message(FATAL_ERROR "hashphase: HASHPHASE_SANITIZE is \"${HASHPHASE_SANITIZE}\", but must be empty, "
                            "address or thread.")
    else()
        return()
    endif()
    if(HASHPHASE_BUILD_FUZZERS)
        # libFuzzer follows what runs, and comparisons; only the fuzzers themselves link it.
        add_compile_options(-fsanitize=fuzzer-no-link)
    endif()
    # Sanitizers have a `new` of their own, and end a program that runs out of memory.
    add_compile_definitions(HASHPHASE_IS_SANITIZED=1)
    add_compile_options(${flags} -fno-omit-frame-pointer)
    add_link_options(${flags})
endfunction()

# Spares what is in the calling directory and below, tests and programs, what takes the compiler
# longer than it spares whoever runs them: some checks of UndefinedBehaviorSanitizer, a third of the
# time (AddressSanitizer sees null pointers too, and the libraries keep them all), and in a quick build
# most optimisations, and what a debugger reads: a tenth, but a sanitizer names lines by it.
function(hashphase_spare_compiling)
    if(HASHPHASE_SANITIZE STREQUAL "address")
        add_compile_options(-fno-sanitize=null,alignment,object-size,vptr)
    endif()
    if(HASHPHASE_QUICK_BUILD)
        add_compile_options($<$<CONFIG:RelWithDebInfo>:-O1>)
        if(NOT HASHPHASE_SANITIZE)
            add_compile_options($<$<CONFIG:RelWithDebInfo>:-g0>)
        endif()
    endif()
endfunction()
