// SPDX-License-Identifier: MIT
#include <string>
#include <utility>

#if !defined(_WIN32)
#include <fcntl.h>
#include <unistd.h>

#include <taut/impl/files/file/posix_file.hpp>
#endif

#include <doctest/doctest.h>

#include <support/temporary_folder.hpp>
#include <taut/errors.hpp>
#include <taut/impl/files/surface/pins.hpp>
#include <taut/impl/files/volume/read_volume.hpp>
#include <taut/surface_file.hpp>
#include <taut/volume_file.hpp>

using namespace taut;

namespace
{

const std::string obj = "# a comment\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
const std::string off = "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";
const std::string coff = "COFF\n3 1 0\n0 0 0 1 0 0\n1 0 0 0 1 0\n0 1 0 0 0 1\n3 0 1 2\n";
const std::string ply =
    "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
    "element face 1\nproperty list uchar int vertex_indices\nend_header\n"
    "0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";

} // namespace

TEST_CASE("read_surface: a name that says nothing is read in the format that is given")
{
    const test::temporary_folder folder;
    for (const auto& [text, format] :
         {std::pair(obj, io::surface_format::obj), {off, io::surface_format::off}, {ply, io::surface_format::ply}})
    {
        folder.write(folder / "a.dat", text);
        CHECK(io::read_surface(folder / "a.dat", format).cell_count() == 1);
        CHECK_THROWS_WITH_AS(io::read_surface(folder / "a.dat"), doctest::Contains("unknown kind"), io::io_error);
    }
    folder.write(folder / "off.obj", off);
    CHECK(io::read_surface(folder / "off.obj", io::surface_format::off).cell_count() == 1);
}

#if !defined(_WIN32) // no names for numbers of files there
TEST_CASE("read_surface: what is open already is read from where it is, in the format it begins with")
{
    const test::temporary_folder folder;
    const auto header_less = off.substr(4);
    for (const auto& text : {obj, off, ply, header_less, "\xef\xbb\xbf# comment\n\n" + coff, "\n#\r\n" + off})
    {
        folder.write(folder / "a.dat", "passed over\n" + text);
        const io::impl::descriptor open(::open((folder / "a.dat").c_str(), O_RDONLY));
        REQUIRE(::lseek(*open, 12, SEEK_SET) == 12);
        CHECK(io::read_surface("/dev/fd/" + std::to_string(*open)).cell_count() == 1);
    }
}
#endif

TEST_CASE("read_surface: UTF-16 is named, with a byte order mark and without")
{
    const test::temporary_folder folder;
    for (const bool big : {false, true})
        for (const bool mark : {false, true})
            for (const auto& [name, text] :
                 {std::pair("a.obj", obj), {"a.off", off}, {"a.ply", ply}, {"a.stl", "solid a\nendsolid\n"}})
            {
                std::string wide = mark ? (big ? "\xfe\xff" : "\xff\xfe") : "";
                for (const char c : std::string(text))
                {
                    wide += big ? '\0' : c;
                    wide += big ? c : '\0';
                }
                folder.write(folder / name, wide);
                CHECK_THROWS_WITH_AS(io::read_surface(folder / name), doctest::Contains("in UTF-16; save it as UTF-8"),
                                     io::io_error);
                CHECK_THROWS_WITH_AS(io::impl::parse_volume(wide, io::volume_format::medit),
                                     doctest::Contains("in UTF-16"), io::io_error);
                CHECK_THROWS_WITH_AS(io::impl::parse_pins<2>(wide), doctest::Contains("in UTF-16"), io::io_error);
            }
}
