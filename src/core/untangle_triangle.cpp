// SPDX-License-Identifier: MIT
#include <taut/impl/core/untangle/coarse_stage.ipp>
#include <taut/impl/core/untangle/convex_corners.ipp>
#include <taut/impl/core/untangle/element_newton.ipp>
#include <taut/impl/core/untangle/proofs/infeasible.ipp>
#include <taut/impl/core/untangle/proofs/pinned_boundary.ipp>
#include <taut/impl/core/untangle/pull_stage.ipp>
#include <taut/impl/core/untangle/result.ipp>
#include <taut/impl/core/untangle/untangle_triangle.ipp>
