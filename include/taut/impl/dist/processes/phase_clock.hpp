// SPDX-License-Identifier: MIT
#pragma once

#include <chrono>

namespace taut::dist::impl
{

/// Wall-clock seconds of one process by phase.
struct phase_seconds
{
    double distribute = 0; ///< order, owners, halo, elements
    double plan = 0;       ///< patterns of matrices
    double start = 0;      ///< the initial guess of a large motion
    double values = 0;     ///< energies, gradients, first flips
    double linearize = 0;  ///< Hessians of elements and their sums
    double setup = 0;      ///< the preconditioner, and the matrix handed to it
    double apply = 0;      ///< the preconditioner applied
    double products = 0;   ///< products with the matrix
    double certify = 0;    ///< exact signs
};

/// The clock of a run by phase.
class phase_clock
{
public:
    using clock = std::chrono::steady_clock;

    /// Adds the time of a scope to a phase.
    class scope
    {
    public:
        explicit scope(double& sum) : sum_(sum), begin_(clock::now()) {}
        scope(const scope&) = delete;
        scope& operator=(const scope&) = delete;
        ~scope() { sum_ += std::chrono::duration<double>(clock::now() - begin_).count(); }

    private:
        double& sum_;
        clock::time_point begin_;
    };

    scope measure(double phase_seconds::*phase) { return scope(spent_.*phase); }
    const phase_seconds& spent() const { return spent_; }

private:
    phase_seconds spent_;
};

} // namespace taut::dist::impl
