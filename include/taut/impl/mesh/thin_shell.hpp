// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <initializer_list>
#include <utility>
#include <vector>

#include <taut/impl/mesh/cell_data.hpp>
#include <taut/impl/mesh/hinge.hpp>
#include <taut/impl/mesh/validate.hpp>

namespace taut::impl
{

/// Attributes of a hinge that energy::shell reads.
struct shell_attributes
{
    static constexpr std::size_t first = 0;   ///< W^-1 of triangle (0, 1, 2) in lengths of the common edge: xx, xy, yy
    static constexpr std::size_t second = 3;  ///< the same of triangle (0, 1, 3)
    static constexpr std::size_t shares = 6;  ///< in the areas of its two triangles: area / hinges, by the mean
    static constexpr std::size_t bending = 8; ///< |edge|^2 / (sum of both areas), in means of area and squared edge
    static constexpr std::size_t cosine = 9, sine = 10; ///< cosine and sine of the angle between the normals at rest
    static constexpr std::size_t count = 11;
};

} // namespace taut::impl

namespace taut
{

/// Thin shell: a surface in space that bends and stretches, as its hinges and their rest shapes. Vertices are those of
/// the surface. Sums over hinges are integrals over the surface: the area of a triangle is divided equally among its
/// hinges.
class thin_shell
{
public:
    /// surface: an oriented manifold with any number of components, holes and handles, no triangle of it flat.
    /// Throws mesh_error, also for triangles without a neighbour, which have no hinge.
    explicit thin_shell(mesh<triangle> surface)
        : surface_(checked(std::move(surface))), hinges_(surface_.points(), find_hinges())
    {
        describe_rest();
    }

    const mesh<triangle>& surface() const { return surface_; }
    const mesh<hinge>& hinges() const { return hinges_; }
    const cell_data& rest() const { return rest_; } ///< data of the hinges: shell_attributes
    double mean_edge() const { return mean_edge_; } ///< root of the mean square of the edges with two triangles

private:
    static mesh<triangle> checked(mesh<triangle> m)
    {
        validate(m,
                 {.referenced = false, .connected = false, .open = false, .one_boundary = false, .no_handles = false});
        return m;
    }

    std::vector<mesh<hinge>::cell> find_hinges()
    {
        const auto table = impl::facets(surface_);
        const auto& cells = surface_.cells();
        hinges_of_.assign(cells.size(), 0);
        std::vector<mesh<hinge>::cell> found;
        for (std::size_t side = 0; side < table.twin.size(); ++side)
        {
            if (table.twin[side] < static_cast<idx>(side)) continue; // on the boundary, or seen from the other side
            const auto twin = static_cast<std::size_t>(table.twin[side]);
            const auto edge = impl::side_vertices(surface_, static_cast<idx>(side));
            found.push_back({edge[0], edge[1], cells[side / 3][side % 3], cells[twin / 3][twin % 3]});
            triangles_.push_back({side / 3, twin / 3});
            ++hinges_of_[side / 3];
            ++hinges_of_[twin / 3];
        }
        std::vector<idx> alone;
        for (std::size_t t = 0; t < cells.size(); ++t)
            if (hinges_of_[t] == 0) alone.push_back(static_cast<idx>(t));
        if (!alone.empty())
        {
            const auto text = impl::list_ids("triangle", "triangles", alone);
            throw mesh_error(mesh_error::several_components, std::move(alone),
                             text + " without a neighbour, which cannot bend; remove isolated ones");
        }
        return found;
    }

    void describe_rest()
    {
        double area = 0, squares = 0;
        const std::size_t count = hinges_.cells().size();
        for (std::size_t c = 0; c < count; ++c)
        {
            const auto x = hinges_.rest(static_cast<idx>(c));
            for (std::size_t k = 0; k < 2; ++k) area += share(c, k);
            squares += glm::dot(x[1] - x[0], x[1] - x[0]);
        }
        const double mean_area = area / static_cast<double>(count), mean_square = squares / static_cast<double>(count);
        mean_edge_ = std::sqrt(mean_square);
        rest_.attribute_count = impl::shell_attributes::count;
        for (std::size_t c = 0; c < count; ++c)
        {
            const auto x = hinges_.rest(static_cast<idx>(c));
            const double length = glm::length(x[1] - x[0]);
            for (const std::size_t opposite : {2U, 3U})
            {
                const mat2 inverse = impl::invert_upper(triangle::ideal({x[0], x[1], x[opposite]})) * length;
                add({inverse[0][0], inverse[1][0], inverse[1][1]});
            }
            add({share(c, 0) / mean_area, share(c, 1) / mean_area});
            const vec3 e = x[1] - x[0], a = glm::cross(e, x[2] - x[0]), b = glm::cross(x[3] - x[0], e);
            const double first = glm::length(a), second = glm::length(b); // twice the areas
            add({2 * length * length / (first + second) * mean_square / mean_area});
            add({glm::dot(a, b) / (first * second), length * glm::dot(a, x[3] - x[0]) / (first * second)});
        }
    }

    void add(std::initializer_list<double> numbers)
    {
        rest_.attributes.insert(rest_.attributes.end(), numbers.begin(), numbers.end());
    }

    /// Share of a hinge in the area of its triangle k.
    double share(std::size_t c, std::size_t k) const
    {
        const auto x = surface_.rest(static_cast<idx>(triangles_[c][k]));
        return glm::length(glm::cross(x[1] - x[0], x[2] - x[0])) / 2 / hinges_of_[triangles_[c][k]];
    }

    mesh<triangle> surface_;
    std::vector<std::array<std::size_t, 2>> triangles_; ///< triangles of each hinge
    std::vector<int> hinges_of_;                        ///< number of hinges of each triangle
    mesh<hinge> hinges_;
    cell_data rest_;
    double mean_edge_ = 0;
};

} // namespace taut
