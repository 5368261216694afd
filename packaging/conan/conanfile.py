# SPDX-License-Identifier: MIT
import os

from conan import ConanFile
from conan.tools.build import check_min_cppstd
from conan.tools.cmake import CMake, CMakeDeps, CMakeToolchain, cmake_layout
from conan.tools.files import copy, get

required_conan_version = ">=2.0"


class TautConan(ConanFile):
    name = "taut"
    description = "Injective, low-distortion maps of triangle and tetrahedral meshes on GPUs and processors"
    license = "MIT"
    homepage = "https://taut.example"
    topics = ("mesh", "parameterization", "uv", "atlas", "opencl", "header-only")
    package_type = "header-library"
    settings = "os", "arch", "compiler", "build_type"
    options = {"with_gltf": [True, False], "with_eigen": [True, False], "with_compression": [True, False]}
    default_options = {"with_gltf": True, "with_eigen": False, "with_compression": True}

    def layout(self):
        cmake_layout(self, src_folder="src")

    def requirements(self):
        self.requires("boost/[>=1.71 <2]", options={"header_only": True})
        self.requires("glm/[>=0.9.9 <2]")
        self.requires("opencl-headers/2023.12.14")
        if self.options.with_gltf:
            self.requires("nlohmann_json/[>=3.11 <4]")
        if self.options.with_compression:  # of VTU files
            self.requires("zlib/[>=1.2.11 <2]")
            self.requires("xz_utils/[>=5.4 <6]")
            self.requires("lz4/[>=1.9 <2]")
        if self.options.with_eigen:
            self.requires("eigen/[>=3.4 <4]")

    def validate(self):
        check_min_cppstd(self, 20)

    def package_id(self):
        self.info.clear()

    def source(self):
        get(self, **self.conan_data["sources"][self.version], strip_root=True)

    def generate(self):
        CMakeDeps(self).generate()
        toolchain = CMakeToolchain(self)
        for part in ("TAUT_TESTS", "TAUT_EXAMPLES", "TAUT_BENCH", "TAUT_TOOLS", "TAUT_MPI"):
            toolchain.cache_variables[part] = False
        toolchain.generate()

    def build(self):
        CMake(self).configure()

    def package(self):
        CMake(self).install()
        for name in ("LICENSE", "THIRD_PARTY.md"):
            copy(self, name, self.source_folder, os.path.join(self.package_folder, "licenses"))

    def package_info(self):
        # taut's own files for CMake: taut::taut has bodies, which the user's build compiles.
        self.cpp_info.set_property("cmake_find_mode", "none")
        self.cpp_info.builddirs = [os.path.join("share", "cmake", "taut")]
        self.cpp_info.bindirs = []
        self.cpp_info.libdirs = []
