// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <utility>

#include <taut/surface_file.hpp>
#include <taut/untangle_problem.hpp>
#include <taut/volume_file.hpp>

namespace taut
{

template <class Element>
untangle_problem<Element> make_untangle_problem(io::impl::prob_file<Element> file)
{
    impl::fixed_marks<Element::dimension> held(file.rest.size());
    for (const idx v : file.fixed) held[static_cast<std::size_t>(v)] = held.every;
    return {mesh<Element>(std::move(file.rest), std::move(file.cells)), std::move(file.initial), std::move(held)};
}

template untangle_problem<triangle> make_untangle_problem<triangle>(io::impl::prob_file<triangle> file);

template untangle_problem<tetrahedron> make_untangle_problem<tetrahedron>(io::impl::prob_file<tetrahedron> file);

} // namespace taut
