// SPDX-License-Identifier: MIT
// parameterize() for the compiled form.
#include <taut/map/parameterize.hpp>

#include <taut/map/detail/parameterization.hpp>

template taut::map_result taut::parameterize(queue&, const mesh<triangle>&, const parameterize_params&);
