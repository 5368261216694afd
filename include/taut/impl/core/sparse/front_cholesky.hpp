// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <atomic>
#include <cstddef>
#include <functional>
#include <memory>
#include <span>
#include <vector>

#include <taut/impl/core/core/parallel.hpp>
#include <taut/impl/core/sparse/elimination_tree.hpp>
#include <taut/types.hpp>

namespace taut::impl
{

/// Direct solver of H x = b for a sum H of positive semi-definite matrices of triangles, two unknowns per vertex: a
/// multifrontal Cholesky factorization (L D L^T). A triangle enters with the first of its vertices that is eliminated,
/// so that H is never assembled. Made for some thousand vertices.
class front_cholesky
{
public:
    /// Element matrix of one triangle, rows and columns (corner 0 x, y, corner 1 x, y, corner 2 x, y); symmetric.
    using block = std::array<std::array<double, 6>, 6>;

    /// fixed: one flag per vertex; a fixed vertex has no unknowns.
    front_cholesky(std::span<const std::array<idx, 3>> cells, std::span<const char> fixed);

    /// Factorizes the sum of blocks + relative_shift * its diagonal; one block per triangle. proceed, if given, is
    /// asked between fronts; once it says no, there are no factors and the answer is false.
    bool factorize(std::span<const block> blocks, double relative_shift, const std::function<bool()>& proceed = {});

    /// Factorizes the sums of several solvers, the largest first best: threads share all of their work. entry(i, cell,
    /// row, column): of the blocks of solver i. then(i) is called by the thread that has found its last factor, while
    /// others go on. definite_only: a sum that is found not to be definite is left there, without factors.
    template <class Entry, class Then>
    static void factorize_together(std::span<front_cholesky* const> solvers, double relative_shift, bool definite_only,
                                   const Entry& entry, const Then& then)
    {
        struct task
        {
            std::size_t solver;
            range steps;
        };
        struct state
        {
            std::atomic<std::size_t> left{0};
            std::atomic<bool> definite{true};
        };
        std::vector<task> all;
        const auto states = std::make_unique<state[]>(solvers.size());
        for (std::size_t i = 0; i < solvers.size(); ++i)
        {
            for (const range& r : solvers[i]->tasks_) all.push_back({i, r});
            if (solvers[i]->tasks_.empty()) all.push_back({i, {0, 0}});
            states[i].left = std::max<std::size_t>(1, solvers[i]->tasks_.size());
        }
        const auto eliminate_one = [&](std::size_t i, std::size_t f)
        {
            if (definite_only && !states[i].definite.load(std::memory_order_relaxed)) return;
            const auto own = [&](std::size_t cell, std::size_t r, std::size_t c) { return entry(i, cell, r, c); };
            if (!solvers[i]->eliminate(solvers[i]->steps_[f], own, relative_shift)) states[i].definite = false;
        };
        parallel_for(
            all.size(),
            [&](std::size_t begin, std::size_t end)
            {
                for (std::size_t t = begin; t < end; ++t)
                {
                    const auto [i, steps] = all[t];
                    for (std::size_t f = steps.first; f < steps.last; ++f) eliminate_one(i, f);
                    if (states[i].left.fetch_sub(1) > 1) continue;
                    for (const std::size_t f : solvers[i]->top_) eliminate_one(i, f);
                    solvers[i]->definite_ = states[i].definite;
                    then(i);
                }
            },
            0, 2);
    }

    /// Returns whether the last sum was positive definite, up to rounding: if not, directions without stiffness, or
    /// with a negative one, were left out.
    bool definite() const { return definite_; }

    /// b: one vector per vertex; the result is 0 at fixed vertices.
    std::vector<vec2> solve(std::span<const vec2> b) const;

private:
    static constexpr std::size_t panel = 4; // pivots that are eliminated together

    static std::size_t u(idx i) { return static_cast<std::size_t>(i); }

    struct range
    {
        std::size_t first, last;
    };
    template <class T>
    static std::span<const T> part(const std::vector<T>& all, range r)
    {
        return std::span(all).subspan(r.first, r.last - r.first);
    }

    /// A triangle as it enters a front: its corners by their places there, fixed ones first.
    struct own_cell
    {
        std::size_t cell;
        std::array<idx, 3> place; ///< or -1
        std::array<char, 3> corner;
    };

    /// Vertices of a child's border, one after the other there and in its parent.
    struct run
    {
        std::size_t first, count, place;
    };

    struct child
    {
        std::size_t step;
        range runs;
    };

