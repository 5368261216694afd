// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>

#include <taut/errors.hpp>
#include <taut/impl/core/core/single.hpp>
#include <taut/impl/files/file/byte_order.hpp>
#include <taut/impl/files/file/write_files.hpp>
#include <taut/impl/files/volume/formats.hpp>
#include <taut/impl/files/volume/numbers.hpp>
#include <taut/impl/files/volume/write_volume.hpp>

namespace taut::io::impl
{

inline bool same_bits(double a, double b)
{
    return std::bit_cast<std::uint64_t>(a) == std::bit_cast<std::uint64_t>(b);
}

/// The coordinate as the file will hold it.
inline double stored(const coordinate_places& places, double x)
{
    return places.rounds() ? taut::impl::in_single(x) : x;
}

inline void require_storable(const volume_file& file, std::span<const vec3> points)
{
    if (points.size() != file.points.size())
        throw parameter_error("points", std::to_string(points.size()) + " for the " +
                                            std::to_string(file.points.size()) + " of the file; give one each");
    for (std::size_t v = 0; v < points.size(); ++v)
    {
        for (int k = 0; k < 3; ++k)
            if (!std::isfinite(stored(file.places, points[v][k])))
                throw parameter_error("points", "point " + std::to_string(v) +
                                                    " has a coordinate that the file cannot hold; give finite numbers");
        if (file.places.per_point == 2 && points[v].z != file.points[v].z)
            throw parameter_error("points", "point " + std::to_string(v) +
                                                " has left the plane, and the file has two coordinates a point");
    }
}

inline void append_coordinate(std::string& text, const coordinate_places& places, double x)
{
    std::array<char, 32> bytes;
    char* end = bytes.data();
    if (places.text)
        end = std::to_chars(bytes.data(), bytes.data() + bytes.size(), x).ptr;
    else if (places.single)
        store(std::exchange(end, end + sizeof(float)), static_cast<float>(x), places.order);
    else
        store(std::exchange(end, end + sizeof(double)), x, places.order);
    text.append(bytes.data(), end);
}

/// Writes the main file with other coordinates where it has them in a code: this as a whole, and where arrays follow it
/// the offsets of these. Out: with write(string_view).
template <class Out>
void replace_code(Out& out, const volume_file& file, std::span<const vec3> points)
{
    const coded_coordinates& coded = *file.places.coded;
    const std::string_view bytes = file.bytes;
    std::string numbers;
    bool changed = false;
    for (std::size_t v = 0; v < points.size(); ++v)
        for (int k = 0; k < file.places.per_point; ++k)
        {
            const double x = stored(file.places, points[v][k]);
            changed = changed || !same_bits(x, file.points[v][k]);
            append_coordinate(numbers, file.places, x);
        }
    if (!changed) return out.write(bytes);
    const std::string code = impl::coded(numbers, coded.code);
    std::size_t done = 0;
    for (const auto& later : coded.followed_by)
    {
        out.write(bytes.substr(done, later.begin - done));
        out.write(std::to_string(later.offset + code.size() - (coded.end - coded.begin)));
        done = later.end;
    }
    out.write(bytes.substr(done, coded.begin - done));
    out.write(code);
    out.write(bytes.substr(coded.end));
}

/// Writes the main file with other coordinates. Out: with write(string_view).
template <class Out>
void replace_coordinates(Out& out, const volume_file& file, std::span<const vec3> points)
{
    if (file.places.coded) return replace_code(out, file, points);
    const auto d = static_cast<std::size_t>(file.places.per_point);
    const std::string_view bytes = file.bytes;
    std::string text;
    std::size_t done = 0;
    for (std::size_t i = 0; i < file.places.offsets.size(); ++i)
    {
        const int k = static_cast<int>(i % d);
        const double x = stored(file.places, points[i / d][k]);
        if (same_bits(x, file.points[i / d][k])) continue;
        const std::size_t offset = file.places.offsets[i];
        text += bytes.substr(done, offset - done);
        append_coordinate(text, file.places, x);
        done = offset + length_at(file, offset);
        if (text.size() < 1 << 16) continue;
        out.write(text);
        text.clear();
    }
    out.write(text);
    out.write(bytes.substr(done));
}

inline void require_other(const std::filesystem::path& output, const std::filesystem::path& input)
{
    std::error_code unknown;
    if (std::filesystem::equivalent(output, input, unknown))
        throw io_error(output.string(), "is the input; give the output another name");
}

} // namespace taut::io::impl

namespace taut::io
{

std::vector<vec3> volume_file::rounded(std::span<const vec3> x) const
{
    std::vector<vec3> result(x.begin(), x.end());
    if (places.single)
        for (vec3& p : result)
            for (int k = 0; k < 3; ++k) p[k] = taut::impl::in_single(p[k]);
    return result;
}

} // namespace taut::io

namespace taut::io::impl
{

std::string with_points(const volume_file& file, std::span<const vec3> points)
{
    struct text_output
    {
        std::string text;
        void write(std::string_view part) { text += part; }
    };
    impl::require_storable(file, points);
    text_output out;
    impl::replace_coordinates(out, file, points);
    return std::move(out.text);
}

std::vector<file_to_write> volume_outputs(const std::filesystem::path& path, const volume_file& file,
                                          std::span<const vec3> points)
{
    impl::require_storable(file, points);
    const auto format = impl::volume_format_of_name(path);
    if (format != volume_format::automatic && impl::name_of(format) != file.format)
        throw io_error(path.string(), "is named as a file of " + std::string(impl::name_of(format)) +
                                          ", and the output has the format of its input, " + file.format +
                                          "; give it the same extension");
    const auto name_with = [&](std::filesystem::path name, const std::string& extension)
    { return file.companions.empty() ? name : name.replace_extension(extension); };
    std::vector<file_to_write> result;
    result.push_back({name_with(path, ".node"),
                      [&file, points](atomic_file& out) { impl::replace_coordinates(out, file, points); }});
    for (const auto& companion : file.companions)
        result.push_back(
            {name_with(path, companion.extension), [&companion](atomic_file& out) { out.write(companion.bytes); }});
    for (const auto& output : result)
    {
        impl::require_other(output.path, file.path);
        for (const auto& companion : file.companions)
            impl::require_other(output.path, name_with(file.path, companion.extension));
    }
    std::vector<std::filesystem::path> written;
    for (const auto& output : result) written.push_back(output.path);
    if (!file.companions.empty()) require_own_tetgen_files(path, written);
    return result;
}

void require_own_tetgen_files(const std::filesystem::path& output, std::span<const std::filesystem::path> written)
{
    require_own_parts(output, written, tetgen_files(output));
    const auto face = tetgen_files(output, true).back();
    std::error_code unknown;
    if (std::find(written.begin(), written.end(), face) == written.end() && std::filesystem::exists(face, unknown))
        throw io_error(output.string(), face.string() + " of another mesh would become a part of it; move it away, or "
                                                        "choose another name");
}

} // namespace taut::io::impl

namespace taut::io
{

void volume_file::write(const std::filesystem::path& to, std::span<const vec3> x) const
{
    write_files(impl::volume_outputs(to, *this, x));
}

} // namespace taut::io
