// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <utility>

#include <taut/impl/core/error.hpp>

/// Files. Whatever is wrong with one, a reader throws io_error or mesh_error, both of which say where.
namespace taut::io::impl
{

/// Position in a file: a line of a text, counted from 1, or a byte of a binary file, counted from 0.
struct file_place
{
    enum unit
    {
        line,
        byte
    };
    unit counted_in;
    std::size_t number;
};

/// "mesh.obj, line 12: " or "mesh.obj: ".
inline std::string place_prefix(const std::string& path, const std::optional<file_place>& place)
{
    if (!place) return path + ": ";
    return path + (place->counted_in == file_place::line ? ", line " : ", byte ") + std::to_string(place->number) +
           ": ";
}

} // namespace taut::io::impl

namespace taut::io
{

/// Error of a file that cannot be read, parsed or written.
class io_error : public error
{
public:
    io_error(std::string path, const std::string& what, std::optional<impl::file_place> place = {})
        : error(impl::place_prefix(path, place) + what), path_(std::move(path)), place_(place)
    {
    }

    const std::string& path() const noexcept { return path_; }
    const std::optional<impl::file_place>& place() const noexcept { return place_; } ///< nothing: the file as a whole

private:
    std::string path_;
    std::optional<impl::file_place> place_;
};

} // namespace taut::io
