// SPDX-License-Identifier: MIT
// What is large to compile, for projects of many files: these define TAUT_SEPARATE and call it only.
#include <taut/map/parameterize.hpp>
#include <taut/untangle/untangle.hpp>

#include <taut/map/detail/parameterization.hpp>
#include <taut/untangle/untangle_on_device.hpp>

namespace taut
{

template map_result parameterize(queue&, const mesh<triangle>&, const parameterize_params&);
template untangle_result<triangle> untangle(const queue&, const untangle_problem<triangle>&, const untangle_params&);
template untangle_result<tetrahedron> untangle(const queue&, const untangle_problem<tetrahedron>&,
                                               const untangle_params&);

} // namespace taut
