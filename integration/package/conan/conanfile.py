# SPDX-License-Identifier: Zlib
#
# A recipe for Conan 2, which builds the repository that it lies in:
#
#   conan create integration/package/conan --build=missing -s compiler.cppstd=20
#
# Bullet's own option says the precision: -o "bullet3/*:double_precision=True".

import os
import re

from conan import ConanFile
from conan.tools.build import check_min_cppstd
from conan.tools.cmake import CMake, CMakeDeps, CMakeToolchain, cmake_layout
from conan.tools.files import copy, load, rmdir

required_conan_version = ">=2.0"

REPOSITORY = os.path.join("..", "..", "..")
CLIENTS = {"ai": [], "camera": [], "culling": ["camera"], "picking": ["camera"], "terrain": []}
# hashphase::mpi is built where there is a cluster's own MPI, not here.
ALONE = ("distributed",)


class HashphaseConan(ConanFile):
    name = "hashphase"
    description = "A spatial-hash broadphase for the Bullet physics engine"
    license = "Zlib"
    topics = ("bullet", "physics", "broadphase", "collision-detection", "spatial-hash")
    package_type = "library"
    settings = "os", "arch", "compiler", "build_type"
    options = {"shared": [True, False], "fPIC": [True, False]}
    default_options = {"shared": False, "fPIC": True}
    implements = ["auto_shared_fpic"]

    def set_version(self):
        text = load(self, os.path.join(self.recipe_folder, REPOSITORY, "CMakeLists.txt"))
        self.version = re.search(r"^ +VERSION ([0-9.]+)$", text, re.MULTILINE).group(1)

    def export_sources(self):
        source = os.path.join(self.recipe_folder, REPOSITORY)
        for pattern in ("CMakeLists.txt", "LICENSE", "broadphase/*", "integration/*"):
            copy(self, pattern, source, self.export_sources_folder)

    def requirements(self):
        # Both are in public headers.
        self.requires("bullet3/3.25", transitive_headers=True, transitive_libs=True)
        self.requires("eigen/3.4.0", transitive_headers=True)

    def validate(self):
        check_min_cppstd(self, 20)

    def layout(self):
        cmake_layout(self)

    def generate(self):
        toolchain = CMakeToolchain(self)
        # The Bullet that pkg-config knows is the system's.
        toolchain.cache_variables["CMAKE_DISABLE_FIND_PACKAGE_PkgConfig"] = True
        toolchain.cache_variables["HASHPHASE_BUILD_DEMOS"] = False
        toolchain.cache_variables["HASHPHASE_BUILD_TESTS"] = False
        toolchain.cache_variables["HASHPHASE_MPI"] = "OFF"
        toolchain.cache_variables["HASHPHASE_WARNINGS_AS_ERRORS"] = False
        toolchain.cache_variables["CMAKE_DEBUG_POSTFIX"] = ""  # a package for each build type
        # Whoever compiles against the package is told the same (package_info).
        toolchain.cache_variables["HASHPHASE_ASSERTS"] = self._has_asserts
        toolchain.generate()
        CMakeDeps(self).generate()

    def build(self):
        cmake = CMake(self)
        cmake.configure()
        cmake.build()

    def package(self):
        copy(self, "LICENSE", self.source_folder, os.path.join(self.package_folder, "licenses"))
        CMake(self).install()
        # Conan writes its own, by package_info().
        rmdir(self, os.path.join(self.package_folder, "lib", "cmake"))
        rmdir(self, os.path.join(self.package_folder, "lib", "pkgconfig"))

    @property
    def _has_asserts(self):
        return self.settings.build_type != "Release"

    def package_info(self):
        self.cpp_info.set_property("cmake_file_name", "hashphase")
        self._add_library("broadphase", ["eigen::eigen"])
        flags = {"ENABLE_ASSERTS": self._has_asserts, "SHARED": self.options.shared}
        self.cpp_info.components["broadphase"].defines = self._defines(flags)
        for client, others in CLIENTS.items():
            self._add_library(client, ["broadphase", *others])
        self._add_library("effects", list(CLIENTS))
        for client in ALONE:
            self._add_library(client, ["broadphase"])
        is_double = self.dependencies["bullet3"].options.get_safe("double_precision")
        bullet = "bullet-float64" if is_double else "bullet"
        self._add_library(bullet, ["broadphase", "bullet3::bullet3"])
        # CMake cannot tell of a target of Conan's that it is shared (integration/bullet/CMakeLists.txt).
        defines = self._defines({"BULLET_IS_STATIC": self.options.shared})
        if is_double:
            defines.append("BT_USE_DOUBLE_PRECISION")
        self.cpp_info.components[bullet].defines = defines

    @staticmethod
    def _defines(flags):
        return [f"HASHPHASE_{name}={int(bool(value))}" for name, value in flags.items()]

    def _add_library(self, name, requires):
        component = self.cpp_info.components[name]
        component.set_property("cmake_target_name", f"hashphase::{name}")
        component.set_property(
            "pkg_config_name", "hashphase" if name == "broadphase" else f"hashphase-{name}"
        )
        component.includedirs = [os.path.join("include", "hashphase")]
        component.libs = ["hashphase_" + name.replace("-", "_")]
        component.requires = requires
        if self.settings.os in ("Linux", "FreeBSD"):
            component.system_libs = ["m"]
