// SPDX-License-Identifier: MIT
#include <chrono>
#include <filesystem>
#include <iterator>
#include <string>

#if defined(__unix__) || defined(__APPLE__)
#include <sys/stat.h>
#endif

#include <doctest/doctest.h>

#include <taut/impl/core/compute/program/program_store.hpp>
#include <taut/impl/core/compute/quirks.hpp>
#include <taut/queue.hpp>

#include "support/device.hpp"
#include "support/opencl.hpp"
#include "support/temporary_folder.hpp"

namespace
{

namespace fs = std::filesystem;
using taut::impl::program_store;

const std::string text_of_twice = "__kernel void twice(__global float* x) { x[get_global_id(0)] *= 2; }";
const std::string text_of_thrice = "__kernel void thrice(__global float* x) { x[get_global_id(0)] *= 3; }";
const std::string plain_options = "-cl-std=CL1.2 -w";

fs::path only_file(const fs::path& folder)
{
    REQUIRE(std::distance(fs::directory_iterator(folder), {}) == 1);
    return fs::directory_iterator(folder)->path();
}

/// The kernel of what the store builds or takes for the text of `twice`.
std::string kernel_of_built(const program_store& store, const taut::queue& q)
{
    boost::compute::program made;
    store.build(made, boost::compute::context(q.native_context()), q.device(), text_of_twice, plain_options);
    return made.get_info<std::string>(CL_PROGRAM_KERNEL_NAMES);
}

} // namespace

TEST_CASE("program_store: bytes are found by their key, by other stores of the folder, too")
{
    const taut::test::temporary_folder folder;
    const auto programs = folder / "a" / "b";
    const std::string bytes("\0\n x", 4);
    program_store(programs).keep("key", bytes);
    CHECK(program_store(programs).find("key") == bytes);
    CHECK(program_store(programs).find("ke").empty());
    CHECK(program_store({}).find("key").empty());
    program_store(programs).keep("key", "other");
    CHECK(program_store(programs).find("key") == "other");
    only_file(programs);
}

TEST_CASE("program_store: a file that is not whole, or of another key, is none")
{
    const taut::test::temporary_folder folder;
    const auto programs = folder / "programs";
    const program_store store(programs);
    store.keep("key", "bytes");
    const auto file = only_file(programs);
    const std::string whole = folder.read(file);
    for (std::string text : {whole.substr(0, whole.size() - 1), whole + '!', whole.substr(1), std::string(), whole})
    {
        if (text == whole) text.back() ^= 1;
        folder.write(file, text);
        CHECK(store.find("key").empty());
    }
    store.keep("other", "bytes");
    fs::rename(only_file((fs::remove(file), programs)), file);
    CHECK(store.find("key").empty());
}

TEST_CASE("program_store: files that were used last stay within the limit")
{
    const taut::test::temporary_folder folder;
    const program_store store(folder / "programs", 14000);
    const std::string bytes(3000, 'x');
    for (const char* key : {"a", "b", "c", "d"})
    {
        store.keep(key, bytes);
        for (const auto& file : fs::directory_iterator(folder / "programs")) // as if some time had passed
            fs::last_write_time(file.path(), fs::last_write_time(file.path()) - std::chrono::hours(1));
    }
    CHECK(store.find("a").size() == bytes.size());
    store.keep("e", bytes);
    for (const char* key : {"b", "c", "d"}) CHECK(store.find(key).empty());
    for (const char* key : {"a", "e"}) CHECK(store.find(key).size() == bytes.size());
}

TEST_CASE("program_store: files of others in its folder are neither counted nor removed")
{
    const taut::test::temporary_folder folder;
    const auto programs = folder / "programs";
    const program_store store(programs, 20000);
    const std::string bytes(3000, 'x');
    for (const char* name : {"thesis.dat", "a.partial", "taut-program", ".taut-program"})
    {
        folder.write(programs / name, std::string(100000, 'x'));
        fs::last_write_time(programs / name, fs::file_time_type::clock::now() - std::chrono::hours(24));
    }
    store.keep("a", bytes);
    CHECK(store.find("a") == bytes);
    for (int k = 0; k < 8; ++k) store.keep(std::to_string(k), bytes); // now it is cleaned
    for (const char* name : {"thesis.dat", "a.partial", "taut-program", ".taut-program"})
        CHECK(folder.read(programs / name).size() == 100000);
    CHECK(store.find("7") == bytes);
    CHECK(store.find("a").empty());
}

TEST_CASE("program_store: an entry that is no file costs time and is no error")
{
    const taut::test::temporary_folder folder;
    const auto programs = folder / "programs";
    const program_store store(programs);
    store.keep("key", "bytes");
    const auto file = only_file(programs);
    fs::remove(file);
    fs::create_directory(file);
    CHECK(store.find("key").empty());
    store.keep("key", "bytes");
    CHECK(fs::is_empty(file));
    only_file(programs); // and nothing is left
    fs::remove(file);
#if defined(__unix__) || defined(__APPLE__)
    REQUIRE(::mkfifo(file.c_str(), 0600) == 0);
    CHECK(store.find("key").empty());
    fs::remove(file);
    fs::create_symlink("/dev/zero", file);
    CHECK(store.find("key").empty());
#endif
    store.keep("key", "bytes");
    CHECK(store.find("key") == "bytes");
}

#if defined(__unix__) || defined(__APPLE__)
TEST_CASE("program_store: nothing is taken from a folder in which others may write, or that a link leads to")
{
    const taut::test::temporary_folder folder;
    program_store(folder / "programs").keep("key", "bytes");
    fs::create_directory_symlink(folder / "programs", folder / "link");
    CHECK(program_store(folder / "link").find("key").empty());
    fs::permissions(folder / "programs", fs::perms::others_write, fs::perm_options::add);
    const program_store open(folder / "programs");
    CHECK(open.find("key").empty());
    open.keep("more", "bytes");
    only_file(folder / "programs");
}
#endif

TEST_CASE("program_store: programs are built once, and again where the driver does not take what was kept")
{
    if (!taut::test::compiles_text()) return;
    const taut::test::temporary_folder folder;
    const program_store store(folder / "programs");
    const taut::queue q, p;
    CHECK(kernel_of_built(store, q) == "twice");
    const std::string key = taut::impl::key_of(q.device(), text_of_twice, plain_options);
    REQUIRE_FALSE(store.find(key).empty());

    // What is taken is what was kept.
    boost::compute::program made;
    store.build(made, boost::compute::context(q.native_context()), q.device(), text_of_thrice, plain_options);
    store.keep(key, store.find(taut::impl::key_of(q.device(), text_of_thrice, plain_options)));
    CHECK(kernel_of_built(store, p) == "thrice");

    store.keep(key, "no program");
    CHECK(kernel_of_built(store, p) == "twice");
    CHECK(store.find(key) != "no program");
}

TEST_CASE("program_store: the user's is where the environment says, for drivers that keep none")
{
    if (!taut::test::compiles_text()) return;
    const taut::test::temporary_folder folder;
    const taut::queue q;
    const taut::test::with_variable named("TAUT_CACHE_DIR", (folder / "programs").string());
    program_store::of(q.device()).keep("key", "bytes");
    CHECK(fs::exists(folder / "programs" / "taut-programs") == taut::impl::quirks::keeps_no_programs(q.device()));
    const taut::test::with_variable off("TAUT_CACHE_DIR", "0");
    CHECK(program_store::of(q.device()).find("key").empty());
}
