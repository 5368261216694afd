// SPDX-License-Identifier: MIT
#include <filesystem>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <doctest/doctest.h>

#include <support/temporary_folder.hpp>
#include <taut/errors.hpp>
#include <taut/files.hpp>
#include <taut/impl/files/file/atomic_file_bodies.hpp>
#include <taut/impl/files/file/plain_file.hpp>
#include <taut/impl/files/file/read_file.hpp>
#include <taut/surface_file.hpp>

using namespace taut;
using test::temporary_folder;
namespace fs = std::filesystem;

namespace
{

/// As systems do it that have no files without a name.
struct named_file : io::impl::posix_file
{
    explicit named_file(const io::impl::file_target& target) : posix_file(target, false) {}
};

template <class File>
void write_with(const fs::path& path, const std::string& text)
{
    File file(io::impl::resolve_target(path));
    file.write(text);
    file.finish();
    file.link();
    file.rename();
}

unsigned mode_of(const fs::path& path)
{
    return static_cast<unsigned>(fs::status(path).permissions());
}

/// The single entry of a folder that is none of ours.
fs::path hidden_in(const fs::path& folder)
{
    for (const auto& entry : fs::directory_iterator(folder))
        if (entry.path().filename().string().starts_with(".taut-")) return entry.path();
    return {};
}

} // namespace

#define EVERY_FILE io::impl::posix_file, named_file, io::impl::plain_file

TEST_CASE_TEMPLATE("written files: nothing is there before the end, and nothing is left without it", File, EVERY_FILE)
{
    const temporary_folder folder;
    folder.write(folder / "old.txt", "old and long");
    for (const char* name : {"new.txt", "old.txt"})
    {
        File file(io::impl::resolve_target(folder / name));
        file.write("half");
        CHECK_FALSE(fs::exists(folder / "new.txt"));
        file.finish();
        file.link();
        CHECK_FALSE(fs::exists(folder / "new.txt"));
    }
    CHECK(folder.entries() == 1);
    CHECK(folder.read(folder / "old.txt") == "old and long");
}

TEST_CASE_TEMPLATE("written files: an older file is replaced as a whole and keeps its permissions", File, EVERY_FILE)
{
    const temporary_folder folder;
    const auto path = folder / std::string(255, 'n'); // the longest legal name
    folder.write(path, "old and long");
    for (const unsigned mode : {0600u, 0640u, 0755u})
    {
        fs::permissions(path, static_cast<fs::perms>(mode));
        write_with<File>(path, "new");
        CHECK(folder.read(path) == "new");
        CHECK(mode_of(path) == mode);
    }
    CHECK(folder.entries() == 1);
}

TEST_CASE_TEMPLATE("written files: a new file has the permissions of any new file", File, EVERY_FILE)
{
    const temporary_folder folder;
    const auto before = ::umask(027);
    folder.write(folder / "a", "");
    write_with<File>(folder / "b", "");
    ::umask(before);
    CHECK(mode_of(folder / "b") == mode_of(folder / "a"));
}

TEST_CASE_TEMPLATE("written files: links are followed, to where there is no file yet, too", File, EVERY_FILE)
{
    const temporary_folder folder;
    fs::create_directory(folder / "d");
    fs::create_symlink("d/second", folder / "first");
    fs::create_symlink("../real.txt", folder / "d" / "second");
    for (const char* text : {"made", "replaced"})
    {
        write_with<File>(folder / "first", text);
        CHECK(folder.read(folder / "real.txt") == text);
        CHECK(fs::is_symlink(folder / "first"));
        CHECK(fs::is_symlink(folder / "d" / "second"));
    }
    CHECK(folder.entries() == 3);
}

TEST_CASE_TEMPLATE("written files: another hard link keeps the older text", File, EVERY_FILE)
{
    const temporary_folder folder;
    folder.write(folder / "a", "old");
    fs::create_hard_link(folder / "a", folder / "b");
    write_with<File>(folder / "a", "new");
    CHECK(folder.read(folder / "a") == "new");
    CHECK(folder.read(folder / "b") == "old");
}

