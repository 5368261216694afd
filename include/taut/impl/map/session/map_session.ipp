// SPDX-License-Identifier: MIT
#pragma once

#include <taut/impl/map/session.hpp>

#include <taut/impl/map/session/map_session.hpp>

template taut::session<taut::triangle>::session(queue&, const mesh<triangle>&, const parameterize_params&);
