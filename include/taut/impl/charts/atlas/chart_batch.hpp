// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <taut/impl/charts/atlas/chart_start.hpp>
#include <taut/impl/charts/atlas/panel_order.hpp>
#include <taut/impl/core/compute/host/programs.hpp>
#include <taut/impl/core/compute/kernel.hpp>
#include <taut/impl/core/compute/kernels/charts.hpp>
#include <taut/impl/core/compute/quirks.hpp>
#include <taut/impl/core/core/counting_sort.hpp>
#include <taut/impl/core/objective/element_hessian.hpp>
#include <taut/impl/core/objective/element_kernels.hpp>

namespace taut::impl
{

/// Data of one chart on the device: triangles, vertices in band order, profile of its Hessian, and its map.
struct chart_problem
{
    const ideal_elements<triangle>* ideal = nullptr;
    std::vector<std::array<idx, 3>> cells; ///< renumbered
    std::vector<idx> order;                ///< the vertex of the chart, one per vertex here
    csr fans;                              ///< corners of each vertex
    std::vector<idx> heights;              ///< heights of panels
    std::vector<vec2> uv;                  ///< in this order

    /// ideal: of m, referred to.
    static chart_problem of(const mesh<triangle>& m, const ideal_elements<triangle>& ideal, panel_profile profile,
                            const std::vector<vec2>& start)
    {
        chart_problem p;
        p.ideal = &ideal;
        p.cells = m.cells();
        p.uv = profile.order.apply(start);
        for (auto& t : p.cells)
            for (idx& v : t) v = profile.order.old_to_new[static_cast<std::size_t>(v)];
        p.order = std::move(profile.order.new_to_old);
        p.heights = std::move(profile.heights);
        p.fans.items.resize(3 * p.cells.size());
        p.fans.offsets = counting_sort(
            p.fans.items.size(), p.order.size(), [&](std::size_t corner) { return p.cells[corner / 3][corner % 3]; },
            [&](std::size_t corner, std::size_t at) { p.fans.items[at] = static_cast<idx>(corner); });
        return p;
    }
};

/// Kernel of kernels/charts.cl, in the precision and form of a device.
class chart_kernel
{
public:
    explicit chart_kernel(queue& q)
        : type(q.device().has_fp64() ? scalar_type::f64 : scalar_type::f32),
          team(quirks::wants_serial_items(q.device()) ? 1 : 64),
          newton_(make_kernel(q, program(type, team, part_form_for(q.device())), "chart_newton"))
    {
    }

    const kernel& newton() const { return newton_; }

    const scalar_type type;
    const int team; ///< work-items of a chart

private:
    static own_program program(scalar_type type, int team, kernel_form part)
    {
        using elements = element_kernels<triangle>;
        const any_energy energy = default_energy();
        const real_types types{type, type};
        return {.text = kernels::charts,
                .host = host_charts,
                .settings = {{"REAL", spelling(type)},
                             {"TEAM", team},
                             {"EPSILON", type == scalar_type::f64 ? "1e-11" : "1e-5f"}},
                .real = type,
                .parts = {elements::record_gradient(energy, types, part),
                          elements::record_first_flips(energy, types, part),
                          elements::record_along(energy, types, part),
                          element_hessian_kernel<triangle>::record(energy, types, part)}};
    }

    kernel newton_;
};

/// Batch of charts on a device, with Newton's method on all of them at once.
class chart_batch
{
public:
    /// State of a chart after a step, as written by the kernel.
    enum state : idx
    {
        going,
        converged,
        stuck
    };

    chart_batch(queue& q, const chart_kernel& program, std::span<const chart_problem> problems)
        : program_(program),
          problems_(problems),
          lists_(problems, program.team),
          arrays_(q, program.type, lists_),
          active_(q, lists_.dealt),
          states_(problems.size(), going),
          numbers_(4 * problems.size()),
          remaining_(lists_.dealt)
    {
    }

    /// Makes one step of every active chart, and waits. Finished charts become inactive. Returns the number of active
    /// ones.
    std::size_t step(double tolerance)
    {
        const auto group = static_cast<std::size_t>(program_.team);
        program_.newton()({group * remaining_.size(), group}, {{"active", active_},
                                                               {"layout", arrays_.layout},
                                                               {"corners", arrays_.corners},
                                                               {"inverse", arrays_.inverse},
                                                               {"measure", arrays_.measure},
                                                               {"weight", arrays_.weight},
                                                               {"fan_starts", arrays_.fan_starts},
                                                               {"fans", arrays_.fans},
                                                               {"offsets", arrays_.offsets},
                                                               {"heights", arrays_.heights},
                                                               {"tolerance", tolerance},
                                                               {"one", arrays_.one},
                                                               {"x", arrays_.x},
                                                               {"before", arrays_.before},
                                                               {"d", arrays_.d},
                                                               {"rhs", arrays_.rhs},
                                                               {"energies", arrays_.energies},
                                                               {"gradient", arrays_.gradient},
                                                               {"hessian", arrays_.hessian},
                                                               {"A", arrays_.A},
                                                               {"values", arrays_.values},
                                                               {"states", arrays_.states}});
        arrays_.states.download(std::span(states_));
        arrays_.values.download(std::span(numbers_));
        std::erase_if(remaining_, [this](idx k) { return states_[static_cast<std::size_t>(k)] != going; });
        if (!remaining_.empty()) active_.upload(remaining_);
        return remaining_.size();
    }

    state state_of(std::size_t k) const { return static_cast<state>(states_[k]); }

    /// Energies before the last step, area means.
    double energy(std::size_t k) const { return numbers_[4 * k]; }

