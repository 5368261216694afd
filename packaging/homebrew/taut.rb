# SPDX-License-Identifier: MIT
class Taut < Formula
  desc "Injective, low-distortion maps of meshes on GPUs and processors"
  homepage "https://taut.example"
  url "https://taut.example/releases/taut-1.0.0-rc.1.tar.gz"
  sha256 "0000000000000000000000000000000000000000000000000000000000000000"
  license "MIT"

  depends_on "cli11" => :build
  depends_on "cmake" => :build
  depends_on "eigen" => :build
  depends_on "nlohmann-json" => :build
  depends_on "boost"
  depends_on "glm"
  depends_on "lz4"
  depends_on "opencl-headers"
  depends_on "opencl-icd-loader"
  depends_on "openssl@3"
  depends_on "pocl"
  depends_on "xz"

  uses_from_macos "zlib"

  # Headers that no formula has.
  resource "stb" do
    url "https://taut.example/releases/stb-5736b15.tar.gz"
    sha256 "0000000000000000000000000000000000000000000000000000000000000000"
  end

  def install
    (buildpath/"stb").install resource("stb")
    system "cmake", "-S", ".", "-B", "build", *std_cmake_args,
           "-DTAUT_TESTS=OFF", "-DTAUT_EXAMPLES=OFF", "-DTAUT_BENCH=OFF", "-DTAUT_TOOLS=ON", "-DTAUT_MPI=OFF",
           "-DTAUT_STB_INCLUDE=#{buildpath}/stb"
    system "cmake", "--build", "build"
    system "cmake", "--install", "build"
    pkgshare.install "examples/unwrap.cpp"
  end

  test do
    system ENV.cxx, "-std=c++20", pkgshare/"unwrap.cpp", "-I#{include}",
           "-L#{Formula["opencl-icd-loader"].opt_lib}", "-pthread", "-o", "unwrap"
    assert_match version.to_s, shell_output("#{bin}/taut --version")
  end
end
