// SPDX-License-Identifier: MIT
#pragma once

#include <taut/solve/gram.hpp>
#include <taut/solve/objective.hpp>
#include <taut/solve/two_loop.hpp>

namespace taut::solve
{

/// Calls run(h) with the inverse Hessian operator that the parameters ask for, on the space of an objective and with
/// its preconditioner as H0 where it has one.
template <objective Objective, class Run>
auto with_inverse_hessian(Objective& f, const memory_params& params, Run run)
{
    using space = space_of<Objective>;
    preconditioner<vector_of<Objective>> h0;
    if constexpr (has_precondition<Objective>)
        h0 = [&f](const vector_of<Objective>& v, vector_of<Objective>& out) { f.precondition(v, out); };

    // The two-loop form is the reference of the other. Objectives with a Hessian do without it, which halves what
    // compilers have to make of them.
    if constexpr (!has_hessian<Objective>)
        if (params.form == inverse_hessian_form::two_loop)
        {
            two_loop_inverse_hessian<space> h(f.space(), params, h0);
            return run(h);
        }
    gram_inverse_hessian<space> h(f.space(), params, h0);
    return run(h);
}

} // namespace taut::solve
