// SPDX-License-Identifier: MIT
#include "shared/outputs.hpp"

#include <algorithm>
#include <string>
#include <system_error>
#include <vector>

#include <poll.h>
#include <unistd.h>

#include <taut/impl/io/atomic_file.hpp>

#include "shared/companions.hpp"
#include "shared/failure.hpp"
#include "shared/tile_names.hpp"

namespace taut::tools
{

namespace
{

namespace fs = std::filesystem;

/// One spelling for each file, whether it exists or not.
fs::path spelled_out(const fs::path& path)
{
    std::error_code ignored;
    auto full = fs::weakly_canonical(fs::absolute(path, ignored), ignored);
    return full.empty() ? path : full;
}

/// Also by links, hard and symbolic.
bool same_file(const fs::path& a, const fs::path& b)
{
    std::error_code ignored;
    return fs::equivalent(a, b, ignored) || spelled_out(a) == spelled_out(b);
}

/// Returns whether two files that are written are one: also a tile of a name with <UDIM>, there or not.
bool may_be_same_file(const run_file& a, const run_file& b)
{
    const auto is_tile = [](const run_file& tiles, const run_file& file)
    {
        return tiles.use->tiles && names_tiles(tiles.path.string()) &&
               is_tile_file(spelled_out(tiles.path).string(), spelled_out(file.path).string());
    };
    return same_file(a.path, b.path) || is_tile(a, b) || is_tile(b, a);
}

/// As the user knows an option.
std::string name_of(const CLI::Option& option)
{
    return option.get_snames().empty() ? option.get_name() : '-' + option.get_snames().front();
}

[[noreturn]] void refuse(const run_file& output, const std::string& reason)
{
    const bool beside = output.path != output.given;
    throw usage_error(name_of(*output.option) + ' ' + output.given.string() + ": " +
                      (beside ? output.path.string() + ", which is written with it, " : "") + reason);
}

/// Throws usage_error if it could not be written as things are. Returns whether it is standard output.
bool require_place(const run_file& output)
{
    std::error_code ignored;
    if (fs::is_directory(output.path, ignored)) refuse(output, "is a folder; name a file");
    const auto folder = output.path.has_parent_path() ? output.path.parent_path() : fs::path(".");
    if (!fs::is_directory(folder, ignored))
        refuse(output, "there is no folder " + folder.string() + "; create it first");
    try
    {
        const auto target = io::impl::resolve_target(output.path);
        const auto& known = output.use->extensions;
        const bool named = output.path == output.given && !known.empty() && !target.stream;
        if (named && std::find(known.begin(), known.end(), extension(output.path)) == known.end())
        {
            std::string list;
            for (const auto& e : known) list += (list.empty() ? "" : " or ") + e;
            refuse(output, "the name must end in " + list);
        }
        io::impl::require_writable(output.path);
        return target.number == STDOUT_FILENO;
    }
    catch (const io::io_error& e)
    {
        throw usage_error(name_of(*output.option) + ": " + e.what());
    }
}

/// Returns whether an output is to replace that input, as a whole.
bool is_in_place(const run_file& output, const run_file& input)
{
    return output.use->in_place && output.source == input.given && same_file(output.given, input.given) &&
           output.path != name_of_invalid(output.given);
}

void require_no_input(const run_file& output, const run_file& input)
{
    std::error_code ignored;
    if (fs::exists(input.path, ignored) && !fs::is_regular_file(input.path, ignored)) return; // a pipe can be both
    if (!same_file(output.path, input.path) || is_in_place(output, input)) return;
    refuse(output,
           "would overwrite " + (input.path == input.given ? input.use->read_as
                                                           : input.path.string() + ", which belongs to " +
                                                                 input.use->read_as + ' ' + input.given.string()));
}

/// A file beside an output that nobody has named is that of the output that is there, or somebody else's.
void require_own(const run_file& output)
{
    if (const auto stray = stray_companion(output.given, output.source); !stray.empty())
        throw usage_error(name_of(*output.option) + ' ' + output.given.string() + ": " + stray.string() +
                          " of another mesh would become a part of it; move it away, or choose another name");
    std::error_code ignored;
    if (output.path == output.given || output.path == name_of_invalid(output.given) ||
        !fs::exists(output.path, ignored))
        return;
    const auto own = fs::exists(output.given, ignored) ? companions_of(output.given) : std::vector<fs::path>();
    const auto is_it = [&](const fs::path& one) { return same_file(one, output.path); };
    if (std::none_of(own.begin(), own.end(), is_it))
        refuse(output, "is there already and no part of it; move it away, or choose another name");
}

} // namespace

outputs::outputs(std::span<const run_file> files)
{
    std::vector<const run_file*> before;
    const run_file* standard = nullptr;
    for (const auto& file : files)
    {
        if (file.is_read() && file.given == standard_input)
        {
            if (standard)
                throw usage_error(name_of(*file.option) + " -: standard input is " + name_of(*standard->option) +
                                  " already; name a file");
            standard = &file;
        }
        if (file.is_read()) continue;
        standard_output_taken_ |= require_place(file);
        std::error_code ignored;
        if (!fs::is_character_file(file.path, ignored)) // a terminal and /dev/null take anything
            for (const auto* other : before)
                if (!(file.use->tiles && other->option == file.option) && may_be_same_file(*other, file))
                    refuse(file, "is also the file of " + name_of(*other->option) + "; name another one");
        before.push_back(&file);
        for (const auto& input : files)
            if (input.is_read()) require_no_input(file, input);
        require_own(file);
    }
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
    pollfd stream = {io::impl::resolve_target(place_of_report).number, POLLOUT, 0};
    return ::poll(&stream, 1, 0) < 1 || (stream.revents & (POLLERR | POLLHUP)) == 0;
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