TEST_CASE_TEMPLATE("written files: a pipe stays a pipe and gets the text", File, EVERY_FILE)
{
    const temporary_folder folder;
    const auto pipe = folder / "pipe";
    REQUIRE(::mkfifo(pipe.c_str(), 0600) == 0);
    std::string got;
    std::thread reader([&] { got = io::impl::read_file(pipe); });
    write_with<File>(pipe, "text");
    reader.join();
    CHECK(got == "text");
    CHECK(fs::is_fifo(pipe));
    CHECK(folder.entries() == 1);
}

TEST_CASE_TEMPLATE("written files: what cannot be written is an error with the reason", File, EVERY_FILE)
{
    const temporary_folder folder;
    const auto write = [&](const fs::path& path) { write_with<File>(path, std::string(1 << 20, 'x')); };
    fs::create_directory(folder / "d");
    fs::create_symlink("loop", folder / "loop");
    CHECK_THROWS_WITH_AS(write(folder / "missing" / "a"), doctest::Contains("No such file"), io::io_error);
    CHECK_THROWS_WITH_AS(write(folder / "d"), doctest::Contains("directory"), io::io_error);
    CHECK_THROWS_WITH_AS(write(folder / "d" / ""), doctest::Contains("directory"), io::io_error);
    CHECK_THROWS_WITH_AS(write(folder / "loop"), doctest::Contains("links"), io::io_error);
    CHECK(folder.entries() == 2);
    if (fs::exists("/dev/full")) CHECK_THROWS_WITH_AS(write("/dev/full"), doctest::Contains("space"), io::io_error);
}

TEST_CASE("written files: a file without a name is not to be seen while it is written")
{
    const temporary_folder folder;
    io::impl::posix_file file(io::impl::resolve_target(folder / "a"));
    file.write("text");
    if (folder.entries() != 0) MESSAGE("this file system has no files without a name");
    CHECK(folder.entries() <= 1);
}

TEST_CASE("written files: a temporary name cannot be guessed, is the user's own and is never opened again")
{
    const temporary_folder folder;
    folder.write(folder / "secret", "old");
    fs::permissions(folder / "secret", fs::perms::owner_read | fs::perms::owner_write);
    folder.write(folder / "victim", "precious");
    fs::path first;
    {
        named_file file(io::impl::resolve_target(folder / "secret"));
        first = hidden_in(folder / "");
        REQUIRE_FALSE(first.empty());
        CHECK(mode_of(first) == 0600);
        // Whoever puts a link in its place gains nothing.
        fs::remove(first);
        fs::create_symlink("victim", first);
        file.write("text");
    }
    CHECK(folder.read(folder / "victim") == "precious");
    named_file file(io::impl::resolve_target(folder / "secret"));
    const auto second = hidden_in(folder / "");
    CHECK(second != first);
    CHECK(second.filename().string().size() >= 16);
}

TEST_CASE("written files: remove_temporaries() removes what is unfinished and has a name, and nothing else")
{
    const temporary_folder folder;
    folder.write(folder / "a", "old");
    write_with<named_file>(folder / "done", "text");
    {
        named_file unfinished(io::impl::resolve_target(folder / "a"));
        io::impl::posix_file finished(io::impl::resolve_target(folder / "b"));
        finished.finish();
        finished.link();
        CHECK(folder.entries() == 4);
        io::impl::remove_temporaries();
        CHECK(folder.entries() == 2);
        CHECK_THROWS_AS(finished.rename(), io::io_error);

        // No other file gets a hidden name that nobody would remove.
        io::impl::posix_file late(io::impl::resolve_target(folder / "late"));
        late.finish();
        CHECK_THROWS_AS(late.link(), io::io_error);
        CHECK(folder.entries() == 2);
    }
    io::impl::remove_temporaries();
    io::impl::naming_is_over = false; // this program goes on
    CHECK(folder.read(folder / "a") == "old");
    CHECK(folder.read(folder / "done") == "text");

    // More at once than can be noted is no error.
    std::vector<std::unique_ptr<named_file>> many;
    for (int k = 0; k < 100; ++k)
        many.push_back(std::make_unique<named_file>(io::impl::resolve_target(folder / std::to_string(k))));
    CHECK(folder.entries() == 102);
    many.clear();
    CHECK(folder.entries() == 2);
}

