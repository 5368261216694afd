// SPDX-License-Identifier: MIT
#pragma once

#include <numeric>
#include <tuple>
#include <utility>

#include <taut/impl/core/sparse/front_cholesky.hpp>

namespace taut::impl
{

front_cholesky::front_cholesky(std::span<const std::array<idx, 3>> cells, std::span<const char> fixed)
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

bool front_cholesky::factorize(std::span<const block> blocks, double relative_shift,
                               const std::function<bool()>& proceed)
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

std::vector<vec2> front_cholesky::solve(std::span<const vec2> b) const
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

double* front_cholesky::row(const step& s, std::size_t r) const
{
    if (r < s.pivots) return values_.get() + s.rows + r * s.width;
    return values_.get() + s.rest + (r - s.pivots) * (s.width - s.pivots) - s.pivots;
}

void front_cholesky::order()
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

void front_cholesky::neighbours(std::vector<idx>& offset, std::vector<idx>& column) const
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

void front_cholesky::set_places(const step& s, std::vector<idx>& place) const
{
    idx next = 0;
    for (const idx i : part(variables_, s.variables)) place[u(i)] = next++;
}

front_cholesky::range front_cholesky::runs_of(const step& s, const std::vector<idx>& place)
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

void front_cholesky::first_cells()
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

void front_cholesky::share_out()
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

void front_cholesky::add_rows(const step& s, const step& from, std::span<const run> runs, std::size_t i)
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

void front_cholesky::add(const double* x, const double* y, std::size_t n, double* to_x, double* to_y)
{
    for (std::size_t j = 0; j < n; j += 2) // two at once, which compilers make vector instructions of
    {
        const double x0 = to_x[j] + x[j], x1 = to_x[j + 1] + x[j + 1];
        const double y0 = to_y[j] + y[j], y1 = to_y[j + 1] + y[j + 1];
        to_x[j] = x0, to_x[j + 1] = x1;
        to_y[j] = y0, to_y[j + 1] = y1;
    }
}

void front_cholesky::take_out(const step& s, std::size_t first, std::size_t last)
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

} // namespace taut::impl
