// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <atomic>
#include <cstddef>
#include <functional>
#include <memory>
#include <numeric>
#include <span>
#include <tuple>
#include <utility>
#include <vector>

#include <taut/impl/core/parallel.hpp>
#include <taut/impl/core/types.hpp>
#include <taut/impl/sparse/elimination_tree.hpp>

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

    /// Factorizes the sum of blocks + relative_shift * its diagonal; one block per triangle. proceed, if given, is
    /// asked between fronts; once it says no, there are no factors and the answer is false.
    bool factorize(std::span<const block> blocks, double relative_shift, const std::function<bool()>& proceed = {})
    {
        const auto entry = [blocks](std::size_t cell, std::size_t r, std::size_t c) { return blocks[cell][r][c]; };
        std::vector<char> positive(tasks_.size() + 1, 1);
        if (proceed && !proceed()) return false;
        parallel_for(
            tasks_.size(),
            [&](std::size_t begin, std::size_t end)
            {
                for (std::size_t t = begin; t < end; ++t)
                    for (std::size_t f = tasks_[t].first; f < tasks_[t].last; ++f)
                        positive[t] &= eliminate(steps_[f], entry, relative_shift);
            },
            0, 2);
        for (const std::size_t f : top_)
        {
            if (proceed && !proceed()) return false;
            positive.back() &= eliminate(steps_[f], entry, relative_shift);
        }
        definite_ = std::find(positive.begin(), positive.end(), 0) == positive.end();
        return true;
    }

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
    std::vector<vec2> solve(std::span<const vec2> b) const
    {
        std::vector<double> x(2 * unknown_.size());
        for (std::size_t i = 0; i < unknown_.size(); ++i)
            for (std::size_t k = 0; k < 2; ++k) x[2 * i + k] = b[u(unknown_[i])][static_cast<int>(k)];
        const auto at = [this](const step& f, std::size_t r)
        { return 2 * u(variables_[f.variables.first + r / 2]) + r % 2; };
        for (const step& f : steps_)
            for (std::size_t r = 0; r < f.pivots; ++r)
            {
                const double* pivot_row = row(f, r);
                const double pivot = x[at(f, r)];
                for (std::size_t c = r + 1; c < f.width; ++c) x[at(f, c)] -= pivot_row[c] * pivot;
            }
        for (auto f = steps_.rbegin(); f != steps_.rend(); ++f)
            for (std::size_t r = f->pivots; r-- > 0;)
            {
                const double* pivot_row = row(*f, r);
                double sum = pivot_row[r] > 0 ? x[at(*f, r)] / pivot_row[r] : 0.0;
                for (std::size_t c = r + 1; c < f->width; ++c) sum -= pivot_row[c] * x[at(*f, c)];
                x[at(*f, r)] = sum;
            }
        std::vector<vec2> result(slot_.size(), vec2(0.0));
        for (std::size_t i = 0; i < unknown_.size(); ++i) result[u(unknown_[i])] = {x[2 * i], x[2 * i + 1]};
        return result;
    }

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
    double* row(const step& s, std::size_t r) const
    {
        if (r < s.pivots) return values_.get() + s.rows + r * s.width;
        return values_.get() + s.rest + (r - s.pivots) * (s.width - s.pivots) - s.pivots;
    }

    void order()
    {
        std::vector<idx> offset{0}, column;
        neighbours(offset, column);
        const elimination_tree tree(offset, column);
        std::vector<idx> place(unknown_.size());
        std::size_t values = 0;
        for (const auto& f : tree.fronts())
        {
            step s{};
            s.pivots = 2 * f.pivots.size();
            s.width = s.pivots + 2 * f.border.size();
            s.variables = {variables_.size(), variables_.size() + s.width / 2};
            variables_.insert(variables_.end(), f.pivots.begin(), f.pivots.end());
            variables_.insert(variables_.end(), f.border.begin(), f.border.end());
            set_places(s, place);
            s.children.first = children_.size();
            for (const idx c : f.children) children_.push_back({u(c), runs_of(steps_[u(c)], place)});
            s.children.last = children_.size();
            s.rows = values;
            s.rest = values += s.pivots * s.width;
            values += (s.width - s.pivots) * (s.width - s.pivots);
            steps_.push_back(s);
        }
        values_ = std::make_unique_for_overwrite<double[]>(values);
    }

    /// The graph of the unknown vertices, without loops.
    void neighbours(std::vector<idx>& offset, std::vector<idx>& column) const
    {
        std::vector<idx> first(unknown_.size() + 1, 0);
        const auto each = [this](const auto& visit)
        {
            for (const auto& t : cells_)
                for (const idx v : t)
                    for (const idx w : t)
                        if (v != w && slot_[u(v)] >= 0 && slot_[u(w)] >= 0) visit(u(slot_[u(v)]), slot_[u(w)]);
        };
        each([&](std::size_t i, idx) { ++first[i + 1]; });
        std::partial_sum(first.begin(), first.end(), first.begin());
        std::vector<idx> all(u(first.back())), next(first);
        each([&](std::size_t i, idx j) { all[u(next[i]++)] = j; });
        for (std::size_t i = 0; i < unknown_.size(); ++i)
        {
            const auto begin = all.begin() + first[i], end = all.begin() + first[i + 1];
            std::sort(begin, end);
            column.insert(column.end(), begin, std::unique(begin, end));
            offset.push_back(static_cast<idx>(column.size()));
        }
    }

    void set_places(const step& s, std::vector<idx>& place) const
    {
        idx next = 0;
        for (const idx i : part(variables_, s.variables)) place[u(i)] = next++;
    }

    /// Index ranges of the border of a child. place: by unknown vertex, in the parent.
    range runs_of(const step& s, const std::vector<idx>& place)
    {
        const range all{runs_.size(), 0};
        const auto border = part(variables_, s.variables).subspan(s.pivots / 2);
        for (std::size_t k = 0; k < border.size(); ++k)
        {
            const std::size_t there = u(place[u(border[k])]);
            if (k > 0 && runs_.back().place + runs_.back().count == there)
                ++runs_.back().count;
            else
                runs_.push_back({k, 1, there});
        }
        return {all.first, runs_.size()};
    }

    void first_cells()
    {
        std::vector<std::size_t> step_of(unknown_.size());
        for (std::size_t f = 0; f < steps_.size(); ++f)
            for (const idx i : part(variables_, steps_[f].variables).first(steps_[f].pivots / 2)) step_of[u(i)] = f;
        std::vector<std::size_t> first(cells_.size(), steps_.size());
        std::vector<std::size_t> next(steps_.size() + 1, 0);
        for (std::size_t c = 0; c < cells_.size(); ++c)
        {
            for (const idx v : cells_[c])
                if (slot_[u(v)] >= 0) first[c] = std::min(first[c], step_of[u(slot_[u(v)])]);
            if (first[c] < steps_.size()) ++next[first[c] + 1];
        }
        std::partial_sum(next.begin(), next.end(), next.begin());
        own_.resize(next.back());
        for (std::size_t f = 0; f < steps_.size(); ++f) steps_[f].own = {next[f], next[f + 1]};
        for (std::size_t c = 0; c < cells_.size(); ++c)
            if (first[c] < steps_.size()) own_[next[first[c]]++] = {c, {}, {0, 1, 2}};

        std::vector<idx> place(unknown_.size(), -1);
        for (const step& s : steps_)
        {
            set_places(s, place);
            for (std::size_t i = s.own.first; i < s.own.last; ++i)
            {
                own_cell& e = own_[i];
                std::array<std::pair<idx, char>, 3> sorted;
                for (std::size_t k = 0; k < 3; ++k)
                {
                    const idx slot = slot_[u(cells_[e.cell][k])];
                    sorted[k] = {slot < 0 ? idx(-1) : place[u(slot)], static_cast<char>(k)};
                }
                std::sort(sorted.begin(), sorted.end());
                for (std::size_t k = 0; k < 3; ++k) std::tie(e.place[k], e.corner[k]) = sorted[k];
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
            const double width = double(steps_[f].width), own = width * width * double(2 + steps_[f].pivots) / 2;
            work[f] = own;
            total += own;
            first[f] = f;
            for (const child& c : part(children_, steps_[f].children))
            {
                work[f] += work[c.step];
                first[f] = std::min(first[f], first[c.step]);
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
    void add_rows(const step& s, const step& from, std::span<const run> runs, std::size_t i)
    {
        const std::size_t r = 2 * (runs[0].place + i), c = from.pivots + 2 * (runs[0].first + i);
        const double *x = row(from, c), *y = row(from, c + 1);
        double *upper = row(s, r), *lower = row(s, r + 1);
        upper[r] += x[c];
        upper[r + 1] += x[c + 1];
        lower[r + 1] += y[c + 1];
        add(x + c + 2, y + c + 2, 2 * (runs[0].count - i - 1), upper + r + 2, lower + r + 2);
        for (const run& other : runs.subspan(1))
        {
            const std::size_t at = 2 * other.place, there = from.pivots + 2 * other.first;
            if (at > r)
            {
                add(x + there, y + there, 2 * other.count, upper + at, lower + at);
                continue;
            }
            for (std::size_t k = 0; k < 2 * other.count; ++k)
            {
                double* transposed = row(s, at + k) + r;
                transposed[0] += x[there + k];
                transposed[1] += y[there + k];
            }
        }
    }

    /// Adds n numbers, an even number, each to two rows.
    static void add(const double* x, const double* y, std::size_t n, double* to_x, double* to_y)
    {
        for (std::size_t j = 0; j < n; j += 2) // two at once, which compilers make vector instructions of
        {
            const double x0 = to_x[j] + x[j], x1 = to_x[j + 1] + x[j + 1];
            const double y0 = to_y[j] + y[j], y1 = to_y[j + 1] + y[j + 1];
            to_x[j] = x0, to_x[j + 1] = x1;
            to_y[j] = y0, to_y[j + 1] = y1;
        }
    }

    /// Takes the pivots [first, last), at most a panel, out of the rows below them. All in one pass over a row, two
    /// rows and columns at a time: what is loaded is used as often as registers allow, in vector instructions.
    void take_out(const step& s, std::size_t first, std::size_t last)
    {
        const std::size_t n = s.width, count = last - first;
        std::array<const double*, panel> p{};
        std::array<double, panel> scale{};
        for (std::size_t k = 0; k < panel; ++k) // the last panel may be short: repeats a row with factor 0
        {
            p[k] = row(s, first + std::min(k, count - 1));
            scale[k] = k < count && p[k][first + k] > 0 ? 1 / p[k][first + k] : 0.0;
        }
        const double *p0 = p[0], *p1 = p[1], *p2 = p[2], *p3 = p[3];
        for (std::size_t i = last; i < n; i += 2)
        {
            const std::size_t l = i + 1;
            const std::array<double, panel> f{p0[i] * scale[0], p1[i] * scale[1], p2[i] * scale[2], p3[i] * scale[3]},
                g{p0[l] * scale[0], p1[l] * scale[1], p2[l] * scale[2], p3[l] * scale[3]};
            double *upper = row(s, i), *lower = row(s, l);
            for (std::size_t j = i; j < n; j += 2)
            {
                const double x0 = upper[j] - ((f[0] * p0[j] + f[1] * p1[j]) + (f[2] * p2[j] + f[3] * p3[j]));
                const double x1 =
                    upper[j + 1] - ((f[0] * p0[j + 1] + f[1] * p1[j + 1]) + (f[2] * p2[j + 1] + f[3] * p3[j + 1]));
                const double y0 = lower[j] - ((g[0] * p0[j] + g[1] * p1[j]) + (g[2] * p2[j] + g[3] * p3[j]));
                const double y1 =
                    lower[j + 1] - ((g[0] * p0[j + 1] + g[1] * p1[j + 1]) + (g[2] * p2[j + 1] + g[3] * p3[j + 1]));
                upper[j] = x0, upper[j + 1] = x1;
                lower[j] = y0, lower[j + 1] = y1;
            }
        }
    }

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
