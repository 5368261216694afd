// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <set>
#include <span>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include <taut/impl/dist/ranges/foam_text.hpp>
#include <taut/volume_file.hpp>

namespace taut::dist::impl
{

/// Reads a folder polyMesh of OpenFOAM: points, faces by their corners, and the cells on both sides of each, whose
/// normal points out of its owner; faces of the boundary last, by patches. Cells are recognised by their faces.
class foam_mesh
{
public:
    /// Throws io_error, also for cells that are neither tetrahedra, pyramids, wedges nor hexahedra.
    explicit foam_mesh(std::filesystem::path folder) : folder_(std::move(folder))
    {
        read_points();
        read_faces();
        read_sides();
        make_cells();
        read_patches();
        for (const auto kind : {zone::cells, zone::faces, zone::points}) read_zones(kind);
    }

    /// Points, cells, and patches and zones as groups; `bytes` are those of `points`.
    io::volume_file take() { return std::move(file_); }

    /// Numbers of the points in the mesh before it was decomposed; empty: they are not there.
    static std::vector<std::int64_t> original_points(const std::filesystem::path& folder, std::size_t points)
    {
        std::error_code unknown;
        const auto path = folder / "pointProcAddressing";
        if (!std::filesystem::exists(path, unknown) && !std::filesystem::exists(path.string() + ".gz", unknown))
            return {};
        foam_text text(path);
        auto numbers = text.labels();
        if (numbers.size() != points)
            text.fail(std::to_string(numbers.size()) + " numbers for " + std::to_string(points) +
                      " points; decompose the mesh again");
        return numbers;
    }

private:
    struct side
    {
        std::int64_t face;
        bool outward; ///< the normal of the face points out of the cell
    };

    void read_points()
    {
        foam_text text(folder_ / "points");
        const bool binary = text.binary();
        const std::size_t each = text.scalar_bytes(), n = text.count(binary ? 3 * each : 7);
        file_.path = text.path();
        file_.format = "OpenFOAM";
        file_.places = {!binary, binary && text.single(), text.order(), 3, {}, {}};
        auto& at = file_.places.offsets;
        at.reserve(3 * n);
        file_.points.resize(n);
        const std::size_t begin = binary ? text.raw(n, 3 * each) : 0;
        if (!binary) text.expect('(');
        for (std::size_t v = 0; v < n; ++v)
        {
            if (!binary) text.expect('(');
            for (std::size_t k = 0; k < 3; ++k)
            {
                text.skip();
                at.push_back(binary ? begin + (3 * v + k) * each : text.position());
                const char* const from = text.bytes().data() + at.back();
                double& x = file_.points[v][static_cast<int>(k)];
                x = !binary     ? text.number<double>("a number")
                    : each == 4 ? static_cast<double>(io::impl::load<float>(from, text.order()))
                                : io::impl::load<double>(from, text.order());
                if (!std::isfinite(x)) text.fail("point " + std::to_string(v) + " is not finite; give finite numbers");
            }
            if (!binary) text.expect(')');
        }
        if (!binary) text.expect(')');
        file_.bytes = text.bytes();
    }

    void read_faces()
    {
        foam_text text(folder_ / "faces");
        starts_.push_back(0);
        if (text.type() == "faceCompactList")
        {
            starts_ = text.labels();
            corners_ = text.labels();
            if (starts_.empty()) starts_.push_back(0);
            if (starts_.front() != 0 || !std::is_sorted(starts_.begin(), starts_.end()) ||
                starts_.back() != static_cast<std::int64_t>(corners_.size()))
                text.fail("places of faces do not ascend to the number of their corners; save the mesh again");
        }
        else
        {
            if (text.binary())
                text.fail("faces in binary of class '" + text.type() +
                          "', not faceCompactList; write the mesh in ascii (foamFormatConvert)");
            const std::size_t n = text.count(4);
            text.expect('(');
            for (std::size_t f = 0; f < n; ++f)
            {
                const auto face = text.labels();
                corners_.insert(corners_.end(), face.begin(), face.end());
                starts_.push_back(static_cast<std::int64_t>(corners_.size()));
            }
            text.expect(')');
        }
        for (const std::int64_t v : corners_)
            if (v < 0 || static_cast<std::size_t>(v) >= file_.points.size())
                text.fail("a face names point " + std::to_string(v) + " of " + std::to_string(file_.points.size()) +
                          "; save the mesh again");
    }

