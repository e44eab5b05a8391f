# SPDX-License-Identifier: Zlib
#
# Debian packages by CPack, one for each component: integration/package/make-deb makes them.
#
#   hashphase_libraries     libhashphase<SONAME>: the shared libraries
#   hashphase_development   libhashphase-dev: headers, CMake package, pkg-config files, examples
#   hashphase_tools         hashphase: the programs, and modules of theirs in <libdir>/hashphase/

set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME hashphase)
set(CPACK_PACKAGE_VENDOR "the hashphase authors")
include(${CMAKE_CURRENT_LIST_DIR}/maintainer.cmake)
hashphase_find_maintainer(${PROJECT_SOURCE_DIR} CPACK_PACKAGE_CONTACT)  # cpack makes no packages without
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "spatial-hash broadphase for the Bullet physics engine")
set(CPACK_RESOURCE_FILE_LICENSE ${PROJECT_SOURCE_DIR}/LICENSE)
set(CPACK_STRIP_FILES ON)
set(CPACK_VERBATIM_VARIABLES ON)
set(CPACK_PACKAGING_INSTALL_PREFIX ${CMAKE_INSTALL_PREFIX})
# Whoever makes packages may have a umask of his own.
set(CPACK_INSTALL_DEFAULT_DIRECTORY_PERMISSIONS
    OWNER_READ OWNER_WRITE OWNER_EXECUTE GROUP_READ GROUP_EXECUTE WORLD_READ WORLD_EXECUTE)

set(packageFiles ${CMAKE_CURRENT_BINARY_DIR}/package-files)
set(CPACK_COMPONENTS_ALL hashphase_libraries hashphase_development)
if(HASHPHASE_BUILD_DEMOS)
    list(APPEND CPACK_COMPONENTS_ALL hashphase_tools)
endif()
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_COMPONENTS_GROUPING IGNORE)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_ENABLE_COMPONENT_DEPENDS ON)
set(CPACK_DEBIAN_PACKAGE_CONTROL_STRICT_PERMISSION ON)

