// SPDX-License-Identifier: MIT
#include <taut/impl/enter.inl>
#if TAUT_OPEN == 1 // the parts that its calls need
#define TAUT_PART_VOLUME
#endif
#ifndef TAUT_SOLVE_HPP
#define TAUT_SOLVE_HPP

/// Solvers for functions of your own: Newton, L-BFGS, gradient descent and conjugate gradients over any vector space;
/// and the objective of a map as such a function.
#include <taut/device_vectors.hpp>
#include <taut/evaluator.hpp>
#include <taut/minimize.hpp>

#endif
#include <taut/impl/leave.inl>
