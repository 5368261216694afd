// SPDX-License-Identifier: MIT
#pragma once

#include <taut/map/session.hpp>

#include <taut/map/detail/session/map_session.hpp>

template taut::session<taut::triangle>::session(queue&, const mesh<triangle>&, const parameterize_params&);