set(about "A spatial hash that replaces the broadphase of Bullet, with exact pairs in every
step. Picking, culling, AI and terrain ask the same grid.")

set(librariesPackage libhashphase${HASHPHASE_ABI_VERSION})
set(CPACK_DEBIAN_HASHPHASE_LIBRARIES_PACKAGE_NAME ${librariesPackage})
set(CPACK_DEBIAN_HASHPHASE_LIBRARIES_PACKAGE_SECTION libs)
set(CPACK_DEBIAN_HASHPHASE_LIBRARIES_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_HASHPHASE_LIBRARIES_PACKAGE_CONTROL_EXTRA
    ${packageFiles}/shlibs ${CMAKE_CURRENT_LIST_DIR}/debian/triggers)
set(CPACK_COMPONENT_HASHPHASE_LIBRARIES_DESCRIPTION "${about}
.
This package has the shared libraries.")

set(CPACK_DEBIAN_HASHPHASE_DEVELOPMENT_PACKAGE_NAME libhashphase-dev)
set(CPACK_DEBIAN_HASHPHASE_DEVELOPMENT_PACKAGE_SECTION libdevel)
set(CPACK_DEBIAN_HASHPHASE_DEVELOPMENT_PACKAGE_DEPENDS "libbullet-dev, libeigen3-dev")
set(CPACK_DEBIAN_HASHPHASE_DEVELOPMENT_PACKAGE_SUGGESTS "libtbb-dev")
set(CPACK_COMPONENT_HASHPHASE_DEVELOPMENT_DEPENDS hashphase_libraries)
set(CPACK_COMPONENT_HASHPHASE_DEVELOPMENT_DESCRIPTION "${about}
.
This package has the headers, what CMake and pkg-config find them by, and nine
programs to copy, in /usr/share/doc/libhashphase-dev/examples.")

set(CPACK_DEBIAN_HASHPHASE_TOOLS_PACKAGE_NAME hashphase)
set(CPACK_DEBIAN_HASHPHASE_TOOLS_PACKAGE_SECTION science)
set(CPACK_DEBIAN_HASHPHASE_TOOLS_PACKAGE_SHLIBDEPS ON)
# Programs that draw load OpenGL when they run.
set(CPACK_DEBIAN_HASHPHASE_TOOLS_PACKAGE_RECOMMENDS "libegl1, libegl-mesa0, libgl1-mesa-dri")
set(CPACK_COMPONENT_HASHPHASE_TOOLS_DEPENDS hashphase_libraries)
set(CPACK_COMPONENT_HASHPHASE_TOOLS_DESCRIPTION "${about}
.
This package has the program hashphase, which compares it with Bullet's own
broadphases on many scenes, tries it on programs as they are, and shows it
at work; its subcommands are programs of their own, hashphase-compare and others.")

# dpkg-shlibdeps looks for the libraries of the other package where they are built; when others use the
# package, it is the file `shlibs` that tells what they depend on.
get_property(components GLOBAL PROPERTY HASHPHASE_COMPONENTS)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS_PRIVATE_DIRS "")
set(shlibs "")
foreach(component IN LISTS components)
    string(REPLACE "-" "_" target hashphase_${component})
    get_target_property(folder ${target} BINARY_DIR)
    list(APPEND CPACK_DEBIAN_PACKAGE_SHLIBDEPS_PRIVATE_DIRS ${folder})
    string(APPEND shlibs "lib${target} ${HASHPHASE_ABI_VERSION} ${librariesPackage} "
                         "(>= ${PROJECT_VERSION})\n")
endforeach()
list(REMOVE_DUPLICATES CPACK_DEBIAN_PACKAGE_SHLIBDEPS_PRIVATE_DIRS)
file(CONFIGURE OUTPUT ${packageFiles}/shlibs CONTENT "${shlibs}" @ONLY)

# What every Debian package has in its folder of /usr/share/doc.
find_program(HASHPHASE_GZIP gzip)
mark_as_advanced(HASHPHASE_GZIP)
if(HASHPHASE_GZIP)
    string(TIMESTAMP date "%a, %d %b %Y %H:%M:%S +0000" UTC)
    configure_file(${CMAKE_CURRENT_LIST_DIR}/debian/changelog.in ${packageFiles}/changelog @ONLY)
    configure_file(${CMAKE_CURRENT_LIST_DIR}/debian/copyright.in ${packageFiles}/copyright @ONLY)
    configure_file(${CMAKE_CURRENT_LIST_DIR}/debian/hashphase.1.in ${packageFiles}/hashphase.1 @ONLY)
    configure_file(${CMAKE_CURRENT_LIST_DIR}/debian/hashphase-wander.1.in
                   ${packageFiles}/hashphase-wander.1 @ONLY)
    foreach(file IN ITEMS changelog hashphase.1 hashphase-wander.1)
        execute_process(COMMAND ${HASHPHASE_GZIP} -9nf ${packageFiles}/${file} COMMAND_ERROR_IS_FATAL ANY)
    endforeach()
    foreach(component IN ITEMS libraries development tools)
        string(TOUPPER ${component} upper)
        set(package ${CPACK_DEBIAN_HASHPHASE_${upper}_PACKAGE_NAME})
        install(
            FILES ${packageFiles}/changelog.gz ${packageFiles}/copyright
            DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/${package}
            COMPONENT hashphase_${component}
            EXCLUDE_FROM_ALL)
    endforeach()
    install(
        DIRECTORY ${PROJECT_SOURCE_DIR}/demos/examples
        DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/${CPACK_DEBIAN_HASHPHASE_DEVELOPMENT_PACKAGE_NAME}
        COMPONENT hashphase_development
        EXCLUDE_FROM_ALL)
    install(
        FILES ${CMAKE_CURRENT_LIST_DIR}/debian/libraries.lintian-overrides
        DESTINATION ${CMAKE_INSTALL_DATADIR}/lintian/overrides
        RENAME ${librariesPackage}
        COMPONENT hashphase_libraries
        EXCLUDE_FROM_ALL)
    install(
        FILES ${packageFiles}/hashphase.1.gz ${packageFiles}/hashphase-wander.1.gz
        DESTINATION ${CMAKE_INSTALL_MANDIR}/man1
        COMPONENT hashphase_tools
        EXCLUDE_FROM_ALL)
endif()

include(CPack)
