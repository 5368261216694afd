// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <functional>
#include <vector>

#include <taut/errors.hpp>
#include <taut/impl/core/sparse/barycentric_system.hpp>
#include <taut/impl/core/sparse/elimination_tree.hpp>

namespace taut::impl
{

/// Direct solver of barycentric systems that never subtracts.
///
/// Eliminating a vertex replaces it by the mean it stands for: w_ij += w_ik w_kj / d_k, excess_i += w_ik excess_k /
/// d_k, with d_k = excess_k + sum_j w_kj taken over what is left, not by updating a diagonal. All terms are positive,
/// so every weight keeps its relative accuracy however ill-conditioned the system (Grassmann, Taksar, Heyman 1985;
/// Alfa, Xue, Ye 2002), and back substitution is again a sequence of means: vertices stay ordered as injectivity needs
/// them.
///
/// Multifrontal: sparse in a tree of dense fronts. About n log n memory and n^1.5 work on surfaces; symmetric or not.
class elimination_solver
{
public:
    /// Positions of the unknowns. Throws `error` if some have no path of weights to a fixed vertex.
    /// The elimination order is kept for further systems with the same pattern.
    std::vector<vec2> operator()(const barycentric_system& system);

    /// Thrown where `proceed` refuses.
    struct stopped
    {
    };

    std::function<bool()> proceed = {}; ///< asked now and then, if given: go on?

private:
    std::vector<vec2> solve(const barycentric_system& system, const std::vector<impl::elimination_front>& fronts) const;

    static std::size_t u(idx i) { return static_cast<std::size_t>(i); }

    /// Rows of a front: `width` weights each, then excess and right-hand side.
    struct block
    {
        std::size_t width = 0;
        std::vector<double> weight;
        std::vector<double> excess;
        std::vector<vec2> rhs;

        block() = default;
        block(std::size_t height, std::size_t columns)
            : width(columns), weight(height * columns), excess(height), rhs(height, vec2(0))
        {
        }
        double* row(std::size_t i) { return weight.data() + i * width; }
        const double* row(std::size_t i) const { return weight.data() + i * width; }
    };

    /// weight of (j, i) for every stored (i, j); rows have ascending columns, so one pass in order finds each.
    static std::vector<double> transpose(const barycentric_system& system);

    static block assemble(const barycentric_system& system, const std::vector<double>& transposed,
                          const impl::elimination_front& front, const std::vector<impl::elimination_front>& fronts,
                          std::vector<block>& pending, std::vector<idx>& place, const std::vector<char>& eliminated);

    /// Eliminates the pivots, a panel that fits the cache at a time, from every row below.
    void eliminate(block& dense, const std::vector<idx>& pivots) const;

    /// Replaces pivots [first, last) in row i by their means. Four at a time: one pass over the row for all of them.
    static void take_in(block& dense, std::size_t i, std::size_t first, std::size_t last);

    static void split(block dense, std::size_t pivots, block& rows, block& pending);

    static void substitute(const impl::elimination_front& front, const block& rows, std::vector<vec2>& x);

    void ask() const
    {
        if (proceed && !proceed()) throw stopped();
    }

    std::vector<idx> offset_, column_; // the pattern that fronts_ belong to
    std::vector<impl::elimination_front> fronts_;
};

} // namespace taut::impl
