// SPDX-License-Identifier: MIT
#include <taut/impl/enter.inl>
#ifndef TAUT_QUALITY_HPP
#define TAUT_QUALITY_HPP

#include <algorithm>
#include <cstddef>
#include <limits>
#include <span>
#include <utility>
#include <vector>

#include <taut/certify.hpp>
#include <taut/energies.hpp>
#include <taut/impl/core/core/parallel.hpp>
#include <taut/impl/core/measure/distortion.hpp>
#include <taut/impl/core/mesh/ideal.hpp>
#include <taut/mesh.hpp>

/// Quality measures of maps and meshes.
namespace taut
{

/// Value of an energy for every element; +infinity beyond its barrier.
template <class Element, class Energy>
std::vector<double> distortion(const mesh<Element>& m, const impl::ideal_elements<Element>& ideal,
                               std::span<const vec<Element::dimension>> x, const Energy& energy)
{
    std::vector<double> result(m.cells().size());
    impl::parallel_for(result.size(),
                       [&](std::size_t begin, std::size_t end)
                       {
                           for (std::size_t c = begin; c < end; ++c)
                               result[c] = impl::bounded(energy, impl::mapped_element(m, ideal, x, c));
                       });
    return result;
}

/// Isometric distortion of every element: 4 (triangles) or 2 (tetrahedra) where nothing is distorted.
template <class Element>
std::vector<double> distortion(const mesh<Element>& m, std::span<const vec<Element::dimension>> x);

/// Statistics over the elements of a ratio that is 1 without distortion.
struct spread
{
    double min = std::numeric_limits<double>::infinity();
    double max = 0;
    double rms = 0; ///< sqrt(mean((ratio - 1)^2)), every element counting 1
};

/// Quality of a map: the distortion measures of the literature, and counts of flipped elements. Energies see the map as
/// it is. Stretch and area are the paper's columns (Table 3) and are taken after scaling the map to the total measure
/// of the rest mesh, the sum of unsigned mapped measures; angles do not depend on scale. Everything but the energies is
/// finite also for flipped elements (they count with |det|), as long as no element is flat.
struct quality
{
    certificate flips;           ///< exact
    impl::means isometric;       ///< |S|^2 (1 + 1/det^2), minimum 4; tetrahedra: shape * area, minimum 2
    impl::means shape;           ///< |S|^2 / (D det^(2/D)), minimum 1
    impl::means area;            ///< det + 1/det, minimum 2
    double scale = 1;            ///< factor that gives the map the rest mesh's measure
    spread stretch_l2;           ///< sqrt(|S^-1|^2 / D): how the map back to the surface stretches (Sander et al. 2001)
    spread stretch_linf;         ///< largest singular value of S^-1
    double stretch_l2_total = 0; ///< sqrt of the mean of stretch_l2^2 by rest measure: Sander's norm of the whole map
    spread area_ratio;           ///< mapped / rest measure
    double angular = 0;          ///< mean over all angles of triangles or faces of ((mapped - rest) / rest)^2
};

/// Measures a map. x: #V image points in the units of `ideal`.
template <class Element>
quality measure_quality(const mesh<Element>& m, const impl::ideal_elements<Element>& ideal,
                        std::span<const vec<Element::dimension>> x);

/// Measures a map in the units of the mesh. Throws mesh_error where a cell is flat or inverted at rest.
template <class Element>
quality measure_quality(const mesh<Element>& m, std::span<const vec<Element::dimension>> x);

/// Shape qualities of a triangle or tetrahedron, the measures of mesh generation: 1 is regular, 0 flat, less inverted.
/// Definitions as in Stimpson et al., "The Verdict library reference manual" (2007), the mean ratio as in Liu and Joe,
/// "Relationship between tetrahedron shape measures" (1994).
struct element_shape
{
    double mean_ratio = 0; ///< D = 2: 4 sqrt(3) area / sum l^2; D = 3: 12 (3 volume)^(2/3) / sum l^2, with its sign
    double scaled_jacobian = 0; ///< the smallest over the corners of det / product of the edges there, scaled to 1
    double min_angle = 0;       ///< degrees; corner angles of triangles, dihedral ones of tetrahedra, 0 to 180
    double max_angle = 0;

    /// Takes the worse value of each measure.
    void join(const element_shape& other)
    {
        mean_ratio = std::min(mean_ratio, other.mean_ratio);
        scaled_jacobian = std::min(scaled_jacobian, other.scaled_jacobian);
        min_angle = std::min(min_angle, other.min_angle);
        max_angle = std::max(max_angle, other.max_angle);
    }
};

/// Shape qualities of the elements of a mesh.
struct shape_quality
{
    element_shape worst{std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity(), 180, 0};
    double mean_ratio = 0, scaled_jacobian = 0; ///< means over the elements
    std::vector<idx> worst_ids;                 ///< up to ten with the smallest mean ratios, the worst first

    /// ids: the number of each element; empty: they count from 0
    explicit shape_quality(std::span<const element_shape> shapes = {}, std::span<const idx> ids = {})
    {
        std::vector<std::pair<double, idx>> ranked;
        for (std::size_t c = 0; c < shapes.size(); ++c)
        {
            const element_shape& s = shapes[c];
            worst.join(s);
            mean_ratio += s.mean_ratio / static_cast<double>(shapes.size());
            scaled_jacobian += s.scaled_jacobian / static_cast<double>(shapes.size());
            ranked.emplace_back(s.mean_ratio, ids.empty() ? static_cast<idx>(c) : ids[c]);
        }
        const auto shown = static_cast<std::ptrdiff_t>(std::min<std::size_t>(10, ranked.size()));
        std::partial_sort(ranked.begin(), ranked.begin() + shown, ranked.end());
        for (std::ptrdiff_t i = 0; i < shown; ++i) worst_ids.push_back(ranked[static_cast<std::size_t>(i)].second);
    }
};

/// Measures the shapes of all elements of a mesh. x: one finite position per vertex.
template <class Element>
shape_quality measure_shapes(const std::vector<typename mesh<Element>::cell>& cells,
                             std::span<const vec<Element::dimension>> x);

/// Measures cells of any kind by the simplices at their corners: the quality of a cell is that of its worst corner.
/// owners: the cell of each simplex, those of one together; one alone is the cell itself. regular: as for
/// corner_shape().
template <class Element>
shape_quality measure_shapes(const std::vector<typename mesh<Element>::cell>& simplices,
                             std::span<const vec<Element::dimension>> x, std::span<const idx> owners,
                             std::span<const mat<Element::dimension>> regular);

} // namespace taut

#include <taut/impl/core/measure/singular_values.hpp>

#endif
#include <taut/impl/leave.inl>
