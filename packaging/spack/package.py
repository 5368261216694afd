# SPDX-License-Identifier: MIT
from spack.package import *


class Taut(CMakePackage):
    """Injective, low-distortion maps of triangle and tetrahedral meshes on GPUs and processors."""

    homepage = "https://taut.example"
    url = "https://taut.example/releases/taut-1.0.0-rc.1.tar.gz"
    license("MIT")

    version("1.0.0-rc.1", sha256="0000000000000000000000000000000000000000000000000000000000000000")

    variant("cli", default=True, description="Build the command line program")
    variant("mpi", default=False, description="Build taut::dist and taut-mpi: one mesh over many processes")

    depends_on("cxx", type="build")
    depends_on("cmake@3.22:", type="build")
    depends_on("opencl@1.2:")
    depends_on("boost@1.71:")
    depends_on("glm@0.9.9:")
    with when("+cli"):
        depends_on("cli11", type="build")
        depends_on("nlohmann-json", type="build")
        depends_on("eigen@3.4:", type="build")
        depends_on("stb", type="build")
        depends_on("openssl")
        depends_on("zlib-api")
        depends_on("xz")
        depends_on("lz4")

    with when("+mpi"):
        depends_on("mpi")
        depends_on("petsc@3.18: +mpi+hypre~complex")

    def cmake_args(self):
        return [
            self.define("TAUT_TESTS", False),
            self.define("TAUT_EXAMPLES", False),
            self.define("TAUT_BENCH", False),
            self.define("TAUT_MPI", False),
            self.define_from_variant("TAUT_TOOLS", "cli"),
            self.define_from_variant("TAUT_MPI", "mpi"),
        ]
