// SPDX-License-Identifier: MIT
#include <taut/impl/hierarchy/collapse.ipp>
#include <taut/impl/hierarchy/make_hierarchy.ipp>
#include <taut/impl/hierarchy/reinsert.ipp>
#include <taut/impl/hierarchy/rings.ipp>
#include <taut/impl/hierarchy/thinning.ipp>
#include <taut/impl/objective/minimizers.ipp>
#include <taut/impl/objective/newton_objective.ipp>
#include <taut/impl/objective/nonlinear_elimination.ipp>
#include <taut/impl/objective/traced_element.ipp>
#include <taut/impl/start/barycentric_map.ipp>
#include <taut/impl/start/boundary_polygon.ipp>
#include <taut/impl/start/outline.ipp>
