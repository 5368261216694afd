// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numeric>
#include <span>
#include <utility>
#include <vector>

#include <taut/impl/core/untangle/proofs/big_integer.hpp>

/// Search for a vanishing sum of vectors with nonnegative weights, which proves that inequalities contradict each other
/// (Farkas' lemma).
namespace taut::impl
{

/// Weights that are not negative, and what is left of the target without the sum.
struct nonnegative_fit
{
    std::vector<double> weights;
    std::vector<double> rest;
    double error() const { return std::sqrt(std::inner_product(rest.begin(), rest.end(), rest.begin(), 0.0)); }
};

/// The least squares of target - sum weights column over weights >= 0: Lawson and Hanson's active sets.
inline nonnegative_fit fit_nonnegative(std::span<const std::vector<double>> columns, const std::vector<double>& target)
{
    constexpr double tolerance = 1e-12;
    const std::size_t n = columns.size();
    const auto dot = [](const std::vector<double>& a, const std::vector<double>& b)
    { return std::inner_product(a.begin(), a.end(), b.begin(), 0.0); };
    nonnegative_fit fit{std::vector<double>(n, 0.0), target};
    std::vector<std::size_t> active;
    std::vector<char> is_active(n, 0);
    std::vector<double> solution;
    // Cholesky factor of the products of the active columns; false where they depend on each other.
    const auto solve = [&]
    {
        const std::size_t m = active.size();
        std::vector<double> factor(m * m, 0.0);
        solution.assign(m, 0.0);
        for (std::size_t i = 0; i < m; ++i)
        {
            for (std::size_t j = 0; j <= i; ++j)
            {
                double sum = dot(columns[active[i]], columns[active[j]]);
                const double own = sum;
                for (std::size_t k = 0; k < j; ++k) sum -= factor[i * m + k] * factor[j * m + k];
                if (i == j && !(sum > tolerance * own)) return false;
                factor[i * m + j] = i == j ? std::sqrt(sum) : sum / factor[j * m + j];
            }
            solution[i] = dot(columns[active[i]], target);
            for (std::size_t k = 0; k < i; ++k) solution[i] -= factor[i * m + k] * solution[k];
            solution[i] /= factor[i * m + i];
        }
        for (std::size_t i = m; i-- > 0;)
        {
            for (std::size_t k = i + 1; k < m; ++k) solution[i] -= factor[k * m + i] * solution[k];
            solution[i] /= factor[i * m + i];
        }
        return true;
    };
    const auto drop = [&](std::size_t i)
    {
        is_active[active[i]] = 0;
        fit.weights[active[i]] = 0;
        active.erase(active.begin() + static_cast<std::ptrdiff_t>(i));
    };
    for (std::size_t step = 0; step < 4 * n + 16; ++step)
    {
        std::size_t best = n;
        double steepest = tolerance;
        for (std::size_t k = 0; k < n; ++k)
            if (const double slope = is_active[k] ? 0.0 : dot(columns[k], fit.rest); slope > steepest)
            {
                steepest = slope;
                best = k;
            }
        if (best == n) break;
        active.push_back(best);
        is_active[best] = 1;
        if (!solve()) // as good as a sum of the others: rounding
        {
            drop(active.size() - 1);
            break;
        }
        for (;;)
        {
            double length = 1;
            std::size_t first = active.size();
            for (std::size_t i = 0; i < active.size(); ++i)
                if (const double now = fit.weights[active[i]]; solution[i] <= 0 && now / (now - solution[i]) < length)
                {
                    length = now / (now - solution[i]);
                    first = i;
                }
            for (std::size_t i = 0; i < active.size(); ++i)
                fit.weights[active[i]] += length * (solution[i] - fit.weights[active[i]]);
            if (first == active.size()) break;
            drop(first);
            if (!solve()) break;
        }
        fit.rest = target;
        for (const std::size_t k : active)
            for (std::size_t r = 0; r < target.size(); ++r) fit.rest[r] -= fit.weights[k] * columns[k][r];
    }
    return fit;
}

/// True if weights, none negative and not all 0, make the sum of the columns vanish, exact; the weights are the only
/// ones but for a factor. False where there are none or too many to tell. Elimination without fractions (Bareiss).
inline bool vanishes(std::vector<std::vector<big_integer>> columns)
{
    if (columns.empty()) return false;
    // Those of small numbers first: what follows grows from them.
    const auto size = [](const std::vector<big_integer>& c)
    { return std::accumulate(c.begin(), c.end(), 0, [](int sum, const auto& x) { return sum + x.bits(); }); };
    std::sort(columns.begin(), columns.end(), [&](const auto& a, const auto& b) { return size(a) < size(b); });
    const std::size_t n = columns.size() - 1, rows = columns[0].size();
    const auto step = [&](std::size_t k, std::size_t column, std::size_t row, const big_integer& before)
    {
        auto& x = columns[column][row];
        x = columns[k][k] * x - columns[k][row] * columns[column][k];
        if (k > 0) x = x.quotient(before);
    };
    for (std::size_t k = 0; k < n; ++k)
    {
        std::size_t pivot = k;
        while (pivot < rows && columns[k][pivot].sign() == 0) ++pivot;
        if (pivot == rows) return false;
        for (auto& c : columns) std::swap(c[k], c[pivot]);
        const big_integer before = k > 0 ? columns[k - 1][k - 1] : big_integer();
        for (std::size_t column = k + 1; column <= n; ++column)
            for (std::size_t row = k + 1; row < rows; ++row) step(k, column, row, before);
    }
    for (std::size_t row = n; row < rows; ++row)
        if (columns[n][row].sign() != 0) return false;
    // The last weight is minus the last pivot, then the others are integers.
    if (n == 0) return true;
    const big_integer& last = columns[n - 1][n - 1];
    std::vector<big_integer> weights(n + 1);
    weights[n] = -last;
    for (std::size_t k = n; k-- > 0;)
    {
        big_integer sum = last * columns[n][k];
        for (std::size_t j = k + 1; j < n; ++j) sum = sum - columns[j][k] * weights[j];
        weights[k] = sum.quotient(columns[k][k]);
        if (weights[k].sign() * weights[n].sign() < 0) return false;
    }
    return true;
}

} // namespace taut::impl
