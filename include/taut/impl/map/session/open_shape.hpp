// SPDX-License-Identifier: MIT
#pragma once

#include <concepts>
#include <memory>

#include <taut/impl/map/session/shape_session.hpp>

namespace taut
{

// What session.hpp declares of shapes; include that one.

template <class Element>
session<Element>::session(queue& q, const mesh<Element>& m,
                          const deform_params<Element>& params) requires std::same_as<Element, tetrahedron>
    : body_(std::make_unique<impl::shape_session<Element>>(q, m, params))
{
}

template <class Element>
template <std::same_as<deform_params<Element>> Params>
session<Element>::session(queue& q, const mesh<Element>& m,
                          const Params& params) requires std::same_as<Element, triangle>
    : body_(std::make_unique<impl::shape_session<Element>>(q, m, params))
{
}

} // namespace taut
