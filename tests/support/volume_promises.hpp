// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <bit>
#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <taut/impl/files/volume/numbers.hpp>
#include <taut/impl/files/volume/write_volume.hpp>

namespace taut::test
{

inline bool same_point(const vec3& a, const vec3& b)
{
    bool same = true;
    for (int k = 0; k < 3; ++k) same = same && std::bit_cast<std::uint64_t>(a[k]) == std::bit_cast<std::uint64_t>(b[k]);
    return same;
}

/// Bytes outside the coordinates, with a mark for each coordinate; bytes of points with `kept` for those. Of
/// coordinates in a code, and of offsets behind it, one mark each.
inline std::string outside(const io::volume_file& file, const std::vector<bool>& kept)
{
    if (const auto& coded = file.places.coded)
    {
        std::vector<std::pair<std::size_t, std::size_t>> marked = {{coded->begin, coded->end}};
        for (const auto& later : coded->followed_by) marked.push_back({later.begin, later.end});
        std::sort(marked.begin(), marked.end());
        std::string result;
        std::size_t done = 0;
        for (const auto& [begin, end] : marked)
        {
            result += file.bytes.substr(done, begin - done) + '@';
            done = end;
        }
        return result + file.bytes.substr(done);
    }
    const auto d = static_cast<std::size_t>(file.places.per_point);
    std::string result;
    std::size_t done = 0;
    for (std::size_t i = 0; i < file.places.offsets.size(); ++i)
    {
        const std::size_t begin = file.places.offsets[i];
        const std::size_t end = begin + io::impl::length_at(file, begin);
        result += file.bytes.substr(done, begin - done);
        result += kept[i / d] ? file.bytes.substr(begin, end - begin) : "@";
        done = end;
    }
    return result + file.bytes.substr(done);
}

/// The cells in the order that the file has: which of them are turned while reading, the points say.
inline std::vector<io::cell_block> cells_in_file(const io::volume_file& file)
{
    auto copy = file;
    io::impl::turn_cells(copy, file.turned);
    return copy.cells;
}

/// What does not hold of a file that was read: empty, or a sentence. Every second point is moved, the file written and
/// read again: the points are those, all else is the same, bytes outside the coordinates and of points that stayed.
inline std::string broken_promise(const io::volume_file& file,
                                  const std::function<io::volume_file(const std::string&)>& read)
{
    const std::size_t n = file.points.size();
    for (const auto& block : file.cells)
        for (const idx v : block.corners)
            if (v < 0 || static_cast<std::size_t>(v) >= n) return "corners in range";
    for (const auto& group : file.groups)
        if (!std::is_sorted(group.vertices.begin(), group.vertices.end(), std::less_equal<>()) ||
            (!group.vertices.empty() && (group.vertices.front() < 0 || group.vertices.back() >= static_cast<idx>(n))))
            return "vertices of groups ascending and in range";
    if (io::impl::with_points(file, file.points) != file.bytes) return "the same points make the same bytes";

    auto points = file.points;
    std::vector<bool> kept(n, true);
    for (std::size_t v = 0; v < n; v += 2)
    {
        kept[v] = false;
        for (int k = 0; k < file.places.per_point; ++k) points[v][k] = 0.1 * static_cast<double>(v) + 1. / 3 + k;
    }
    if (!file.places.text) points = file.rounded(points);
    const auto back = read(io::impl::with_points(file, points));
    if (!std::equal(points.begin(), points.end(), back.points.begin(), back.points.end(), same_point))
        return "the points that were written";
    if (back.cells.size() != file.cells.size() || back.groups.size() != file.groups.size()) return "blocks and groups";
    const auto before = cells_in_file(file), after = cells_in_file(back);
    for (std::size_t b = 0; b < before.size(); ++b)
        if (after[b].kind != before[b].kind || after[b].corners != before[b].corners) return "the same cells";
    for (std::size_t g = 0; g < file.groups.size(); ++g)
        if (back.groups[g].name != file.groups[g].name || back.groups[g].vertices != file.groups[g].vertices)
            return "the same groups";
    return outside(back, kept) == outside(file, kept) ? "" : "bytes outside the coordinates stay";
}

} // namespace taut::test
