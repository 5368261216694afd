// SPDX-License-Identifier: MIT
#pragma once

/// Moves free vertices until no element is inverted, or proves that none can be.
#include <taut/impl/io/make_untangle_problem.hpp>
#include <taut/impl/untangle/proofs/infeasible.hpp>
#include <taut/impl/untangle/untangle.hpp>
#include <taut/impl/untangle/untangle_refined.hpp>