    std::size_t faces() const { return starts_.size() - 1; }
    std::span<const std::int64_t> face(std::int64_t f) const
    {
        const auto begin = static_cast<std::size_t>(starts_[static_cast<std::size_t>(f)]);
        return std::span(corners_).subspan(begin,
                                           static_cast<std::size_t>(starts_[static_cast<std::size_t>(f) + 1]) - begin);
    }

    void read_sides()
    {
        for (const char* name : {"owner", "neighbour"})
        {
            foam_text text(folder_ / name);
            const auto of_faces = text.labels();
            const bool owner = name[0] == 'o';
            if (owner ? of_faces.size() != faces() : of_faces.size() > faces())
                text.fail(std::to_string(of_faces.size()) + " cells for " + std::to_string(faces()) +
                          " faces; save the mesh again");
            for (std::size_t f = 0; f < of_faces.size(); ++f)
            {
                const std::int64_t c = of_faces[f];
                if (c < (owner ? 0 : -1) || c >= static_cast<std::int64_t>(2 * faces()))
                    text.fail("face " + std::to_string(f) + " is of cell " + std::to_string(c) +
                              ", which is not there; save the mesh again");
                if (c < 0) continue; // of the boundary
                if (sides_.size() <= static_cast<std::size_t>(c)) sides_.resize(static_cast<std::size_t>(c) + 1);
                sides_[static_cast<std::size_t>(c)].push_back({static_cast<std::int64_t>(f), owner});
            }
        }
    }

    std::vector<std::int64_t> outward(const side& s) const
    {
        const auto corners = face(s.face);
        std::vector<std::int64_t> around(corners.begin(), corners.end());
        if (!s.outward) std::reverse(around.begin(), around.end());
        return around;
    }

    [[noreturn]] void refuse(std::size_t cell, const std::string& what) const
    {
        throw io::io_error(folder_.string(),
                           "cell " + std::to_string(cell) + what +
                               "; taut takes tetrahedra, pyramids, prisms and hexahedra, so split polyhedra into "
                               "such, or mesh without them");
    }

    void make_cells()
    {
        for (std::size_t c = 0; c < sides_.size(); ++c)
        {
            const auto [kind, corners] = cell_of(c);
            if (file_.cells.empty() || file_.cells.back().kind != kind) file_.cells.push_back({kind, {}});
            for (const std::int64_t v : corners) file_.cells.back().corners.push_back(static_cast<idx>(v));
        }
    }

    std::pair<io::cell_kind, std::vector<std::int64_t>> cell_of(std::size_t c) const
    {
        const auto& sides = sides_[c];
        std::size_t triangles = 0, quads = 0, base = 0;
        for (std::size_t s = 0; s < sides.size(); ++s)
        {
            const auto n = face(sides[s].face).size();
            triangles += n == 3;
            quads += n == 4;
        }
        const auto kind = triangles == 4 && quads == 0   ? io::cell_kind::tetrahedron
                          : triangles == 4 && quads == 1 ? io::cell_kind::pyramid
                          : triangles == 2 && quads == 3 ? io::cell_kind::wedge
                                                         : io::cell_kind::hexahedron;
        if (triangles + quads != sides.size() || (kind == io::cell_kind::hexahedron && (triangles != 0 || quads != 6)))
            refuse(c, " has " + std::to_string(sides.size()) + " faces, which make none of the known kinds");
        const std::size_t around = kind == io::cell_kind::pyramid || kind == io::cell_kind::hexahedron ? 4 : 3;
        while (face(sides[base].face).size() != around) ++base;
        auto floor = outward(sides[base]);
        std::vector<std::int64_t> top(around, -1);
        std::set<std::int64_t> all;
        for (std::size_t s = 0; s < sides.size(); ++s)
        {
            const auto corners = face(sides[s].face);
            all.insert(corners.begin(), corners.end());
            if (s == base) continue;
            for (std::size_t k = 0; k < corners.size(); ++k)
                for (const std::size_t j : {k + 1, k + corners.size() - 1})
                {
                    const auto below = std::find(floor.begin(), floor.end(), corners[k]);
                    const std::int64_t v = corners[j % corners.size()];
                    if (below == floor.end() || std::find(floor.begin(), floor.end(), v) != floor.end()) continue;
                    auto& above = top[static_cast<std::size_t>(below - floor.begin())];
                    if (above >= 0 && above != v) refuse(c, " has faces that do not fit");
                    above = v;
                }
        }
        const bool pointed = kind == io::cell_kind::tetrahedron || kind == io::cell_kind::pyramid;
        if (all.size() != static_cast<std::size_t>(io::impl::shape_of(kind).corners) || all.count(-1) != 0 ||
            std::find(top.begin(), top.end(), -1) != top.end())
            refuse(c, " has faces that do not fit");
        if (kind != io::cell_kind::wedge) // VTK's base is seen from inside
        {
            std::reverse(floor.begin() + 1, floor.end());
            std::reverse(top.begin() + 1, top.end());
        }
        if (pointed) top.resize(1);
        floor.insert(floor.end(), top.begin(), top.end());
        if (std::set<std::int64_t>(floor.begin(), floor.end()).size() != floor.size())
            refuse(c, " has faces that do not fit");
        return {kind, std::move(floor)};
    }

