// SPDX-License-Identifier: MIT
#include <filesystem>
#include <string>

#include <doctest/doctest.h>

#include <support/temporary_folder.hpp>
#include <taut/errors.hpp>
#include <taut/impl/files/file/plain_file.hpp>
#include <taut/impl/files/file/read_file.hpp>

using namespace taut;
using io::impl::plain_file;
using test::temporary_folder;

// What systems without POSIX write files by; written_files.cpp has more, on systems with it.

TEST_CASE("plain_file: a file appears in the end, in the place of an older one, and nothing is left without that")
{
    const temporary_folder folder;
    const auto path = folder / "map.obj";
    for (const std::string text : {"one\r\ntwo\n\x1a three", "shorter\n", ""}) // no byte is another one on disk
    {
        {
            plain_file unfinished(io::impl::resolve_target(path));
            unfinished.write("half");
        }
        plain_file file(io::impl::resolve_target(path));
        file.write(text);
        file.finish();
        file.rename();
        CHECK(io::impl::read_file(path) == text);
        CHECK(folder.entries() == 1);
    }
}

TEST_CASE("plain_file: names of all alphabets")
{
    const temporary_folder folder;
    const auto path = std::filesystem::path(folder / "x").replace_filename(u8"\u03c4\u03b1\u03cd\u03c4 \u00fc.obj");
    plain_file file(io::impl::resolve_target(path));
    file.write("v 0 0 0\n");
    file.finish();
    file.rename();
    CHECK(std::filesystem::is_regular_file(path));
    CHECK(io::impl::read_file(path) == "v 0 0 0\n");
}

TEST_CASE("plain_file: what cannot be written is an error, before and at the time of writing")
{
    const temporary_folder folder;
    const auto missing = std::filesystem::path(folder / "no folder") / "map.obj";
    CHECK_THROWS_AS(plain_file::require_writable(io::impl::resolve_target(missing)), io::io_error);
    CHECK_THROWS_AS(plain_file(io::impl::resolve_target(missing)), io::io_error);
    CHECK_THROWS_AS(io::impl::read_file(missing), io::io_error);
    CHECK_NOTHROW(plain_file::require_writable(io::impl::resolve_target(folder / "map.obj")));
    CHECK(folder.entries() == 0);
}

TEST_CASE("plain_file: standard output is written where it stands")
{
    plain_file out(io::impl::resolve_target("/dev/stdout"));
    CHECK_NOTHROW(out.write(""));
    CHECK_NOTHROW(out.finish());
}
