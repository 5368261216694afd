// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <functional>
#include <span>
#include <utility>
#include <vector>

#include <taut/impl/core/hierarchy/prolongation.hpp>
#include <taut/impl/core/hierarchy/removals.hpp>

namespace taut::impl
{

/// Parameters of a hierarchy.
struct hierarchy_params
{
    double factor = 8;     ///< vertices of a level / vertices of the next coarser one; 2 to 64
    idx min_vertices = 50; ///< of the coarsest level, about; at least 3
    unsigned threads = 0;  ///< at most so many; 0: as many as the machine runs at once. The result does not change

    /// Callback between rounds of coarsening; once it returns false, no further level is made.
    std::function<bool()> proceed = {};

    /// Throws parameter_error with the name of a field outside its domain.
    void validate() const
    {
        if (!(factor >= 2 && factor <= 64)) throw parameter_error("factor", "must be 2 to 64");
        if (min_vertices < 3) throw parameter_error("min_vertices", "must be at least 3");
    }
};

/// Hierarchy of coarser meshes on subsets of the vertices, with prolongations, for multigrid and coarse-to-fine
/// methods. It holds connectivity and weights, no positions, so it serves any energy, any pins that were kept, and
/// other frames of the same mesh. make_hierarchy() is overloaded by element.
template <class Element>
struct hierarchy
{
    struct level
    {
        std::vector<idx> vertices;                       ///< numbers in the mesh, ascending
        std::vector<typename mesh<Element>::cell> cells; ///< oriented like the mesh; numbers in `vertices`; of volumes
                                                         ///< on the finest level only
    };
    /// Transfer between a level and the next coarser one.
    struct step
    {
        prolongation<static_cast<std::size_t>(Element::corners)> interpolation; ///< from the coarser to the finer level
        removals<Element> removed;                                              ///< how the finer level was thinned
    };

    std::vector<level> levels; ///< finest first; level 0 is the mesh itself
    std::vector<step> steps;   ///< steps[l] is between levels l and l + 1
};

/// A level as a mesh of its own. points: rest positions of the vertices of the finest level, in this or another frame.
template <class Element>
mesh<Element> level_mesh(const hierarchy<Element>& h, std::size_t level, std::span<const vec3> points)
{
    std::vector<vec3> chosen;
    for (const idx v : h.levels[level].vertices) chosen.push_back(points[static_cast<std::size_t>(v)]);
    return {std::move(chosen), h.levels[level].cells};
}

} // namespace taut::impl
