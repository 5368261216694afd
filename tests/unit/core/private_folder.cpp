// SPDX-License-Identifier: MIT
#include <filesystem>
#include <string>

#include <doctest/doctest.h>

#include <taut/impl/core/compute/program/private_folder.hpp>

#include "support/temporary_folder.hpp"

#if defined(__unix__) || defined(__APPLE__)
namespace
{

namespace fs = std::filesystem;
using taut::impl::fault_of_folder;

void permit(const fs::path& folder, unsigned mode)
{
    fs::permissions(folder, fs::perms(mode));
}

} // namespace

TEST_CASE("private folders: made for the user alone, with those above")
{
    const taut::test::temporary_folder folder;
    permit(folder / "", 0755);
    CHECK(taut::impl::fault_of_made_folder(folder / "a/b/").empty());
    for (const char* name : {"a", "a/b"}) CHECK(fs::status(folder / name).permissions() == fs::perms::owner_all);
    CHECK(fault_of_folder(folder / "none").find("No such") == 0);
    folder.write(folder / "file", "");
    CHECK_FALSE(taut::impl::fault_of_made_folder(folder / "file").empty());
}

TEST_CASE("private folders: no link, none that others write in, and none that others may rename")
{
    const taut::test::temporary_folder folder;
    permit(folder / "", 0755);
    const fs::path own = folder / "own", link = folder / "link";
    fs::create_directory(own);
    fs::create_directory_symlink(own, link);
    permit(own, 0755);
    CHECK(fault_of_folder(own).empty());
    for (const auto& name : {link, link / ""}) CHECK(fault_of_folder(name).find("link") != std::string::npos);
    permit(own, 0775);
    CHECK_FALSE(fault_of_folder(own).empty());
    CHECK(fault_of_folder(own, 0002).empty());
    permit(own, 0755);
    permit(folder / "", 0777);
    CHECK(fault_of_folder(own).find("rename") != std::string::npos);
    CHECK_FALSE(taut::impl::fault_of_made_folder(own / "a/b/c").empty());
    permit(folder / "", 01777); // as /tmp
    CHECK(fault_of_folder(own).empty());
    CHECK(taut::impl::fault_of_made_folder(own / "a/b/c").empty());
}
#endif
