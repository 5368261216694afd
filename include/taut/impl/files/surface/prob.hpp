// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include <taut/mesh.hpp>

namespace taut::io::impl
{

/// Untangling problem as a file states it: every index is in range, every number finite, no cell names a vertex twice.
/// It need not be feasible.
template <class Element>
struct prob_file
{
    static constexpr int D = Element::dimension;

    std::vector<vec3> rest;                          ///< rest coordinates; z = 0 where the file has two
    std::vector<typename mesh<Element>::cell> cells; ///< positive at rest
    std::vector<vec<D>> initial;                     ///< the map to start from; of fixed vertices, where they stay
    std::vector<idx> fixed;                          ///< as in the file, which may name a vertex twice
};

} // namespace taut::io::impl
