// SPDX-License-Identifier: MIT
#pragma once

#include <taut/impl/map/session.hpp>

#include <taut/impl/map/session/open_shape.hpp>
#include <taut/impl/map/session/shell_session.hpp>
#include <taut/impl/untangle/untangle.hpp>

template taut::session<taut::tetrahedron>::session(queue&, const mesh<tetrahedron>&, const deform_params<tetrahedron>&);
template taut::session<taut::triangle>::session(queue&, const mesh<triangle>&, const deform_params<triangle>&);
template taut::session<taut::hinge>::session(queue&, const thin_shell&, const shell_params&);
