// SPDX-License-Identifier: MIT
#include "shared/outputs.hpp"

#include <algorithm>
#include <string>
#include <system_error>
#include <vector>

#include <taut/files.hpp>
#include <taut/impl/files/file/atomic_file_bodies.hpp>
#include <taut/impl/files/file/write_files.hpp>
#include <taut/impl/files/volume/write_volume.hpp>

#include "shared/companions.hpp"
#include "shared/failure.hpp"
#include "shared/file_identity.hpp"
#include "shared/standard_streams.hpp"
#include "shared/tile_names.hpp"

namespace taut::tools
{

namespace
{

namespace fs = std::filesystem;

/// A file of a run and its identity.
struct known_file
{
    const run_file& file;
    file_identity identity;
};

/// Returns whether two files that are written are one: also a tile of a name with <UDIM>, there or not.
bool may_be_same_file(const known_file& a, const known_file& b)
{
    const auto is_tile = [](const known_file& tiles, const known_file& one)
    {
        return tiles.file.use->tiles && names_tiles(tiles.file.path.string()) &&
               is_tile_file(tiles.identity.spelled(), one.identity.spelled());
    };
    return a.identity == b.identity || is_tile(a, b) || is_tile(b, a);
}

[[noreturn]] void refuse(const run_file& output, const std::string& reason)
{
    const bool beside = output.path != output.given;
    throw usage_error(output.option.name() + ' ' + output.given.string() + ": " +
                      (beside ? output.path.string() + ", which is written with it, " : "") + reason);
}

/// Throws usage_error if it could not be written as things are. Returns whether it is standard output.
bool require_place(const run_file& output)
{
    std::error_code ignored;
    if (fs::is_directory(output.path, ignored))
    {
        if (output.use->may_be_folder) return false;
        refuse(output, "is a folder; name a file");
    }
    const bool slash = output.use->may_be_folder && !output.path.has_filename(); // as "folder/"
    const auto path = slash ? output.path.parent_path() : output.path;
    const auto folder = path.has_parent_path() ? path.parent_path() : fs::path(".");
    if (!fs::is_directory(folder, ignored) && io::impl::open_file_number(path) < 0)
        refuse(output, "there is no folder " + folder.string() + "; create it first");
    try
    {
        const auto target = io::impl::resolve_target(path);
        const auto& known = output.use->extensions;
        const bool named = output.path == output.given && !known.empty() && !target.stream;
        if (named && std::find(known.begin(), known.end(), extension(output.path)) == known.end())
        {
            std::string list;
            for (const auto& e : known) list += (list.empty() ? "" : " or ") + e;
            refuse(output, "the name must end in " + list);
        }
        io::impl::require_writable(path);
        return target.number == 1;
    }
    catch (const io::io_error& e)
    {
        throw usage_error(output.option.name() + ": " + e.what());
    }
}

/// Returns whether an output is to replace that input, as a whole.
bool is_in_place(const run_file& output, const run_file& input)
{
    return output.use->in_place && output.source == input.given &&
           file_identity(output.given) == file_identity(input.given) &&
           output.path != name_of_invalid(output.given.string());
}

void require_no_input(const known_file& written, const known_file& read)
{
    const run_file &output = written.file, &input = read.file;
    if (!(written.identity == read.identity) || is_in_place(output, input)) return;
    std::error_code ignored;
    if (fs::exists(input.path, ignored) && !fs::is_regular_file(input.path, ignored)) return; // a pipe can be both
    refuse(output,
           "would overwrite " + (input.path == input.given ? input.use->read_as
                                                           : input.path.string() + ", which belongs to " +
                                                                 input.use->read_as + ' ' + input.given.string()));
}

/// Throws usage_error where a file that nobody has named would be replaced.
void require_own(const run_file& output)
{
    const auto written = written_as(output.given, output.source);
    if (output.path != written.front()) return; // looked at with that
    try
    {
        if (is_tetgen(output.source))
            io::impl::require_own_tetgen_files(output.given, written);
        else
            io::impl::require_own_parts(output.given, written, companions_of(output.given));
    }
    catch (const io::io_error& e)
    {
        throw usage_error(output.option.name() + ' ' + e.what());
    }
}

} // namespace

outputs::outputs(std::span<const run_file> files)
{
    std::vector<known_file> all;
    for (const auto& file : files) all.push_back({file, file_identity(file.path)});
    std::vector<const known_file*> before;
    const run_file* standard = nullptr;
    for (const auto& one : all)
    {
        const run_file& file = one.file;
        if (file.is_read() && file.given == standard_input)
        {
            if (standard)
                throw usage_error(file.option.name() + " -: standard input is " + standard->option.name() +
                                  " already; name a file");
            standard = &file;
        }
        if (file.is_read()) continue;
        standard_output_taken_ |= require_place(file);
        std::error_code ignored;
        if (!fs::is_character_file(file.path, ignored)) // a terminal and /dev/null take anything
            for (const auto* other : before)
                if (!(file.use->tiles && other->file.option == file.option) && may_be_same_file(*other, one))
                    refuse(file, "is also the file of " + other->file.option.name() + "; name another one");
        before.push_back(&one);
        for (const auto& input : all)
            if (input.file.is_read()) require_no_input(one, input);
    }
    // What belongs to an input is told as that first.
    for (const known_file* one : before) require_own(one->file);
}

const char* outputs::place_of_report() const
{
    const char* place = standard_output_taken_ ? "/dev/stderr" : standard_output;
    try
    {
        io::impl::require_writable(place);
    }
    catch (const io::io_error& e)
    {
        throw usage_error(std::string(e.what()) + "; leave out the report with --quiet");
    }
    return place;
}

bool has_reader(const char* place_of_report)
{
    return has_reader(io::impl::resolve_target(place_of_report).number);
}

std::string extension(const fs::path& path)
{
    std::string text = path.extension().string();
    for (char& c : text) c = static_cast<char>(c >= 'A' && c <= 'Z' ? c - 'A' + 'a' : c);
    return text;
}

std::string name_of_invalid(const std::string& output)
{
    try
    {
        return io::impl::is_stream(output) ? std::string() : output + ".invalid";
    }
    catch (const io::io_error&) // a folder
    {
        return {};
    }
}

void remove_invalid(const std::string& output)
{
    std::error_code ignored;
    const fs::path path = name_of_invalid(output);
    if (fs::is_regular_file(path, ignored)) fs::remove(path, ignored);
}

} // namespace taut::tools
