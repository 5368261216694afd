// SPDX-License-Identifier: MIT
#include <taut/impl/core/error.ipp>
#include <taut/impl/core/parallel.ipp>
#include <taut/impl/core/private_folder.ipp>
#include <taut/impl/energy/default_energy.ipp>
#include <taut/impl/exact/branch_points.ipp>
#include <taut/impl/exact/convex_polygons.ipp>
#include <taut/impl/exact/crossings.ipp>
#include <taut/impl/exact/predicates.ipp>
#include <taut/impl/mesh/boundary.ipp>
#include <taut/impl/mesh/describe.ipp>
#include <taut/impl/mesh/facets.ipp>
#include <taut/impl/mesh/manifold.ipp>
#include <taut/impl/mesh/mesh.ipp>
#include <taut/impl/mesh/order.ipp>
#include <taut/impl/mesh/tetrahedron.ipp>
#include <taut/impl/mesh/validate.ipp>