    /// Maps, one point per vertex in the order of the chart, in its units.
    std::vector<std::vector<vec2>> maps() const
    {
        const std::vector<double> x = arrays_.x.download();
        std::vector<std::vector<vec2>> result;
        for (std::size_t k = 0; k < problems_.size(); ++k)
        {
            const auto& order = problems_[k].order;
            const auto base = 2 * static_cast<std::size_t>(lists_.layout[4 * k + 1]);
            const std::size_t stride = padded(order.size(), 2);
            auto& uv = result.emplace_back(order.size());
            for (std::size_t i = 0; i < order.size(); ++i)
                uv[static_cast<std::size_t>(order[i])] = {x[base + i], x[base + stride + i]};
        }
        return result;
    }

private:
    static constexpr std::size_t stride_of(std::size_t cells) { return padded(cells, 8) + 4; }

    /// Makes arrays in the layout of kernels/charts.cl.
    struct host_lists
    {
        std::vector<idx> layout, corners, fan_starts, fans, offsets, heights, dealt;
        std::vector<double> inverse, measure, weight, x;
        std::size_t cells = 0, entries = 0;

        host_lists(std::span<const chart_problem> problems, int team)
        {
            for (const chart_problem& p : problems) add(p);
            deal(problems, team);
        }

    private:
        void add(const chart_problem& p)
        {
            const std::size_t n = p.cells.size(), stride = stride_of(n);
            const std::size_t vertices = padded(p.order.size(), 2), base = x.size() / 2;
            for (const std::size_t number : {cells, base, n, p.order.size()})
                layout.push_back(static_cast<idx>(number));

            corners.resize(3 * (cells + stride));
            inverse.resize(3 * (cells + stride));
            measure.resize(cells + stride);
            weight.resize(cells + stride);
            const auto& ideal = *p.ideal;
            double total = 0;
            for (const double a : ideal.measure) total += a;
            for (std::size_t c = 0; c < n; ++c)
            {
                const std::size_t at = 3 * cells + c;
                for (std::size_t k = 0; k < 3; ++k) corners[at + k * stride] = p.cells[c][k];
                const mat2& W = ideal.inverse[c];
                inverse[at] = W[0][0];
                inverse[at + stride] = W[1][0];
                inverse[at + 2 * stride] = W[1][1];
                measure[cells + c] = ideal.measure[c];
                weight[cells + c] = ideal.measure[c] / total;
            }
            cells += stride;

            // Starts of fans count from the beginning of all.
            const auto first = static_cast<idx>(fans.size());
            for (const idx start : p.fans.offsets) fan_starts.push_back(first + start);
            if (vertices > p.order.size()) fan_starts.push_back(fan_starts.back());
            fans.insert(fans.end(), p.fans.items.begin(), p.fans.items.end());
            for (const idx height : p.heights)
            {
                offsets.push_back(static_cast<idx>(entries));
                entries += 4 * static_cast<std::size_t>(height);
            }
            heights.insert(heights.end(), p.heights.begin(), p.heights.end());
            x.resize(x.size() + 2 * vertices);
            for (std::size_t i = 0; i < p.uv.size(); ++i)
            {
                x[2 * base + i] = p.uv[i].x;
                x[2 * base + vertices + i] = p.uv[i].y;
            }
        }

        /// Order of charts: drivers give a CPU's threads long pieces of the range, so large charts are spread over it;
        /// on GPUs they come first.
        void deal(std::span<const chart_problem> problems, int team)
        {
            std::vector<idx> by_work(problems.size());
            for (std::size_t k = 0; k < by_work.size(); ++k) by_work[k] = static_cast<idx>(k);
            std::stable_sort(by_work.begin(), by_work.end(),
                             [&](idx a, idx b) {
                                 return problems[static_cast<std::size_t>(a)].cells.size() >
                                        problems[static_cast<std::size_t>(b)].cells.size();
                             });
            const std::size_t piles = team == 1 ? 64 : 1;
            for (std::size_t pile = 0; pile < piles; ++pile)
                for (std::size_t k = pile; k < by_work.size(); k += piles) dealt.push_back(by_work[k]);
        }
    };

    struct device_arrays
    {
        buffer<idx> layout, corners, fan_starts, fans, offsets, heights, states;
        real_buffer inverse, measure, weight, one, x, before, d, rhs, energies, gradient, hessian, A, values;

        device_arrays(queue& q, scalar_type type, const host_lists& l)
            : layout(q, l.layout),
              corners(q, l.corners),
              fan_starts(q, l.fan_starts),
              fans(q, l.fans),
              offsets(q, l.offsets),
              heights(q, l.heights),
              states(q, l.layout.size() / 4),
              inverse(q, type, l.inverse),
              measure(q, type, l.measure),
              weight(q, type, l.weight),
              one(q, type, 1),
              x(q, type, l.x),
              before(q, type, l.x),
              d(q, type, l.x.size()),
              rhs(q, type, l.x.size()),
              energies(q, type, 4 * l.cells),
              gradient(q, type, 6 * l.cells),
              hessian(q, type, hessian_slots<2>::count * l.cells),
              A(q, type, l.entries),
              values(q, type, l.layout.size())
        {
            states.fill(going);
            one.fill(1);
            values.fill(1); // the first step is made with a projected Hessian
        }
    };

    const chart_kernel& program_;
    std::span<const chart_problem> problems_;
    host_lists lists_;
    device_arrays arrays_;
    buffer<idx> active_;
    std::vector<idx> states_;
    std::vector<double> numbers_;
    std::vector<idx> remaining_;
};

} // namespace taut::impl
