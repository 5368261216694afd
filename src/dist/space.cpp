// SPDX-License-Identifier: MIT
#include <taut/impl/dist/shape/entry_points/check.ipp>
#include <taut/impl/dist/shape/entry_points/session.ipp>
#include <taut/impl/dist/shape/entry_points/smooth.ipp>

namespace taut::dist
{

template class session<tetrahedron>;
template result<tetrahedron> smooth(MPI_Comm, const mesh_piece<tetrahedron>&, const smooth_params&, const run_limits&);
template session<tetrahedron> impl::smoothing_session(MPI_Comm, const mesh_piece<tetrahedron>&, const smooth_params&);
template certificate check(MPI_Comm, const mesh_piece<tetrahedron>&);

} // namespace taut::dist
