// SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <span>

#include <taut/impl/energy/shell.hpp>
#include <taut/impl/exact/collapses.hpp>
#include <taut/impl/map/session/shape_session.hpp>

namespace taut::impl
{

// Implementation of session.hpp; include that one.

/// Session of a thin shell: a shape of hinges, certified by the triangles of the surface. A template, so that only
/// files that make a session compile it.
template <class Element>
class shell_session final : public shape_session<Element>
{
public:
    shell_session(const queue& q, const thin_shell& shell, const shell_params& params)
        : shape_session<Element>(q, shell.hinges(), of_hinges(shell, params)), surface_(shell.surface())
    {
    }

private:
    using typename shape_session<Element>::map;

    static deform_params<Element> of_hinges(const thin_shell& shell, const shell_params& params)
    {
        params.validate();
        return {.energy = energy::shell{},
                .weights = energy::weighting::uniform,
                .data = shell.rest(),
                .parameters = {params.thickness ? *params.thickness / shell.mean_edge() : 1.0},
                .constraints = params.constraints,
                .initial = params.initial,
                .precision = params.precision,
                .solve = params.solve,
                .limits = params.limits};
    }

    certificate certified(const map& x) const override
    {
        return certify_surface(surface_.cells(), surface_.points(), x);
    }

    mesh<triangle> surface_;
};

} // namespace taut::impl

namespace taut
{

template <class Element>
session<Element>::session(queue& q, const thin_shell& shell,
                          const shell_params& params) requires std::same_as<Element, hinge>
    : body_(std::make_unique<impl::shell_session<Element>>(q, shell, params))
{
}

} // namespace taut
