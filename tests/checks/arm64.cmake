# SPDX-License-Identifier: Zlib
#
# Debian's cross compiler for 64-bit ARM, and QEMU to run what it makes. Packages of that architecture are
# unpacked in HASHPHASE_SYSROOT.

set(CMAKE_SYSTEM_NAME Linux)
set(CMAKE_SYSTEM_PROCESSOR aarch64)
set(CMAKE_CXX_COMPILER aarch64-linux-gnu-g++)
set(CMAKE_CROSSCOMPILING_EMULATOR qemu-aarch64 -L /usr/aarch64-linux-gnu)

set(CMAKE_TRY_COMPILE_PLATFORM_VARIABLES HASHPHASE_SYSROOT)
set(CMAKE_FIND_ROOT_PATH ${HASHPHASE_SYSROOT} /usr/aarch64-linux-gnu)
set(CMAKE_LIBRARY_ARCHITECTURE aarch64-linux-gnu)
set(CMAKE_FIND_ROOT_PATH_MODE_LIBRARY ONLY)
set(ENV{PKG_CONFIG_LIBDIR} ${HASHPHASE_SYSROOT}/usr/lib/aarch64-linux-gnu/pkgconfig)
set(ENV{PKG_CONFIG_SYSROOT_DIR} ${HASHPHASE_SYSROOT})
# GCC notes at each call how an older one would have passed it.
set(CMAKE_CXX_FLAGS_INIT "-isystem \"${HASHPHASE_SYSROOT}/usr/include/aarch64-linux-gnu\" -Wno-psabi")
