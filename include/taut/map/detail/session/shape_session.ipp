// SPDX-License-Identifier: MIT
#pragma once

#include <taut/map/session.hpp>

#include <taut/map/detail/session/open_shape.hpp>
#include <taut/map/detail/session/shell_session.hpp>
#include <taut/untangle/untangle.hpp>

template taut::session<taut::tetrahedron>::session(queue&, const mesh<tetrahedron>&, const deform_params<tetrahedron>&);
template taut::session<taut::triangle>::session(queue&, const mesh<triangle>&, const deform_params<triangle>&);
template taut::session<taut::hinge>::session(queue&, const thin_shell&, const shell_params&);