    /// Patches are groups, but for those between pieces.
    void read_patches()
    {
        foam_text text(folder_ / "boundary");
        text.count(1);
        text.expect('(');
        std::int64_t listed = 0; // patches have no faces in common
        while (!text.take(')'))
        {
            const std::string name = text.word();
            std::string type;
            std::int64_t first = -1, count = 0;
            text.expect('{');
            for (int depth = 1; depth > 0;)
            {
                const std::string key = text.word();
                depth += key == "{" ? 1 : key == "}" ? -1 : 0;
                if (depth == 1 && key == "type") type = text.word();
                if (depth == 1 && key == "nFaces") count = text.number<std::int64_t>("the number of faces");
                if (depth == 1 && key == "startFace") first = text.number<std::int64_t>("the number of a face");
            }
            const auto n = static_cast<std::int64_t>(faces());
            if (count < 0 || count > n || (count > 0 && (first < 0 || first > n - count)) || (listed += count) > n)
                text.fail("patch " + name + " has faces that are not there; save the mesh again");
            if (type.starts_with("processor")) continue;
            std::set<idx> vertices;
            for (std::int64_t f = first; f < first + count; ++f)
                for (const std::int64_t v : face(f)) vertices.insert(static_cast<idx>(v));
            file_.groups.push_back({name, 2, {vertices.begin(), vertices.end()}});
        }
    }

    enum class zone
    {
        cells,
        faces,
        points
    };

    /// Zones are groups of the points of their items: cellZone:NAME, faceZone:NAME, pointZone:NAME.
    void read_zones(zone kind)
    {
        static constexpr std::array<const char*, 3> items = {"cell", "face", "point"};
        const std::string item = items[static_cast<std::size_t>(kind)];
        const auto path = folder_ / (item + "Zones");
        std::error_code unknown;
        if (!std::filesystem::exists(path, unknown) && !std::filesystem::exists(path.string() + ".gz", unknown)) return;
        foam_text text(path);
        text.count(1);
        text.expect('(');
        while (!text.take(')'))
        {
            const std::string name = item + "Zone:" + text.word();
            std::vector<std::int64_t> labels;
            text.expect('{');
            while (!text.take('}'))
            {
                const std::string key = text.word();
                if (key == item + "Labels")
                    labels = text.list_of_labels();
                else if (key == "flipMap")
                    text.skip_flags();
                else
                    while (!text.take(';')) text.word();
            }
            file_.groups.push_back({name,
                                    kind == zone::cells   ? 3
                                    : kind == zone::faces ? 2
                                                          : 0,
                                    points_of(kind, labels, text)});
        }
    }

    std::vector<idx> points_of(zone kind, const std::vector<std::int64_t>& labels, const foam_text& text) const
    {
        const std::size_t n = kind == zone::cells ? sides_.size() : kind == zone::faces ? faces() : file_.points.size();
        std::set<idx> points;
        for (const std::int64_t item : std::set<std::int64_t>(labels.begin(), labels.end()))
        {
            if (item < 0 || static_cast<std::size_t>(item) >= n)
                text.fail("a zone names item " + std::to_string(item) + " of " + std::to_string(n) +
                          "; save the mesh again");
            if (kind == zone::points) points.insert(static_cast<idx>(item));
            if (kind == zone::faces)
                for (const std::int64_t v : face(item)) points.insert(static_cast<idx>(v));
            if (kind == zone::cells)
                for (const side& s : sides_[static_cast<std::size_t>(item)])
                    for (const std::int64_t v : face(s.face)) points.insert(static_cast<idx>(v));
        }
        return {points.begin(), points.end()};
    }

    std::filesystem::path folder_;
    io::volume_file file_;
    std::vector<std::int64_t> starts_, corners_; ///< of faces
    std::vector<std::vector<side>> sides_;       ///< of cells
};

} // namespace taut::dist::impl
