// SPDX-License-Identifier: MIT
#pragma once

/// Certificates in exact arithmetic: flips, branch points, crossings, cells.
#include <taut/impl/exact/branch_points.hpp>
#include <taut/impl/exact/cell_validity.hpp>
#include <taut/impl/exact/certify.hpp>
#include <taut/impl/exact/collapses.hpp>
#include <taut/impl/exact/convex_polygons.hpp>
#include <taut/impl/exact/crossings.hpp>
#include <taut/impl/exact/predicates.hpp>
