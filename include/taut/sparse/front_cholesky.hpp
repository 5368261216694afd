// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <functional>
#include <span>
#include <vector>

#include <taut/core/types.hpp>
#include <taut/sparse/detail/elimination_tree.hpp>

namespace taut::detail
{

/// Direct solver of H x = b for a sum H of positive semi-definite matrices of triangles, two unknowns a vertex: a
/// multifrontal Cholesky factorization (L D L^T). A triangle enters with the first of its vertices that is eliminated,
/// so that H is never assembled. Made for some thousand vertices.
class front_cholesky
{
public:
    /// Of one triangle, rows and columns (corner 0 x, y, corner 1 x, y, corner 2 x, y); symmetric.
    using block = std::array<std::array<double, 6>, 6>;

    /// fixed: one flag a vertex; a fixed vertex has no unknowns.
    front_cholesky(std::span<const std::array<idx, 3>> cells, std::span<const char> fixed)
        : cells_(cells), slot_(fixed.size(), -1)
    {
        for (std::size_t v = 0; v < fixed.size(); ++v)
        {
            if (fixed[v]) continue;
            slot_[v] = static_cast<idx>(unknown_.size());
            unknown_.push_back(static_cast<idx>(v));
        }
        order();
        first_cells();
        rows_.resize(fronts_.size());
        pending_.resize(fronts_.size());
        place_.resize(unknown_.size());
    }

    /// Factorizes sum of blocks + relative_shift * its diagonal; one block a triangle. proceed, if given, is asked
    /// between fronts; once it says no, there are no factors and the answer is false.
    bool factorize(std::span<const block> blocks, double relative_shift, const std::function<bool()>& proceed = {})
    {
        for (std::size_t f = 0; f < fronts_.size(); ++f)
        {
            if (proceed && !proceed()) return false;
            dense front = assemble(f, blocks);
            eliminate(front, 2 * fronts_[f].pivots.size(), relative_shift);
            split(front, f);
        }
        return true;
    }

    /// b: one vector a vertex; the result is 0 at fixed vertices.
    std::vector<vec2> solve(std::span<const vec2> b) const
    {
        std::vector<double> x(2 * unknown_.size());
        for (std::size_t i = 0; i < unknown_.size(); ++i)
            for (std::size_t k = 0; k < 2; ++k) x[2 * i + k] = b[u(unknown_[i])][static_cast<int>(k)];
        std::vector<std::size_t> at;
        for (std::size_t f = 0; f < fronts_.size(); ++f)
        {
            unknowns(f, at);
            for (std::size_t r = 0; r < 2 * fronts_[f].pivots.size(); ++r)
            {
                const double* row = rows_[f].row(r);
                for (std::size_t c = r + 1; c < at.size(); ++c) x[at[c]] -= row[c] * x[at[r]];
            }
        }
        for (std::size_t f = fronts_.size(); f-- > 0;)
        {
            unknowns(f, at);
            for (std::size_t r = 2 * fronts_[f].pivots.size(); r-- > 0;)
            {
                const double* row = rows_[f].row(r);
                double sum = row[r] > 0 ? x[at[r]] / row[r] : 0.0;
                for (std::size_t c = r + 1; c < at.size(); ++c) sum -= row[c] * x[at[c]];
                x[at[r]] = sum;
            }
        }
        std::vector<vec2> result(slot_.size(), vec2(0.0));
        for (std::size_t i = 0; i < unknown_.size(); ++i) result[u(unknown_[i])] = {x[2 * i], x[2 * i + 1]};
        return result;
    }

private:
    static constexpr std::size_t panel = 4; // pivots that are eliminated together

    static std::size_t u(idx i) { return static_cast<std::size_t>(i); }

    /// Rows of the upper triangle of a front. Of a pivot: its D, then L^T.
    struct dense
    {
        std::size_t width = 0;
        std::vector<double> value;
        double* row(std::size_t i) { return value.data() + i * width; }
        const double* row(std::size_t i) const { return value.data() + i * width; }
    };

    void order()
    {
        std::vector<std::vector<idx>> near(unknown_.size());
        for (const auto& t : cells_)
            for (const idx v : t)
                for (const idx w : t)
                    if (v != w && slot_[u(v)] >= 0 && slot_[u(w)] >= 0) near[u(slot_[u(v)])].push_back(slot_[u(w)]);
        std::vector<idx> offset{0}, column;
        for (auto& n : near)
        {
            std::sort(n.begin(), n.end());
            column.insert(column.end(), n.begin(), std::unique(n.begin(), n.end()));
            offset.push_back(static_cast<idx>(column.size()));
        }
        fronts_ = elimination_tree(offset, column).fronts();
    }

    void first_cells()
    {
        std::vector<std::size_t> front_of(unknown_.size());
        for (std::size_t f = 0; f < fronts_.size(); ++f)
            for (const idx p : fronts_[f].pivots) front_of[u(p)] = f;
        own_.resize(fronts_.size());
        for (std::size_t c = 0; c < cells_.size(); ++c)
        {
            std::size_t first = fronts_.size();
            for (const idx v : cells_[c])
                if (slot_[u(v)] >= 0) first = std::min(first, front_of[u(slot_[u(v)])]);
            if (first < fronts_.size()) own_[first].push_back(c);
        }
    }

    /// Numbers in x of the rows of a front.
    void unknowns(std::size_t f, std::vector<std::size_t>& at) const
    {
        at.clear();
        for (const auto* part : {&fronts_[f].pivots, &fronts_[f].border})
            for (const idx i : *part) at.insert(at.end(), {2 * u(i), 2 * u(i) + 1});
    }

