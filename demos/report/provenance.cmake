# SPDX-License-Identifier: Zlib
#
# What reports say of how their program, and its Bullet, were built. Sets HASHPHASE_COMMIT_SOURCE, the source of
# sourceCommit(), which each build brings up to date; bulletPackage; and HASHPHASE_BULLET_HAS_THREADS.

find_package(Git QUIET)
set(HASHPHASE_COMMIT_SOURCE ${CMAKE_CURRENT_BINARY_DIR}/commit.cpp)
add_custom_target(
    hashphase_commit
    COMMAND ${CMAKE_COMMAND} -DGIT=${GIT_EXECUTABLE} -DROOT=${PROJECT_SOURCE_DIR} -DVERSION=${PROJECT_VERSION}
            -DOUTPUT=${HASHPHASE_COMMIT_SOURCE} -P ${CMAKE_CURRENT_LIST_DIR}/commit.cmake
    BYPRODUCTS ${HASHPHASE_COMMIT_SOURCE}
    COMMENT "Asking git for the commit"
    VERBATIM)
# Alone, so that a commit compiles nothing else again.
set_source_files_properties(${HASHPHASE_COMMIT_SOURCE} PROPERTIES SKIP_UNITY_BUILD_INCLUSION ON)

get_target_property(bulletLibraries hashphase::imported-bullet INTERFACE_LINK_LIBRARIES)
set(isBulletBuiltHere FALSE)
set(bulletFile "")
foreach(library IN LISTS bulletLibraries)
    if(TARGET "${library}")
        get_target_property(isImported ${library} IMPORTED)
        if(NOT isImported)
            set(isBulletBuiltHere TRUE)
        endif()
    elseif(library MATCHES "LinearMath" AND EXISTS "${library}")
        get_filename_component(bulletFile ${library} REALPATH)
    endif()
endforeach()

# The package that Bullet's library is from, "libbullet3.24 3.24+dfsg-2"; empty where dpkg knows none.
set(bulletPackage "")
find_program(HASHPHASE_DPKG_QUERY dpkg-query)
mark_as_advanced(HASHPHASE_DPKG_QUERY)
if(HASHPHASE_DPKG_QUERY AND bulletFile)
    execute_process(COMMAND ${HASHPHASE_DPKG_QUERY} --search ${bulletFile} OUTPUT_VARIABLE owner ERROR_QUIET)
    if(owner MATCHES "^([^:, ]+)")
        execute_process(
            COMMAND ${HASHPHASE_DPKG_QUERY} --show "--showformat=\${Package} \${Version};" ${CMAKE_MATCH_1}
            OUTPUT_VARIABLE package ERROR_QUIET)
        if(package MATCHES "^([^;]+)")
            set(bulletPackage ${CMAKE_MATCH_1})
        endif()
    endif()
endif()

# With BT_THREADSAFE, Bullet's library has threads to offer.
get_target_property(bulletDefinitions hashphase::imported-bullet INTERFACE_COMPILE_DEFINITIONS)
if(bulletDefinitions MATCHES "BT_THREADSAFE=1")
    set(HASHPHASE_BULLET_HAS_THREADS 1)
elseif(NOT isBulletBuiltHere)  # that would have told
    set(CMAKE_REQUIRED_LIBRARIES hashphase::imported-bullet)
    check_cxx_source_compiles(
        "class btThreadSupportInterface {
        public:
            struct ConstructionInfo;
            static btThreadSupportInterface* create(const ConstructionInfo&);
        };
        int main() {
            auto* volatile make = &btThreadSupportInterface::create;
            return make == nullptr;
        }"
        HASHPHASE_BULLET_HAS_THREADS)
    unset(CMAKE_REQUIRED_LIBRARIES)
endif()
