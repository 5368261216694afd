// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <functional>
#include <span>
#include <utility>
#include <vector>

#include <taut/core/parallel.hpp>
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
        share_out();
    }

    /// Factorizes the sum of blocks + relative_shift * its diagonal; one block a triangle. proceed, if given, is asked
    /// between fronts; once it says no, there are no factors and the answer is false.
    bool factorize(std::span<const block> blocks, double relative_shift, const std::function<bool()>& proceed = {})
    {
        std::vector<char> positive(tasks_.size() + 1, 1);
        if (proceed && !proceed()) return false;
        parallel_for(
            tasks_.size(),
            [&](std::size_t begin, std::size_t end)
            {
                dense front;
                for (std::size_t t = begin; t < end; ++t)
                    for (std::size_t f = tasks_[t].first; f < tasks_[t].last; ++f)
                        positive[t] &= eliminate(steps_[f], blocks, relative_shift, front);
            },
            0, 2);
        dense front;
        for (const std::size_t f : top_)
        {
            if (proceed && !proceed()) return false;
            positive.back() &= eliminate(steps_[f], blocks, relative_shift, front);
        }
        definite_ = std::find(positive.begin(), positive.end(), 0) == positive.end();
        return true;
    }

    /// Whether the last sum was positive definite, up to rounding: if not, directions without stiffness, or with a
    /// negative one, were left out.
    bool definite() const { return definite_; }

    /// b: one vector a vertex; the result is 0 at fixed vertices.
    std::vector<vec2> solve(std::span<const vec2> b) const
    {
        std::vector<double> x(2 * unknown_.size());
        for (std::size_t i = 0; i < unknown_.size(); ++i)
            for (std::size_t k = 0; k < 2; ++k) x[2 * i + k] = b[u(unknown_[i])][static_cast<int>(k)];
        const auto at = [](const step& f, std::size_t r) { return 2 * u(f.variables[r / 2]) + r % 2; };
        for (const step& f : steps_)
            for (std::size_t r = 0; r < 2 * f.pivots; ++r)
            {
                const double* row = f.rows.row(r);
                const double pivot = x[at(f, r)];
                for (std::size_t c = r + 1; c < f.width(); ++c) x[at(f, c)] -= row[c] * pivot;
            }
        for (auto f = steps_.rbegin(); f != steps_.rend(); ++f)
            for (std::size_t r = 2 * f->pivots; r-- > 0;)
            {
                const double* row = f->rows.row(r);
                double sum = row[r] > 0 ? x[at(*f, r)] / row[r] : 0.0;
                for (std::size_t c = r + 1; c < f->width(); ++c) sum -= row[c] * x[at(*f, c)];
                x[at(*f, r)] = sum;
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

    /// A triangle as it enters a front: its corners by their places there, fixed ones first.
    struct entry
    {
        std::size_t cell;
        std::array<idx, 3> place; ///< or -1
        std::array<char, 3> corner;
    };

    /// A front and what is left of it.
    struct step
    {
        std::size_t pivots = 0;
        std::vector<idx> variables; ///< pivots, then the border
        std::vector<entry> own;     ///< triangles that enter with it
        std::vector<std::size_t> children;
        std::vector<std::vector<idx>> places; ///< of each child's border
        dense rows;                           ///< the eliminated ones, for solve()
        dense rest;                           ///< for its parent

        std::size_t width() const { return 2 * variables.size(); }
    };

    struct range
    {
        std::size_t first, last;
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
        auto fronts = elimination_tree(offset, column).fronts();
        std::vector<idx> place(unknown_.size());
        for (auto& f : fronts)
        {
            step s;
            s.pivots = f.pivots.size();
            s.variables = std::move(f.pivots);
            s.variables.insert(s.variables.end(), f.border.begin(), f.border.end());
            for (std::size_t k = 0; k < s.variables.size(); ++k) place[u(s.variables[k])] = static_cast<idx>(k);
            for (const idx child : f.children)
            {
                const step& c = steps_[u(child)];
                auto& places = s.places.emplace_back();
                for (std::size_t k = c.pivots; k < c.variables.size(); ++k) places.push_back(place[u(c.variables[k])]);
                s.children.push_back(u(child));
            }
            s.rows = {s.width(), std::vector<double>(2 * s.pivots * s.width())};
            const std::size_t rest = s.width() - 2 * s.pivots;
            s.rest = {rest, std::vector<double>(rest * rest)};
            steps_.push_back(std::move(s));
        }
    }

    void first_cells()
    {
        std::vector<std::size_t> step_of(unknown_.size());
        for (std::size_t f = 0; f < steps_.size(); ++f)
            for (std::size_t k = 0; k < steps_[f].pivots; ++k) step_of[u(steps_[f].variables[k])] = f;
        for (std::size_t c = 0; c < cells_.size(); ++c)
        {
            std::size_t first = steps_.size();
            for (const idx v : cells_[c])
                if (slot_[u(v)] >= 0) first = std::min(first, step_of[u(slot_[u(v)])]);
            if (first < steps_.size()) steps_[first].own.push_back({c, {}, {0, 1, 2}});
        }
        std::vector<idx> place(unknown_.size(), -1);
        for (step& s : steps_)
        {
            for (std::size_t k = 0; k < s.variables.size(); ++k) place[u(s.variables[k])] = static_cast<idx>(k);
            for (entry& e : s.own)
            {
                const auto place_of = [&](char corner)
                {
                    const idx i = slot_[u(cells_[e.cell][static_cast<std::size_t>(corner)])];
                    return i < 0 ? idx(-1) : place[u(i)];
                };
                std::sort(e.corner.begin(), e.corner.end(), [&](char a, char b) { return place_of(a) < place_of(b); });
                for (std::size_t k = 0; k < 3; ++k) e.place[k] = place_of(e.corner[k]);
            }
        }
    }

    /// Subtrees that threads eliminate, and what is above them.
    void share_out()
    {
        std::vector<double> work(steps_.size()); // of a subtree
        std::vector<std::size_t> first(steps_.size());
        double total = 0;
        for (std::size_t f = 0; f < steps_.size(); ++f)
        {
            const double width = double(steps_[f].width()), own = width * width * double(1 + steps_[f].pivots);
            work[f] = own;
            total += own;
            first[f] = f;
            for (const std::size_t child : steps_[f].children)
            {
                work[f] += work[child];
                first[f] = std::min(first[f], first[child]);
            }
        }
        const double most = total / 8;
        for (std::size_t f = steps_.size(); f-- > 0;)
        {
            if (work[f] > most)
            {
                top_.push_back(f);
                continue;
            }
            tasks_.push_back({first[f], f + 1});
            f = first[f];
        }
        std::reverse(top_.begin(), top_.end());
    }

    /// Eliminates the pivots of a front, which is made in `front`; whether they were positive.
    bool eliminate(step& s, std::span<const block> blocks, double relative_shift, dense& front) const
    {
        assemble(s, blocks, front);
        const bool positive = eliminate(front, 2 * s.pivots, relative_shift);
        split(front, s);
        return positive;
    }

    void assemble(const step& s, std::span<const block> blocks, dense& front) const
    {
        front.width = s.width();
        if (front.value.size() < front.width * front.width) front.value.resize(front.width * front.width);
        for (std::size_t r = 0; r < front.width; ++r) std::fill(front.row(r) + r, front.row(r) + front.width, 0.0);
        for (const entry& e : s.own)
            for (std::size_t a = 0; a < 3; ++a)
                for (std::size_t b = a; b < 3 && e.place[a] >= 0; ++b)
                {
                    const auto i = static_cast<std::size_t>(2 * e.corner[a]),
                               j = static_cast<std::size_t>(2 * e.corner[b]);
                    const block& from = blocks[e.cell];
                    double *upper = front.row(2 * u(e.place[a])) + 2 * u(e.place[b]), *lower = upper + front.width;
                    upper[0] += from[i][j];
                    upper[1] += from[i][j + 1];
                    if (a != b) lower[0] += from[i + 1][j];
                    lower[1] += from[i + 1][j + 1];
                }
        for (std::size_t k = 0; k < s.children.size(); ++k)
        {
            const dense& left = steps_[s.children[k]].rest;
            const std::vector<idx>& place = s.places[k];
            for (std::size_t r = 0; r < place.size(); ++r)
                for (std::size_t c = r; c < place.size(); ++c)
                {
                    const double *from = left.row(2 * r) + 2 * c, *next = from + left.width;
                    const bool ordered = place[r] <= place[c];
                    const std::size_t row = 2 * u(ordered ? place[r] : place[c]),
                                      at = 2 * u(ordered ? place[c] : place[r]);
                    double *upper = front.row(row) + at, *lower = upper + front.width;
                    upper[0] += from[0];
                    upper[1] += ordered ? from[1] : next[0];
                    if (c != r) lower[0] += ordered ? next[0] : from[1];
                    lower[1] += next[1];
                }
        }
    }

    static bool eliminate(dense& front, std::size_t pivots, double relative_shift)
    {
        bool positive = true;
        for (std::size_t first = 0; first < pivots; first += panel)
        {
            const std::size_t last = std::min(first + panel, pivots);
            for (std::size_t k = first; k < last; ++k)
            {
                double* pivot = front.row(k);
                pivot[k] *= 1 + relative_shift;
                if (!(pivot[k] > 0))
                {
                    std::fill(pivot + k, pivot + front.width, 0.0);
                    positive = false;
                }
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
        return positive;
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

    static void split(const dense& front, step& s)
    {
        const std::size_t pivots = 2 * s.pivots, n = front.width;
        std::copy(front.value.begin(), front.value.begin() + static_cast<std::ptrdiff_t>(pivots * n),
                  s.rows.value.begin());
        for (std::size_t r = pivots; r < n; ++r)
            std::copy(front.row(r) + r, front.row(r) + n, s.rest.row(r - pivots) + (r - pivots));
    }

    std::span<const std::array<idx, 3>> cells_;
    std::vector<idx> slot_;    // of a vertex among the unknown ones, or -1
    std::vector<idx> unknown_; // their vertices
    std::vector<step> steps_;
    std::vector<range> tasks_; // of steps
    std::vector<std::size_t> top_;
    bool definite_ = true;
};

} // namespace taut::detail
