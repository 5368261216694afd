// SPDX-License-Identifier: MIT
#include <taut/impl/untangle/coarse_stage.ipp>
#include <taut/impl/untangle/convex_corners.ipp>
#include <taut/impl/untangle/element_newton.ipp>
#include <taut/impl/untangle/proofs/empty_star.ipp>
#include <taut/impl/untangle/proofs/infeasible.ipp>
#include <taut/impl/untangle/proofs/pinned_boundary.ipp>
#include <taut/impl/untangle/pull_stage.ipp>
#include <taut/impl/untangle/untangle_triangle.ipp>
