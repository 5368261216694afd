// SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <span>
#include <vector>

#include <taut/evaluator.hpp>
#include <taut/types.hpp>

namespace bench
{

/// A supernodal Cholesky factorisation of the rows and columns of free vertices, on one thread of the host: ordered and
/// analysed once, for matrices of one pattern.
class direct_solver
{
public:
    virtual ~direct_solver() = default;

    /// False if the matrix is not positive definite.
    virtual bool factorize(const taut::block_rows<3>& matrix) = 0;

    /// d = the solution for b at free vertices, and 0 elsewhere.
    virtual void solve(std::span<const taut::vec3> b, std::span<taut::vec3> d) = 0;
};

/// By CHOLMOD; null where the build left it out (TAUT_BENCH_PEERS). pattern: a matrix of it. free: one per vertex.
std::unique_ptr<direct_solver> make_direct_solver(const taut::block_rows<3>& pattern, const std::vector<bool>& free);

} // namespace bench