TEST_CASE("written files: an open file is written where it stands, not replaced")
{
    const temporary_folder folder;
    const auto path = folder / "log";
    const io::impl::descriptor open(::open(path.c_str(), O_CREAT | O_RDWR, 0600));
    REQUIRE(::write(*open, "before ", 7) == 7);
    const std::string name = "/dev/fd/" + std::to_string(*open);
    CHECK(io::impl::is_stream(name));
    io::write_file(name, "after");
    fs::create_symlink(name, folder / "link");
    io::write_file(folder / "link", ", twice");
    CHECK(folder.read(path) == "before after, twice");
    CHECK(fs::is_symlink(folder / "link"));
    CHECK(::lseek(*open, 7, SEEK_SET) == 7);
    CHECK(io::impl::read_file(name) == "after, twice");
    CHECK_THROWS_AS(io::write_file("/dev/fd/9999", "text"), io::io_error);
    CHECK_THROWS_AS(io::impl::read_file("/dev/fd/9999"), io::io_error);
}

TEST_CASE("require_writable: says before the work what would be said after it, and changes nothing")
{
    const temporary_folder folder;
    folder.write(folder / "old", "old");
    REQUIRE(::mkfifo((folder / "pipe").c_str(), 0600) == 0);
    for (const char* name : {"old", "new", "pipe"}) CHECK_NOTHROW(io::impl::require_writable(folder / name));
    CHECK_NOTHROW(io::impl::require_writable("/dev/null"));
    CHECK_THROWS_AS(io::impl::require_writable(folder / "missing" / "a"), io::io_error);
    CHECK_THROWS_AS(io::impl::require_writable(folder / ""), io::io_error);
    CHECK_THROWS_AS(io::impl::require_writable("/dev/fd/9999"), io::io_error);
    CHECK(folder.read(folder / "old") == "old");
    CHECK(folder.entries() == 2);

    if (::geteuid() == 0) return; // may write anywhere
    fs::permissions(folder / "old", fs::perms::owner_read);
    fs::create_directory(folder / "sealed");
    fs::permissions(folder / "sealed", fs::perms::owner_read | fs::perms::owner_exec);
    for (const char* name : {"old", "sealed/new"})
    {
        CHECK_THROWS_WITH_AS(io::impl::require_writable(folder / name), doctest::Contains("Permission denied"),
                             io::io_error);
        CHECK_THROWS_WITH_AS(io::write_file(folder / name, ""), doctest::Contains("Permission denied"), io::io_error);
    }
    CHECK(folder.read(folder / "old") == "old");
}

TEST_CASE("write_files: all appear, or none")
{
    const temporary_folder folder;
    folder.write(folder / "a", "old");
    const auto text = [](std::string bytes) { return [=](io::atomic_file& file) { file.write(bytes); }; };
    const auto thrown = [](io::atomic_file&) { throw std::runtime_error("no"); };
    using files = std::vector<io::file_to_write>;
    CHECK_THROWS(io::write_files(files{{folder / "a", text("new")}, {folder / "b", thrown}}));
    CHECK_THROWS(io::write_files(files{{folder / "a", text("new")}, {folder / "missing" / "b", text("new")}}));
    if (fs::exists("/dev/full"))
        CHECK_THROWS_WITH_AS(io::write_files(files{{"/dev/full", text("new")}, {folder / "a", text("new")}}),
                             doctest::Contains("/dev/full"), io::io_error);
    CHECK(folder.read(folder / "a") == "old");
    CHECK(folder.entries() == 1);

    io::write_files(files{{folder / "a", text("new")}, {"/dev/null", text("new")}, {folder / "b", text("second")}});
    CHECK(folder.read(folder / "a") == "new");
    CHECK(folder.read(folder / "b") == "second");
    CHECK(folder.entries() == 2);
}

