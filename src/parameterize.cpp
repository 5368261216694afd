// SPDX-License-Identifier: MIT
// parameterize() and sessions for the compiled form.
#include <taut/map/parameterize.hpp>
#include <taut/map/session.hpp>

#include <taut/map/detail/parameterization.hpp>
#include <taut/map/detail/session/map_session.hpp>

template taut::map_result taut::parameterize(queue&, const mesh<triangle>&, const parameterize_params&);
template taut::map_result taut::parameterize(queue&, const mesh<triangle>&);
template taut::session<taut::triangle>::session(queue&, const mesh<triangle>&, const parameterize_params&);
