// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdlib>
#include <fstream>
#include <functional>
#include <random>
#include <sstream>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

#include <taut/impl/core/compute/program/private_folder.hpp>
#include <taut/impl/core/compute/program/program_store.hpp>
#include <taut/impl/core/compute/quirks.hpp>
#include <taut/version.hpp>

namespace taut::impl
{

/// By which a file of programs is known among others, finished or not.
inline constexpr std::string_view program_suffix = ".taut-program";

/// Returns whether a file is an entry: a folder, a link or what waits for somebody else, as a pipe, is none.
inline bool is_program_file(const std::filesystem::path& file)
{
    std::error_code unknown;
    return file.native().size() > program_suffix.size() && file.extension() == program_suffix &&
           std::filesystem::is_regular_file(std::filesystem::symlink_status(file, unknown));
}

/// The content of an entry; empty where it cannot be read, or is longer than that.
inline std::string text_of_program_file(const std::filesystem::path& file, std::uintmax_t most)
{
    std::error_code failure;
    if (!is_program_file(file)) return {};
    const auto size = std::filesystem::file_size(file, failure);
    if (failure || size > most) return {};
    std::string text(static_cast<std::size_t>(size), '\0');
    std::ifstream in(file, std::ios::binary); // read() sets a flag where an iterator throws
    return in.read(text.data(), static_cast<std::streamsize>(size)) ? text : std::string();
}

/// A line before key and bytes, by which a file that is not whole is known.
inline std::string seal_of(const std::string& key, const std::string& bytes)
{
    return "taut program " + std::to_string(key.size()) + ' ' + std::to_string(bytes.size()) + ' ' +
           std::to_string(std::hash<std::string>()(key + bytes)) + '\n';
}

/// What drivers compile for where the device is this machine's processor, whose name says too little, in a home of
/// several machines: its instructions, on Linux.
inline std::string instructions_of_processor()
{
    std::ifstream in("/proc/cpuinfo");
    for (std::string line; std::getline(in, line) && !line.empty();)
        if (line.starts_with("flags") || line.starts_with("Features")) return line;
    return {};
}

std::string key_of(const device& device, const std::string& source, const std::string& options)
{
    return TAUT_VERSION_STRING "\n" + device.platform() + '\n' + device.label() + '\n' +
           (device.is_cpu() ? instructions_of_processor() : "") + '\n' + options + '\n' + source;
}

inline std::filesystem::path user_programs()
{
    const auto variable = [](const char* name) -> std::string
    {
        const char* value = std::getenv(name);
        return value ? value : "";
    };
    if (const auto named = variable("TAUT_CACHE_DIR"); !named.empty())
        return named == "0" ? std::filesystem::path() : std::filesystem::path(named) / "taut-programs";
    for (const char* caches : {"XDG_CACHE_HOME", "LOCALAPPDATA"})
        if (const auto folder = variable(caches); !folder.empty())
            return std::filesystem::path(folder) / "taut" / "programs";
    const auto home = variable("HOME");
    return home.empty() ? std::filesystem::path() : std::filesystem::path(home) / ".cache" / "taut" / "programs";
}

program_store::program_store(std::filesystem::path folder, std::uintmax_t limit)
    : folder_(std::move(folder)), limit_(limit)
{
    if (!folder_.empty() && !fault_of_made_folder(folder_).empty()) folder_.clear();
}

program_store program_store::of(const device& device)
{
    return program_store(quirks::keeps_no_programs(device) ? user_programs() : std::filesystem::path());
}

std::filesystem::path program_store::file_of(const std::string& key) const
{
    std::ostringstream name;
    name << std::hex << std::hash<std::string>()(key) << program_suffix;
    return folder_ / name.str();
}

std::string program_store::find(const std::string& key) const
{
    if (folder_.empty()) return {};
    const auto file = file_of(key);
    const std::string text = text_of_program_file(file, limit_);
    const std::size_t line = text.find('\n') + 1;
    if (text.compare(line, key.size(), key) != 0) return {};
    std::string bytes = text.substr(line + key.size());
    if (bytes.empty() || text.compare(0, line, seal_of(key, bytes)) != 0) return {};
    std::error_code failure;
    std::filesystem::last_write_time(file, std::filesystem::file_time_type::clock::now(), failure);
    return bytes;
}

void program_store::keep(const std::string& key, const std::string& bytes) const
{
    if (folder_.empty() || bytes.empty()) return;
    const auto file = file_of(key);
    auto partial = file; // an entry as well, so that what a process that was killed leaves is cleaned away
    partial.replace_extension('.' + std::to_string(std::random_device()()) + std::string(program_suffix));
    std::ofstream out(partial, std::ios::binary);
    out << seal_of(key, bytes) << key << bytes;
    out.close();
    std::error_code failure;
    if (out) std::filesystem::rename(partial, file, failure);
    if (!out || failure) std::filesystem::remove(partial, failure);
    clean();
}

void program_store::clean() const
{
    struct kept
    {
        std::filesystem::file_time_type used;
        std::uintmax_t size;
        std::filesystem::path file;
    };
    std::vector<kept> all;
    std::uintmax_t total = 0;
    std::error_code failure;
    for (std::filesystem::directory_iterator at(folder_, failure), end; !failure && at != end; at.increment(failure))
    {
        if (!is_program_file(at->path())) continue;
        std::error_code gone; // by another process
        const kept one{at->last_write_time(gone), at->file_size(gone), at->path()};
        if (gone) continue;
        total += one.size;
        all.push_back(one);
    }
    if (total <= limit_) return;
    std::sort(all.begin(), all.end(), [](const kept& a, const kept& b) { return a.used < b.used; });
    for (auto oldest = all.begin(); total > limit_ / 2; ++oldest)
    {
        std::filesystem::remove(oldest->file, failure);
        total -= oldest->size;
    }
}

/// As Boost.Compute builds and creates programs, but for one of the context's devices alone.
inline void build_for(const boost::compute::program& program, const device& device, const std::string& options)
{
    const cl_device_id id = device.native();
    const cl_int code = opencl_library::get().clBuildProgram(program.get(), 1, &id, options.c_str(), nullptr, nullptr);
    if (code != CL_SUCCESS) throw boost::compute::opencl_error(code);
}

/// False for what the driver takes no more.
inline bool build_of_bytes(boost::compute::program& made, const boost::compute::context& context, const device& device,
                           const std::string& bytes, const std::string& options)
{
    const auto* first = reinterpret_cast<const unsigned char*>(bytes.data());
    const std::size_t size = bytes.size();
    const cl_device_id id = device.native();
    cl_int code = CL_SUCCESS, status = CL_SUCCESS;
    made = boost::compute::program(
        opencl_library::get().clCreateProgramWithBinary(context, 1, &id, &size, &first, &status, &code), false);
    if (code != CL_SUCCESS || status != CL_SUCCESS) return false;
    try
    {
        build_for(made, device, options);
        return true;
    }
    catch (const boost::compute::opencl_error&)
    {
        return false;
    }
}

/// Empty where the driver gives none.
inline std::string bytes_of(const boost::compute::program& built)
try
{
    if (built.get_info<std::size_t>(CL_PROGRAM_BINARY_SIZES) == 0) return {};
    const auto bytes = built.binary();
    return {bytes.begin(), bytes.end()};
}
catch (const boost::compute::opencl_error&)
{
    return {};
}

void program_store::build(boost::compute::program& made, const boost::compute::context& context, const device& device,
                          const std::string& source, const std::string& options) const
{
    const std::string key = folder_.empty() ? "" : key_of(device, source, options);
    const std::string known = find(key);
    if (!known.empty() && build_of_bytes(made, context, device, known, options)) return;
    made = boost::compute::program::create_with_source(source, context);
    build_for(made, device, options);
    if (!folder_.empty()) keep(key, bytes_of(made));
}

} // namespace taut::impl
