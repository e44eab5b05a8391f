# SPDX-License-Identifier: Zlib
#
# An overlay port, which builds the repository that it lies in:
#
#   vcpkg install hashphase --overlay-ports=<repository>/integration/package/vcpkg
#
# vcpkg does not see when the repository changes: remove the package before it is installed anew, and
# take --no-binarycaching.

get_filename_component(SOURCE_PATH "${CMAKE_CURRENT_LIST_DIR}/../../../.." ABSOLUTE)

# vcpkg's Bullet is in single or double precision, as its feature `double-precision` says, and that is
# the library that is made. The Bullet that pkg-config finds may be the system's.
vcpkg_cmake_configure(
    SOURCE_PATH "${SOURCE_PATH}"
    OPTIONS
        -DCMAKE_DEBUG_POSTFIX=
        -DCMAKE_DISABLE_FIND_PACKAGE_PkgConfig=ON
        -DHASHPHASE_BUILD_DEMOS=OFF
        -DHASHPHASE_BUILD_TESTS=OFF
        -DHASHPHASE_MPI=OFF
)
vcpkg_cmake_install()
vcpkg_copy_pdbs()
vcpkg_cmake_config_fixup(CONFIG_PATH lib/cmake/hashphase)
vcpkg_fixup_pkgconfig()

file(REMOVE_RECURSE "${CURRENT_PACKAGES_DIR}/debug/include")
file(INSTALL "${CMAKE_CURRENT_LIST_DIR}/usage" DESTINATION "${CURRENT_PACKAGES_DIR}/share/${PORT}")
vcpkg_install_copyright(FILE_LIST "${SOURCE_PATH}/LICENSE")
