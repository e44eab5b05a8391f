# SPDX-License-Identifier: Zlib
#
# hashphase_import_bullet(<bullet|bullet-float64>) looks for Bullet in single or double precision
# and makes the imported target hashphase::imported-<component> of it; where there is none, a status
# message says so. Used by the build and by the installed package alike.
#
# Tried in this order:
#   targets      that exist already: Bullet as part of the same build, or from Conan or vcpkg
#   pkg-config   `bullet`, which Bullet calls itself in either precision; Debian's `bullet-float64`
#   config file  Debian's has paths relative to BULLET_ROOT_DIR, and names libraries that are in
#                other packages; those of Conan and vcpkg make targets
#   FindBullet   comes with CMake, and cannot tell the precision
# Bullet of the wrong precision links without a word and then finds no pairs, so whatever is found
# is compiled and linked once before it is believed.

include_guard(GLOBAL)
include(CheckCXXSourceCompiles)

# Each finder sets `libraries` (empty: not found), `includes` and `definitions` of its caller.

macro(_hashphase_bullet_from_targets)
    if(TARGET Bullet::Bullet)
        set(libraries Bullet::Bullet)
        get_target_property(definitions Bullet::Bullet INTERFACE_COMPILE_DEFINITIONS)
    elseif(TARGET BulletDynamics AND TARGET BulletCollision AND TARGET LinearMath)
        set(libraries BulletDynamics BulletCollision LinearMath)
        get_target_property(imported BulletCollision IMPORTED)
        if(imported)
            get_target_property(definitions BulletCollision INTERFACE_COMPILE_DEFINITIONS)
        else()
            # Bullet's own CMake files set these for their directories, not for their targets.
            get_target_property(directory BulletCollision SOURCE_DIR)
            get_filename_component(includes "${directory}" DIRECTORY)
            get_property(definitions DIRECTORY "${directory}" PROPERTY COMPILE_DEFINITIONS)
            # What its headers know, as BT_THREADSAFE and BT_CLAMP_VELOCITY_TO.
            set(headerDefinitions ${definitions})
            list(FILTER headerDefinitions INCLUDE REGEX "^BT_")
            set(builtHere TRUE)
        endif()
    endif()
endmacro()

macro(_hashphase_bullet_from_pkg_config)
    find_package(PkgConfig QUIET)
    if(PkgConfig_FOUND)
        foreach(name IN ITEMS bullet bullet${suffix})
            string(MAKE_C_IDENTIFIER "HASHPHASE_PC_${name}" prefix)
            pkg_check_modules(${prefix} QUIET ${name})
            set(pkgConfigName ${name})
            set(libraries ${${prefix}_LINK_LIBRARIES})
            list(FILTER libraries INCLUDE REGEX "BulletDynamics|BulletCollision|LinearMath")
            set(includes ${${prefix}_INCLUDE_DIRS})
            set(definitions ${${prefix}_CFLAGS_OTHER})
            if("-D${ownDefinitions}" IN_LIST definitions)
                break()  # a `bullet` in double precision
            endif()
        endforeach()
    endif()
endmacro()

macro(_hashphase_bullet_from_config_file)
    find_package(Bullet QUIET CONFIG CONFIGS BulletConfig${suffix}.cmake BulletConfig.cmake)
    if(TARGET Bullet::Bullet OR TARGET BulletCollision)
        _hashphase_bullet_from_targets()
        list(APPEND definitions ${BULLET_DEFINITIONS})
    elseif(Bullet_FOUND)
        # Users before the libraries that they use: Bullet's list is the other way round.
        set(names ${BULLET_LIBRARIES})
        list(FILTER names INCLUDE REGEX "^(BulletDynamics|BulletCollision|LinearMath)")
        list(REVERSE names)
        foreach(name IN LISTS names)
            find_library(
                HASHPHASE_LIBRARY_${name} ${name}
                HINTS "${BULLET_ROOT_DIR}/${BULLET_LIBRARY_DIRS}" ${BULLET_LIBRARY_DIRS})
            mark_as_advanced(HASHPHASE_LIBRARY_${name})
            list(APPEND libraries ${HASHPHASE_LIBRARY_${name}})
        endforeach()
        foreach(folder IN LISTS BULLET_INCLUDE_DIRS)
            get_filename_component(folder "${folder}" ABSOLUTE BASE_DIR "${BULLET_ROOT_DIR}")
            list(APPEND includes "${folder}")
        endforeach()
        set(definitions ${BULLET_DEFINITIONS})
    endif()