    dense assemble(std::size_t f, std::span<const block> blocks)
    {
        const auto& front = fronts_[f];
        std::size_t count = 0;
        for (const auto* part : {&front.pivots, &front.border})
            for (const idx i : *part) place_[u(i)] = count++;
        dense result{2 * count, std::vector<double>(4 * count * count)};
        const auto add = [&](std::size_t r, std::size_t c, double value)
        { result.row(std::min(r, c))[std::max(r, c)] += value; };
        for (const std::size_t c : own_[f])
            for (std::size_t i = 0; i < 6; ++i)
                for (std::size_t j = i; j < 6; ++j)
                {
                    const idx a = slot_[u(cells_[c][i / 2])], b = slot_[u(cells_[c][j / 2])];
                    if (a >= 0 && b >= 0) add(2 * place_[u(a)] + i % 2, 2 * place_[u(b)] + j % 2, blocks[c][i][j]);
                }
        for (const idx child : front.children)
        {
            dense& left = pending_[u(child)];
            const auto& border = fronts_[u(child)].border;
            for (std::size_t r = 0; r < left.width; ++r)
                for (std::size_t c = r; c < left.width; ++c)
                    add(2 * place_[u(border[r / 2])] + r % 2, 2 * place_[u(border[c / 2])] + c % 2, left.row(r)[c]);
            left = {};
        }
        return result;
    }

    static void eliminate(dense& front, std::size_t pivots, double relative_shift)
    {
        for (std::size_t first = 0; first < pivots; first += panel)
        {
            const std::size_t last = std::min(first + panel, pivots);
            for (std::size_t k = first; k < last; ++k)
            {
                double* pivot = front.row(k);
                pivot[k] *= 1 + relative_shift;
                if (!(pivot[k] > 0)) // a direction without any stiffness is left out
                    std::fill(pivot + k, pivot + front.width, 0.0);
                for (std::size_t i = k + 1; i < last; ++i)
                {
                    const double factor = pivot[k] > 0 ? pivot[i] / pivot[k] : 0.0;
                    double* row = front.row(i);
                    for (std::size_t j = i; j < front.width; ++j) row[j] -= factor * pivot[j];
                }
            }
            take_out(front, first, last);
            for (std::size_t k = first; k < last; ++k)
            {
                double* pivot = front.row(k);
                const double scale = pivot[k] > 0 ? 1 / pivot[k] : 0.0;
                for (std::size_t j = k + 1; j < front.width; ++j) pivot[j] *= scale;
            }
        }
    }

    /// Takes the pivots [first, last), at most a panel, out of the rows below them. All in one pass over a row, two
    /// rows at a time: what is loaded is used as often as registers allow.
    static void take_out(dense& front, std::size_t first, std::size_t last)
    {
        const std::size_t n = front.width, count = last - first;
        std::array<const double*, panel> p{};
        std::array<double, panel> scale{};
        for (std::size_t k = 0; k < panel; ++k) // the last panel may be short: repeats a row with factor 0
        {
            p[k] = front.row(first + std::min(k, count - 1));
            scale[k] = k < count && p[k][first + k] > 0 ? 1 / p[k][first + k] : 0.0;
        }
        const double *p0 = p[0], *p1 = p[1], *p2 = p[2], *p3 = p[3];
        for (std::size_t i = last; i < n; i += 2)
        {
            const std::array<double, panel> f{p0[i] * scale[0], p1[i] * scale[1], p2[i] * scale[2], p3[i] * scale[3]};
            double* row = front.row(i);
            row[i] -= (f[0] * p0[i] + f[1] * p1[i]) + (f[2] * p2[i] + f[3] * p3[i]);
            if (i + 1 == n) break;
            const std::size_t l = i + 1;
            const std::array<double, panel> g{p0[l] * scale[0], p1[l] * scale[1], p2[l] * scale[2], p3[l] * scale[3]};
            double* next = front.row(l);
            for (std::size_t j = l; j < n; ++j)
            {
                row[j] -= (f[0] * p0[j] + f[1] * p1[j]) + (f[2] * p2[j] + f[3] * p3[j]);
                next[j] -= (g[0] * p0[j] + g[1] * p1[j]) + (g[2] * p2[j] + g[3] * p3[j]);
            }
        }
    }

    void split(const dense& front, std::size_t f)
    {
        const std::size_t pivots = 2 * fronts_[f].pivots.size(), n = front.width, rest = n - pivots;
        rows_[f] = {
            n, std::vector<double>(front.value.begin(), front.value.begin() + static_cast<std::ptrdiff_t>(pivots * n))};
        dense& left = pending_[f];
        left = {rest, std::vector<double>(rest * rest)};
        for (std::size_t r = 0; r < rest; ++r)
            for (std::size_t c = r; c < rest; ++c) left.row(r)[c] = front.row(pivots + r)[pivots + c];
    }

    std::span<const std::array<idx, 3>> cells_;
    std::vector<idx> slot_;    // of a vertex among the unknown ones, or -1
    std::vector<idx> unknown_; // their vertices
    std::vector<elimination_front> fronts_;
    std::vector<std::vector<std::size_t>> own_; // triangles that enter with a front
    std::vector<dense> rows_;                   // the eliminated rows, for solve()
    std::vector<dense> pending_;                // what a front leaves to its parent
    std::vector<std::size_t> place_;
};

} // namespace taut::detail