TEST_CASE("write_files: what cannot be taken back is written last")
{
    const temporary_folder folder;
    std::string order;
    const auto note = [&](char name) { return [&order, name](io::atomic_file&) { order += name; }; };
    io::write_files(
        std::vector<io::file_to_write>{{"/dev/null", note('d')}, {folder / "a", note('a')}, {folder / "b", note('b')}});
    CHECK(order == "abd");
}

TEST_CASE("write_files: a file that cannot get its name is named, with those that have theirs")
{
    const temporary_folder folder;
    const auto nothing = [](io::atomic_file&) {};
    const auto in_the_way = [&](io::atomic_file&) { fs::create_directory(folder / "b"); };
    const std::vector<io::file_to_write> files{{folder / "a", nothing}, {folder / "b", in_the_way}};
    const auto already = "/b: cannot write: Is a directory; already replaced: " + (folder / "a").string();
    CHECK_THROWS_WITH_AS(io::write_files(files), doctest::Contains(already.c_str()), io::io_error);
    CHECK(folder.entries() == 2);
}

TEST_CASE("write_moved: of OBJ all but coordinates stays, and what they were joined from; others become OBJ")
{
    const temporary_folder folder;
    const std::vector<vec3> points{{0.1, 2, 3}, {4, 5, 6}, {7, 8, 9e30}, {-1, 0, 0}};
    const auto moved = [&](const char* name, const std::string& text)
    {
        folder.write(folder / name, text);
        const auto file = io::read_surface_file(folder / name);
        io::atomic_file out(folder / "out.obj");
        file.write(out, points);
        out.commit();
        CHECK(io::read_surface(folder / "out.obj").points() == points);
        return folder.read(folder / "out.obj");
    };
    CHECK(moved("a.obj", "# v 1 1 1\r\nv 0 0 0 1 0.5 0\r\n\tv\t1 0 \\\n 0 # one\nvn 0 0 1\nv 1 1 0\nv 0 1 0\n"
                         "f 1//1 2//1 3//1 4//1\n# end") ==
          "# v 1 1 1\r\nv 0.1 2 3 1 0.5 0\r\n\tv 4 5 6 # one\nvn 0 0 1\nv 7 8 9e+30\nv -1 0 0\n"
          "f 1//1 2//1 3//1 4//1\n# end");
    CHECK(moved("a.off", "OFF 4 1 0\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n4 0 1 2 3\n") ==
          "v 0.1 2 3\nv 4 5 6\nv 7 8 9e+30\nv -1 0 0\nf 1 2 3 4\n");
    const auto file = io::read_surface_file(folder / "a.off");
    io::atomic_file out(folder / "out.obj");
    CHECK_THROWS_AS(file.write(out, std::vector<vec3>(3)), parameter_error);
}

TEST_CASE("read_file: what has no end is an error")
{
    CHECK_THROWS_WITH_AS(io::impl::read_file("/dev/zero", 3 << 20), doctest::Contains("more than 3 MiB"), io::io_error);
    const temporary_folder folder;
    folder.write(folder / "a", "123456789");
    CHECK(io::impl::read_file(folder / "a", 9) == "123456789");
    CHECK_THROWS_AS(io::impl::read_file(folder / "a", 8), io::io_error);
    CHECK(io::impl::most_bytes_to_read() > 1 << 20);
}