endmacro()

macro(_hashphase_bullet_from_find_module)
    find_package(Bullet QUIET MODULE)
    if(BULLET_FOUND)
        set(libraries ${BULLET_DYNAMICS_LIBRARY} ${BULLET_COLLISION_LIBRARY} ${BULLET_MATH_LIBRARY})
        set(includes ${BULLET_INCLUDE_DIRS})
    endif()
endmacro()

# Sets `works` of its caller. The constructor of a capsule takes two btScalar by value, so its
# symbol tells the precision. Bullet that is built along with us cannot be tried yet.
macro(_hashphase_try_bullet)
    set(works TRUE)
    if(NOT builtHere)
        string(MAKE_C_IDENTIFIER "HASHPHASE_${component}_${source}_WORKS" result)
        set(CMAKE_REQUIRED_QUIET ON)
        # Conan's targets have libraries for this type alone.
        if(CMAKE_BUILD_TYPE AND NOT CMAKE_TRY_COMPILE_CONFIGURATION)
            set(CMAKE_TRY_COMPILE_CONFIGURATION ${CMAKE_BUILD_TYPE})
        endif()
        set(CMAKE_REQUIRED_INCLUDES ${includes})
        set(CMAKE_REQUIRED_LIBRARIES ${libraries})
        list(TRANSFORM ownDefinitions PREPEND -D OUTPUT_VARIABLE CMAKE_REQUIRED_DEFINITIONS)
        check_cxx_source_compiles(
            "#include <BulletCollision/CollisionShapes/btCapsuleShape.h>
            static_assert(BT_BULLET_VERSION >= 305, \"\");
            int main() { return btCapsuleShape(btScalar(1), btScalar(1)).getShapeType() < 0; }"
            ${result})
        if(NOT ${result})
            set(works FALSE)
            unset(${result} CACHE) # What is installed may be another one the next time.
        endif()
    endif()
endmacro()

# hashphase_is_bullet_shared(<bullet|bullet-float64> <variable>): false where that cannot be told, for Bullet's
# own build and its packages are static unless asked for.
function(hashphase_is_bullet_shared component variable)
    get_target_property(libraries hashphase::imported-${component} INTERFACE_LINK_LIBRARIES)
    set(isShared FALSE)
    foreach(library IN LISTS libraries)
        if(TARGET "${library}")
            get_target_property(type ${library} TYPE)
            if(type STREQUAL "SHARED_LIBRARY")
                set(isShared TRUE)
            endif()
        elseif(library MATCHES "[.](so[.0-9]*|dylib|tbd|dll[.]a)$")
            set(isShared TRUE)
        endif()
    endforeach()
    set(${variable} ${isShared} PARENT_SCOPE)
endfunction()

function(hashphase_import_bullet component)
    set(target hashphase::imported-${component})
    if(TARGET ${target})
        return()
    endif()
    if(component STREQUAL "bullet-float64")
        set(precision double)
        set(suffix "-float64")
        set(ownDefinitions BT_USE_DOUBLE_PRECISION)
    else()
        set(precision single)
        set(suffix "")
        set(ownDefinitions "")
    endif()

    foreach(source IN ITEMS targets pkg_config config_file find_module)
        set(libraries "")
        set(includes "")
        set(definitions "")
        set(headerDefinitions "")
        set(builtHere FALSE)
        set(pkgConfigName "")
        cmake_language(CALL _hashphase_bullet_from_${source})
        set(found single)
        if(definitions MATCHES "BT_USE_DOUBLE_PRECISION")
            set(found double)
        endif()
        if(NOT libraries OR NOT found STREQUAL precision)
            continue()
        endif()
        _hashphase_try_bullet()
        if(works)
            # Global, for those who take hashphase in by add_subdirectory.
            add_library(${target} INTERFACE IMPORTED GLOBAL)
            target_include_directories(${target} INTERFACE ${includes})
            target_compile_definitions(${target} INTERFACE ${ownDefinitions} ${headerDefinitions})
            target_link_libraries(${target} INTERFACE ${libraries})
            set_target_properties(${target} PROPERTIES HASHPHASE_PKG_CONFIG_NAME "${pkgConfigName}")
            return()
        endif()
    endforeach()
    if(NOT hashphase_FIND_QUIETLY)
        message(STATUS "hashphase: hashphase::${component} is left out, because Bullet 3.05 or newer in "
                       "${precision} precision was not found (Debian, Ubuntu: install libbullet-dev)")
    endif()
endfunction()