    /// A front, of which the upper triangle counts. Of a pivot: its D, then L^T; below: what is left for its parent.
    struct step
    {
        std::size_t pivots, width; ///< unknowns, two per vertex
        range variables;           ///< pivots, then the border
        range children, own;       ///< own: triangles that enter with it
        std::size_t rows, rest;    ///< where those of pivots and those below begin
    };

    /// Row r of a front, from column 0 on; of those below the pivots only the columns after them are there.
    double* row(const step& s, std::size_t r) const;

    void order();

    /// The graph of the unknown vertices, without loops.
    void neighbours(std::vector<idx>& offset, std::vector<idx>& column) const;

    void set_places(const step& s, std::vector<idx>& place) const;

    /// Index ranges of the border of a child. place: by unknown vertex, in the parent.
    range runs_of(const step& s, const std::vector<idx>& place);

    void first_cells();

    /// Subtrees that threads eliminate, and what is above them.
    void share_out();

    /// Makes a front and eliminates its pivots; whether they were positive.
    template <class Entry>
    bool eliminate(const step& s, const Entry& entry, double relative_shift)
    {
        assemble(s, entry);
        bool positive = true;
        for (std::size_t first = 0; first < s.pivots; first += panel)
        {
            const std::size_t last = std::min(first + panel, s.pivots);
            for (std::size_t k = first; k < last; ++k)
            {
                double* pivot = row(s, k);
                pivot[k] *= 1 + relative_shift;
                if (!(pivot[k] > 0))
                {
                    std::fill(pivot + k, pivot + s.width, 0.0);
                    positive = false;
                }
                for (std::size_t i = k + 1; i < last; ++i)
                {
                    const double factor = pivot[k] > 0 ? pivot[i] / pivot[k] : 0.0;
                    double* below = row(s, i);
                    for (std::size_t j = i; j < s.width; ++j) below[j] -= factor * pivot[j];
                }
            }
            take_out(s, first, last);
            for (std::size_t k = first; k < last; ++k)
            {
                double* pivot = row(s, k);
                const double scale = pivot[k] > 0 ? 1 / pivot[k] : 0.0;
                for (std::size_t j = k + 1; j < s.width; ++j) pivot[j] *= scale;
            }
        }
        return positive;
    }

    template <class Entry>
    void assemble(const step& s, const Entry& entry)
    {
        // From an even column on, as take_out() goes by twos.
        for (std::size_t r = 0; r < s.width; ++r) std::fill(row(s, r) + r / 2 * 2, row(s, r) + s.width, 0.0);
        for (const own_cell& e : part(own_, s.own))
            for (std::size_t a = 0; a < 3; ++a)
                for (std::size_t b = a; b < 3 && e.place[a] >= 0; ++b)
                {
                    const auto i = static_cast<std::size_t>(2 * e.corner[a]),
                               j = static_cast<std::size_t>(2 * e.corner[b]);
                    const std::size_t r = 2 * u(e.place[a]), c = 2 * u(e.place[b]);
                    double *upper = row(s, r) + c, *lower = row(s, r + 1) + c;
                    upper[0] += entry(e.cell, i, j);
                    upper[1] += entry(e.cell, i, j + 1);
                    if (a != b) lower[0] += entry(e.cell, i + 1, j);
                    lower[1] += entry(e.cell, i + 1, j + 1);
                }
        for (const child& c : part(children_, s.children))
        {
            const auto runs = part(runs_, c.runs);
            for (std::size_t k = 0; k < runs.size(); ++k)
                for (std::size_t i = 0; i < runs[k].count; ++i) add_rows(s, steps_[c.step], runs.subspan(k), i);
        }
    }

    /// Adds the two rows of a child at the vertex i of the first of the runs, from there on.
    void add_rows(const step& s, const step& from, std::span<const run> runs, std::size_t i);

    /// Adds n numbers, an even number, each to two rows.
    static void add(const double* x, const double* y, std::size_t n, double* to_x, double* to_y);

    /// Takes the pivots [first, last), at most a panel, out of the rows below them. All in one pass over a row, two
    /// rows and columns at a time: what is loaded is used as often as registers allow, in vector instructions.
    void take_out(const step& s, std::size_t first, std::size_t last);

    std::span<const std::array<idx, 3>> cells_;
    std::vector<idx> slot_;    // of a vertex among the unknown ones, or -1
    std::vector<idx> unknown_; // their vertices
    std::vector<step> steps_;
    std::vector<idx> variables_;
    std::vector<child> children_;
    std::vector<run> runs_;
    std::vector<own_cell> own_;
    std::unique_ptr<double[]> values_;
    std::vector<range> tasks_; // of steps
    std::vector<std::size_t> top_;
    bool definite_ = true;
};

} // namespace taut::impl
