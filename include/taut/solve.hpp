// SPDX-License-Identifier: MIT
#pragma once

/// Solvers for functions of your own: Newton, L-BFGS, gradient descent and conjugate gradients over any vector
/// space.
#include <taut/impl/compute/vector_space.hpp>
#include <taut/impl/objective/map_evaluator.hpp>
#include <taut/impl/solve/host_objective.hpp>
#include <taut/impl/solve/host_space.hpp>
#include <taut/impl/solve/minimize.hpp>
