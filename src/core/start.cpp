// SPDX-License-Identifier: MIT
#include <taut/impl/core/hierarchy/collapse.ipp>
#include <taut/impl/core/hierarchy/make_hierarchy.ipp>
#include <taut/impl/core/hierarchy/reinsert.ipp>
#include <taut/impl/core/hierarchy/rings.ipp>
#include <taut/impl/core/hierarchy/thinning.ipp>
#include <taut/impl/core/objective/nonlinear_elimination.ipp>
#include <taut/impl/core/objective/objective.ipp>
#include <taut/impl/core/start/barycentric_map.ipp>
#include <taut/impl/core/start/boundary_polygon.ipp>
#include <taut/impl/core/start/outline.ipp>
#include <taut/impl/core/start/tube_map.ipp>
