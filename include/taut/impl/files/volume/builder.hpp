// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <span>
#include <string>
#include <utility>

#include <taut/impl/files/volume/groups.hpp>
#include <taut/impl/files/volume/numbering.hpp>
#include <taut/impl/files/volume/numbers.hpp>
#include <taut/impl/files/volume/turned_cells.hpp>
#include <taut/impl/files/volume/volume_file.hpp>
#include <taut/impl/files/volume/volume_file_bodies.hpp>
#include <taut/volume_file.hpp>

namespace taut::io::impl
{

/// The other of the two orders of a wedge's corners: VTK's, and that of gmsh and MEDIT.
constexpr std::array<std::size_t, 6> turned_wedge = {0, 2, 1, 3, 5, 4};

/// Common base of the readers of volumes, which fill a volume_file.
class volume_builder
{
public:
    explicit volume_builder(volume_file& file) : file_(file), in_(file.bytes, file.path) {}

    volume_file& file() { return file_; }
    scanner& in() { return in_; }
    const scanner& in() const { return in_; }

    /// Says how coordinates stand in the file, before the first one is read.
    void set_places(number_encoding encoding, bool single, int per_point)
    {
        file_.places = {encoding.text, single, encoding.order, per_point, {}, {}};
    }

    /// Says that they stand in a code.
    void set_code(coded_coordinates coded) { file_.places.coded = std::move(coded); }

    void reserve_points(std::size_t n)
    {
        file_.points.reserve(n);
        if (file_.places.coded) return;
        file_.places.offsets.reserve(n * static_cast<std::size_t>(file_.places.per_point));
    }

    /// Reads the coordinates of the next point.
    void add_point(number_source& from)
    {
        vec3 p(0.0);
        for (int k = 0; k < file_.places.per_point; ++k)
        {
            from.skip();
            const char* const at = from.in().position();
            p[k] = from.real(file_.places.single ? number_type::float32 : number_type::float64);
            if (!std::isfinite(p[k]))
                from.fail("point " + std::to_string(file_.points.size()) +
                          " has a coordinate that is not finite; give finite numbers");
            if (!file_.places.coded) file_.places.offsets.push_back(static_cast<std::size_t>(at - file_.bytes.data()));
        }
        file_.points.push_back(p);
    }

    /// Gives the next point the number that the file has for it.
    void add_id(long long id) { numbers_.add(id); }

    /// After the last number.
    void finish_ids(const number_source& from)
    {
        if (const auto twice = numbers_.finish())
            from.fail("two points have the number " + std::to_string(*twice) + "; number each once");
    }

    /// The position of the point with this number of the file.
    idx point_of_id(long long id, const number_source& from) const
    {
        if (const auto v = numbers_.find(id)) return *v;
        from.fail("no point has the number " + std::to_string(id) + "; correct it, or add the point");
    }

    /// The position itself, counted from `first`, checked.
    idx point_at(long long i, long long first, const number_source& from) const
    {
        const auto n = static_cast<long long>(file_.points.size());
        if (i < first || i - first >= n)
            from.fail("point " + std::to_string(i) + " of " + std::to_string(n) + "; they count from " +
                      std::to_string(first));
        return static_cast<idx>(i - first);
    }

    /// Adds a cell whose corners are in VTK's order.
    void add_vtk_cell(cell_kind kind, std::span<const idx> corners)
    {
        if (file_.cells.empty() || file_.cells.back().kind != kind) file_.cells.push_back({kind, {}});
        auto& all = file_.cells.back().corners;
        all.insert(all.end(), corners.begin(), corners.end());
    }

    /// Adds a cell whose corners are in the order of gmsh and MEDIT.
    void add_cell(cell_kind kind, std::span<const idx> corners)
    {
        if (kind != cell_kind::wedge) return add_vtk_cell(kind, corners);
        std::array<idx, 6> turned{};
        for (std::size_t k = 0; k < 6; ++k) turned[k] = corners[turned_wedge[k]];
        add_vtk_cell(kind, turned);
    }

    /// Validates the file once all is read.
    void finish()
    {
        make_names_unique(file_.groups);
        bool volume = false, flat = true;
        for (const auto& block : file_.cells) volume = volume || shape_of(block.kind).dimension == 3;
        for (const vec3& p : file_.points) flat = flat && p.z == file_.points.front().z;
        if (file_.places.per_point == 2 && volume)
            throw io_error(file_.path, "volume cells, but two coordinates a point; give three");
        file_.dimension = file_.places.per_point == 2 || (!volume && flat && !file_.points.empty()) ? 2 : 3;
        if (file_.rest.empty()) turn_cells(file_, cells_to_turn(file_)); // a problem has the order that it states
    }

private:
    volume_file& file_;
    scanner in_;
    numbering numbers_;
};

} // namespace taut::io::impl
