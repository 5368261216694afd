// SPDX-License-Identifier: MIT
#pragma once

#include <concepts>

#include <taut/deform.hpp>
#include <taut/impl/core/map/deform.hpp>
#include <taut/session.hpp>

namespace taut
{

template <class Element>
session_result<Element> deform(queue& q, const mesh<Element>& m, const deform_params<Element>& params,
                               const run_limits& limits)
{
    return impl::settled(session<Element>(q, m, params, limits), m, params.initial);
}

template session_result<triangle> deform<triangle>(queue& q, const mesh<triangle>& m,
                                                   const deform_params<triangle>& params, const run_limits& limits);

template session_result<tetrahedron> deform<tetrahedron>(queue& q, const mesh<tetrahedron>& m,
                                                         const deform_params<tetrahedron>& params,
                                                         const run_limits& limits);

template <std::same_as<thin_shell> Shell>
session_result<hinge> deform(queue& q, const Shell& shell, const shell_params& params, const run_limits& limits)
{
    return impl::settled(session<hinge>(q, shell, params, limits), shell.hinges(), params.initial);
}

template session_result<hinge> deform(queue& q, const thin_shell& shell, const shell_params& params,
                                      const run_limits& limits);

} // namespace taut
