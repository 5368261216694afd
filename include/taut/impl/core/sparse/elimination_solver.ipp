// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <string>
#include <utility>

#include <taut/impl/core/sparse/elimination_solver.hpp>

namespace taut::impl
{

std::vector<vec2> elimination_solver::operator()(const barycentric_system& system)
{
    if (system.offset != offset_ || system.column != column_)
    {
        offset_ = system.offset;
        column_ = system.column;
        fronts_ = impl::elimination_tree(offset_, column_).fronts();
    }
    return solve(system, fronts_);
}

std::vector<vec2> elimination_solver::solve(const barycentric_system& system,
                                            const std::vector<impl::elimination_front>& fronts) const
{
    constexpr std::size_t often = 512;         // fronts, most of which are small
    std::vector<block> pending(fronts.size()); // what a front leaves to its parent
    std::vector<block> rows(fronts.size());    // eliminated rows, kept for back substitution
    std::vector<idx> place(system.size(), -1);
    std::vector<char> eliminated(system.size(), 0);
    const std::vector<double> transposed = transpose(system);

    for (std::size_t f = 0; f < fronts.size(); ++f)
    {
        if (f % often == 0) ask();
        block dense = assemble(system, transposed, fronts[f], fronts, pending, place, eliminated);
        eliminate(dense, fronts[f].pivots);
        split(std::move(dense), fronts[f].pivots.size(), rows[f], pending[f]);
        for (const idx v : fronts[f].pivots) eliminated[u(v)] = 1;
    }

    std::vector<vec2> x(system.size());
    for (std::size_t f = fronts.size(); f-- > 0;) substitute(fronts[f], rows[f], x);
    return x;
}

std::vector<double> elimination_solver::transpose(const barycentric_system& system)
{
    std::vector<double> result(system.weight.size());
    std::vector<idx> next(system.offset.begin(), system.offset.end() - 1);
    for (std::size_t i = 0; i < system.size(); ++i)
        for (auto k = u(system.offset[i]); k < u(system.offset[i + 1]); ++k)
            result[u(next[u(system.column[k])]++)] = system.weight[k];
    return result;
}

elimination_solver::block
elimination_solver::assemble(const barycentric_system& system, const std::vector<double>& transposed,
                             const impl::elimination_front& front, const std::vector<impl::elimination_front>& fronts,
                             std::vector<block>& pending, std::vector<idx>& place, const std::vector<char>& eliminated)
{
    const std::size_t pivots = front.pivots.size();
    const std::size_t n = pivots + front.border.size();
    for (std::size_t k = 0; k < pivots; ++k) place[u(front.pivots[k])] = static_cast<idx>(k);
    for (std::size_t k = pivots; k < n; ++k) place[u(front.border[k - pivots])] = static_cast<idx>(k);

    block dense(n, n);
    for (std::size_t r = 0; r < pivots; ++r)
    {
        const std::size_t i = u(front.pivots[r]);
        dense.excess[r] = system.excess[i];
        dense.rhs[r] = system.rhs[i];
        for (auto k = u(system.offset[i]); k < u(system.offset[i + 1]); ++k)
        {
            const std::size_t j = u(system.column[k]);
            if (eliminated[j]) continue; // came in with j's front
            const std::size_t c = u(place[j]);
            dense.row(r)[c] = system.weight[k];
            if (c >= pivots) dense.row(c)[r] = transposed[k]; // pivots bring their own rows
        }
    }
    for (const idx child : front.children)
    {
        block& left = pending[u(child)];
        const auto& border = fronts[u(child)].border;
        for (std::size_t r = 0; r < border.size(); ++r)
        {
            const std::size_t to = u(place[u(border[r])]);
            dense.excess[to] += left.excess[r];
            dense.rhs[to] += left.rhs[r];
            const double* from = left.row(r);
            double* row = dense.row(to);
            for (std::size_t c = 0; c < border.size(); ++c) row[u(place[u(border[c])])] += from[c];
        }
        left = {};
    }
    return dense;
}

void elimination_solver::eliminate(block& dense, const std::vector<idx>& pivots) const
{
    constexpr std::size_t panel = 32;
    const std::size_t n = dense.width;
    for (std::size_t first = 0; first < pivots.size(); first += panel)
    {
        if (first > 0) ask();
        const std::size_t last = std::min(first + panel, pivots.size());
        for (std::size_t i = first; i < n; ++i)
        {
            take_in(dense, i, first, std::min(i, last));
            if (i >= last) continue;
            // The diagonal weight row[i] is a vertex's pull on itself: it drops out of the mean.
            double* row = dense.row(i);
            double total = dense.excess[i];
            for (std::size_t j = i + 1; j < n; ++j) total += row[j];
            if (!(total > 0)) throw error("unknown " + std::to_string(pivots[i]) + " has no path to a fixed vertex");
            for (std::size_t j = i + 1; j < n; ++j) row[j] /= total;
            dense.excess[i] /= total;
            dense.rhs[i] /= total;
        }
    }
}

void elimination_solver::take_in(block& dense, std::size_t i, std::size_t first, std::size_t last)
{
    double* row = dense.row(i);
    const std::size_t n = dense.width;
    std::size_t k = first;
    for (; k + 4 <= last; k += 4)
    {
        const std::array<const double*, 4> p{dense.row(k), dense.row(k + 1), dense.row(k + 2), dense.row(k + 3)};
        for (std::size_t a = 0; a < 3; ++a)
            for (std::size_t b = a + 1; b < 4; ++b) row[k + b] += row[k + a] * p[a][k + b];
        const std::array<double, 4> f{row[k], row[k + 1], row[k + 2], row[k + 3]};
        for (std::size_t j = k + 4; j < n; ++j)
            row[j] += (f[0] * p[0][j] + f[1] * p[1][j]) + (f[2] * p[2][j] + f[3] * p[3][j]);
    }
    for (; k < last; ++k)
    {
        const double* p = dense.row(k);
        for (std::size_t j = k + 1; j < n; ++j) row[j] += row[k] * p[j];
    }
    for (k = first; k < last; ++k)
    {
        dense.excess[i] += row[k] * dense.excess[k];
        dense.rhs[i] += row[k] * dense.rhs[k];
    }
}

void elimination_solver::split(block dense, std::size_t pivots, block& rows, block& pending)
{
    const std::size_t n = dense.width;
    const std::size_t border = n - pivots;
    pending = block(border, border);
    for (std::size_t r = 0; r < border; ++r)
    {
        std::copy_n(dense.row(pivots + r) + pivots, border, pending.row(r));
        pending.excess[r] = dense.excess[pivots + r];
        pending.rhs[r] = dense.rhs[pivots + r];
    }
    dense.weight.resize(pivots * n);
    dense.weight.shrink_to_fit();
    rows = std::move(dense);
}

void elimination_solver::substitute(const impl::elimination_front& front, const block& rows, std::vector<vec2>& x)
{
    const std::size_t pivots = front.pivots.size();
    for (std::size_t i = pivots; i-- > 0;)
    {
        const double* row = rows.row(i);
        vec2 mean = rows.rhs[i];
        for (std::size_t j = i + 1; j < pivots; ++j) mean += row[j] * x[u(front.pivots[j])];
        for (std::size_t j = pivots; j < rows.width; ++j) mean += row[j] * x[u(front.border[j - pivots])];
        x[u(front.pivots[i])] = mean;
    }
}

} // namespace taut::impl
