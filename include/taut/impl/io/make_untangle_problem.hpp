// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <utility>
#include <vector>

#include <taut/impl/constrain/constraints.hpp>
#include <taut/impl/constrain/untangle_problem.hpp>
#include <taut/impl/io/pins.hpp>
#include <taut/impl/io/prob.hpp>

namespace taut
{

/// Makes the untangling problem of a mesh and a map of it, one position per vertex, under the hard pins; springs are
/// ignored. Pinned coordinates of the map are replaced by their targets.
/// Throws constraint_error (wrong_count) unless map and constraints are of this mesh.
template <class Element>
untangle_problem<Element> make_untangle_problem(mesh<Element> rest, std::vector<vec<Element::dimension>> initial,
                                                const constraints<Element>& pins)
{
    pins.impose(initial);
    return {std::move(rest), std::move(initial), pins.held()};
}

/// Makes the problem that a file states: its fixed vertices are pinned where the initial map has them.
/// Throws mesh_error where the cells make no mesh.
template <class Element>
untangle_problem<Element> make_untangle_problem(io::impl::prob_file<Element> file)
{
    impl::fixed_marks<Element::dimension> held(file.rest.size());
    for (const idx v : file.fixed) held[static_cast<std::size_t>(v)] = held.every;
    return {mesh<Element>(std::move(file.rest), std::move(file.cells)), std::move(file.initial), std::move(held)};
}

} // namespace taut
