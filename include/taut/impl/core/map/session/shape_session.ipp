// SPDX-License-Identifier: MIT
#pragma once

#include <memory>

#include <taut/session.hpp>

#include <taut/impl/core/constrain/constraints.ipp>
#include <taut/impl/core/map/session/session_run.hpp>
#include <taut/impl/core/map/session/shape_setup.hpp>
#include <taut/impl/core/mesh/mesh.ipp>
#include <taut/impl/core/objective/volume_objective.hpp>
#include <taut/untangle.hpp>

namespace taut
{

// Hinges are elements of shells alone.
template class mesh<hinge>;
template class constraints<hinge>;

template <class Element>
session<Element>::session(queue& q, const mesh<Element>& m, const deform_params<Element>& params,
                          const run_limits& limits) requires std::same_as<Element, tetrahedron>
    : body_(std::make_unique<impl::session_run<Element>>(q, impl::shape_setup(m, params, limits)))
{
}

template <class Element>
template <std::same_as<deform_params<Element>> Params>
session<Element>::session(queue& q, const mesh<Element>& m, const Params& params,
                          const run_limits& limits) requires std::same_as<Element, triangle>
    : body_(std::make_unique<impl::session_run<Element>>(q, impl::shape_setup(m, params, limits)))
{
}

template <class Element>
session<Element>::session(queue& q, const thin_shell& shell, const shell_params& params,
                          const run_limits& limits) requires std::same_as<Element, hinge>
    : body_(std::make_unique<impl::session_run<Element>>(q, impl::shell_setup(shell, params, limits)))
{
}

template session<tetrahedron>::session(queue&, const mesh<tetrahedron>&, const deform_params<tetrahedron>&,
                                       const run_limits&);
template session<triangle>::session(queue&, const mesh<triangle>&, const deform_params<triangle>&, const run_limits&);
template session<hinge>::session(queue&, const thin_shell&, const shell_params&, const run_limits&);

} // namespace taut
