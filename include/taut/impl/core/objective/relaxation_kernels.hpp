// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <limits>
#include <vector>

#include <taut/impl/core/compute/record.hpp>
#include <taut/impl/core/objective/newton_step.hpp>
#include <taut/impl/core/objective/traced_element.hpp>
#include <taut/symbolic.hpp>

namespace taut::impl
{

/// Kernels of vertex relaxation for one energy, traced once and good for any number of meshes. Lists are those of
/// relaxation_schedule.hpp, of which each launch takes one colour; numbers of entries and rows lie by slots, `stride`
/// apart, from the colour's first.
///
/// Elements of a star are work-items of their own, and the sums over a star are another launch: loops over loads only,
/// beside element formulas that vectorise.
template <class Element>
struct relaxation_kernels
{
    static constexpr int D = Element::dimension;

    /// Multiples of Newton's step that are tried. Near a barrier such as 1/det^2 Newton's step multiplies the distance
    /// to it by 4/3 only: the long ones relax a sliver in a few sweeps.
    static constexpr std::array<double, 8> step_lengths = {64, 32, 16, 8, 4, 2, 1, 0.25};
    /// Damping of Newton's step. Across a sliver the energy is many orders stiffer than along it; undamped, the way
    /// along it is long and spoils the long multiples, and slivers take three times as many sweeps
    /// (docs/explanation/numerics.md).
    static constexpr double damping = 1e-2;
    static constexpr int trials = static_cast<int>(step_lengths.size());

    /// Numbers per entry: value, gradient and upper triangle of the Hessian by the vertex.
    static constexpr int term_count = 1 + D + D * (D + 1) / 2;
    /// Numbers per row: Newton's step, and the value of the star.
    static constexpr int step_count = D + 1;

    /// element_inputs -> "minus_density" of each cell: the worst is the minimum
    recorded_kernel densities;

    // The others take "lists", and where a launch finds its part in them (colour_part).

    /// element_inputs -> "terms"; one work-item per entry
    recorded_kernel terms;

    /// "terms" -> "steps"; one work-item per row
    recorded_kernel steps;

    /// element_inputs, "steps", "entries" -> "values"; one work-item per entry and step length
    recorded_kernel tries;

    /// "steps", "values", "x", "vertex_stride": a row's vertex goes to its best trial, if that is better than to stay;
    /// one work-item per row
    recorded_kernel moves;

    double rest; ///< density of the identity

    relaxation_kernels(const queue& q, const any_energy& energy, const real_types& types)
        : relaxation_kernels(traced_program(q, record(energy, types, impl::form_for(q.device())),
                                            record_common(types, impl::form_for(q.device()))),
                             energy)
    {
    }

    /// Takes the kernels from a program with the texts of record() and record_common() for this energy.
    relaxation_kernels(const traced_program& p, const any_energy& energy)
        : densities(p, "relaxation_densities"),
          terms(p, "relaxation_terms"),
          steps(p, "relaxation_steps"),
          tries(p, "relaxation_tries"),
          moves(p, "relaxation_moves"),
          rest(energy(element<double, D>{mat<D>(1.0), 1.0, 1.0}))
    {
    }

    /// Texts of the kernels, for a shared program.
    static std::vector<kernel_text> record(const any_energy& energy, const real_types& types, kernel_form form)
    {
        return {record_densities(energy, types, form), record_terms(energy, types, form),
                record_tries(energy, types, form)};
    }
    /// Texts of the kernels that are the same for all energies.
    static std::vector<kernel_text> record_common(const real_types& types, kernel_form form)
    {
        return {record_steps(types, form), record_moves(types, form)};
    }

    static kernel_text record_densities(const any_energy& energy, const real_types& types, kernel_form form)
    {
        recording r(types.vector);
        const element_inputs in(r, types, energy);
        auto density = r.out<double>("minus_density", types.vector);
        const auto cell = r.global_id();
        const traced e(in, cell, types.position, types.vector);
        const auto S = e.shape_matrix();
        density[cell] = -e.weighted(energy, S, 1.0);
        return r.finish("relaxation_densities", form, formulas);
    }

    static kernel_text record_terms(const any_energy& energy, const real_types& types, kernel_form form)
    {
        recording r(types.vector);
        const element_inputs in(r, types, energy);
        auto terms = r.out<double>("terms", types.vector);
        const colour_part part(r);
        const star_corner at(r.global_id(), in, part, types);

        const auto S =
            at.cell.shape_matrix(at.edges(in, [&](int i) { return in.x[at.vertex + i * in.vertex_stride]; }));
        const real value = at.cell.weight() * at.cell.density(energy, S);

        // A move of the vertex by t changes S by t q', where q is the gradient of its basis function.
        std::vector<real> entries;
        for (int c = 0; c < D; ++c)
            for (int i = 0; i < D; ++i) entries.push_back(S[c][i]);
        const auto along = [&](const std::vector<real>& by_entry, int i)
        {
            real sum = by_entry[static_cast<std::size_t>(i)] * at.q[0];
            for (int c = 1; c < D; ++c)
                sum = sum + by_entry[static_cast<std::size_t>(c * D + i)] * at.q[static_cast<std::size_t>(c)];
            return sum;
        };
        const auto gradient = differentiate(value, entries);
        int slot = 0;
        const auto put = [&](real term) { terms[at.entry + slot++ * part.stride] = term; };
        put(at.cell.weighted(energy, S));
        std::vector<real> g;
        for (int i = 0; i < D; ++i) put(g.emplace_back(along(gradient, i)));
        for (int j = 0; j < D; ++j)
        {
            const auto row = differentiate(g[static_cast<std::size_t>(j)], entries);
            for (int i = 0; i <= j; ++i) put(along(row, i));
        }
        return r.finish("relaxation_terms", form, formulas);
    }

    static kernel_text record_steps(const real_types& types, kernel_form form)
    {
        recording r(types.vector);
        const auto terms = r.in<double>("terms", types.vector);
        auto steps = r.out<double>("steps", types.vector);
        const colour_part part(r);
        const auto row = r.global_id();

        int slot = 0;
        const auto sum = [&] { return part.sum_of_row(row, terms, slot++); };
        steps[row + D * part.stride] = sum();
        std::array<real, static_cast<std::size_t>(D)> g;
        for (auto& entry : g) entry = sum();
        symmetric_matrix<real, D> H;
        for (int j = 0; j < D; ++j)
            for (int i = 0; i <= j; ++i) H(i, j) = sum();
        const auto d = newton_step<D>(H, g, damping, types.vector);
        for (int i = 0; i < D; ++i) steps[row + i * part.stride] = d[static_cast<std::size_t>(i)];
        return r.finish("relaxation_steps", form, kernel_use::seldom);
    }

    static kernel_text record_tries(const any_energy& energy, const real_types& types, kernel_form form)
    {
        recording r(types.vector);
        const element_inputs in(r, types, energy);
        const auto steps = r.in<double>("steps", types.vector);
        auto values = r.out<double>("values", types.vector);
        const auto entries = r.scalar<idx>("entries");
        const colour_part part(r);
        const auto item = r.global_id(), trial = item / entries;
        const star_corner at(item % entries, in, part, types);
        real a = length(trials - 1);
        for (int t = trials - 2; t >= 0; --t) a = select(trial <= t, length(t), a);
        const auto moved = [&](int i)
        { return moved_coordinate(in.x[at.vertex + i * in.vertex_stride], a, steps[at.row + i * part.stride], types); };
        const auto S = at.cell.shape_matrix(at.edges(in, moved));
        values[at.entry + trial * part.stride] = at.cell.weighted(energy, S);
        return r.finish("relaxation_tries", form);
    }

    static kernel_text record_moves(const real_types& types, kernel_form form)
    {
        recording r(types.vector);
        const auto steps = r.in<double>("steps", types.vector), values = r.in<double>("values", types.vector);
        auto x = r.inout<double>("x", types.position);
        const auto vertex_stride = r.scalar<idx>("vertex_stride");
        const colour_part part(r);
        const auto row = r.global_id();

        // Less by more than rounding; NaN and infinity are never less.
        const double epsilon = types.vector == scalar_type::f64 ? std::numeric_limits<double>::epsilon()
                                                                : std::numeric_limits<float>::epsilon();
        const real stay = steps[row + D * part.stride];
        real best = stay - 16.0 * epsilon * abs(stay), a = 0.0;
        for (int t = 0; t < trials; ++t)
        {
            const real value = part.sum_of_row(row, values, t);
            a = select(value < best, length(t), a);
            best = select(value < best, value, best);
        }
        const auto vertex = part.lists[row + part.first_row];
        for (int i = 0; i < D; ++i)
        {
            const auto coordinate = x[vertex + i * vertex_stride];
            const real from = coordinate;
            coordinate = select(a > 0.0, moved_coordinate(from, a, steps[row + i * part.stride], types), from);
        }
        return r.finish("relaxation_moves", form, kernel_use::seldom);
    }

private:
    using traced = traced_element<D>;
    using real = typename traced::real;

    /// Trials, eight for each entry, are worth optimising; in space, where formulas are long, the others are, too.
    static constexpr kernel_use formulas = D == 2 ? kernel_use::seldom : kernel_use::often;

    static real length(int t) { return step_lengths[static_cast<std::size_t>(t)]; }

    /// Trial position, computed alike for the trial and for the move, so that they agree bit for bit.
    static real moved_coordinate(real from, real a, real step, const real_types& types)
    {
        return from + cast(types.position, a * step);
    }

    /// The part of the lists that a launch has. Entries and rows count from its beginning.
    struct colour_part
    {
        explicit colour_part(recording& r)
            : lists(r.in<idx>("lists")),
              first_entry(r.scalar<idx>("first_entry")),
              first_row(r.scalar<idx>("first_row")),
              list_stride(r.scalar<idx>("list_stride")),
              stride(r.scalar<idx>("stride"))
        {
        }

        real sum_of_row(sym<idx> row, const recording::in_array<double>& numbers, int slot) const
        {
            const auto offset = row + first_row + list_stride;
            const auto base = slot * stride - first_entry;
            return sum_over(lists[offset], lists[offset + 1], [&](sym<idx> entry) { return numbers[entry + base]; });
        }

        recording::in_array<idx> lists;
        sym<idx> first_entry, first_row, list_stride, stride;
    };

    /// Element at the vertex of a row, whose corner is determined on the device.
    struct star_corner
    {
        sym<idx> entry, row, number, vertex;
        std::array<sym<idx>, static_cast<std::size_t>(D) + 1> corners;
        traced cell;
        std::array<real, static_cast<std::size_t>(D)> q; ///< gradient of the vertex' basis function

        star_corner(sym<idx> entry_of_part, const element_inputs& in, const colour_part& part, const real_types& types)
            : entry(entry_of_part),
              row(part.lists[entry + part.first_entry + 3 * part.list_stride] - part.first_row),
              number(part.lists[entry + part.first_entry + 2 * part.list_stride]),
              vertex(part.lists[row + part.first_row]),
              cell(in, number, types.position, types.vector)
        {
            for (int k = 0; k <= D; ++k) corners[static_cast<std::size_t>(k)] = in.corners[number + k * in.cell_stride];
            // Rows of W^-1 belong to corners 1..D; corner 0 has minus their sum.
            std::array<real, static_cast<std::size_t>(D)> sign;
            for (int k = 0; k < D; ++k) sign[static_cast<std::size_t>(k)] = here(k + 1) - here(0);
            for (int c = 0; c < D; ++c)
            {
                real sum = sign[0] * cell.inverse(0, c);
                for (int k = 1; k <= c; ++k) sum = sum + sign[static_cast<std::size_t>(k)] * cell.inverse(k, c);
                q[static_cast<std::size_t>(c)] = sum;
            }
        }

        /// 1 if corner k is the vertex, else 0.
        real here(int k) const { return select(is_here(k), real(1.0), real(0.0)); }
        sym_bool is_here(int k) const { return corners[static_cast<std::size_t>(k)] == vertex; }

        /// Edges as in traced_element, with coordinate i of the vertex at place(i).
        template <class Place>
        typename traced::matrix edges(const element_inputs& in, const Place& place) const
        {
            const auto coordinate = [&](int k, int i)
            { return select(is_here(k), place(i), in.x[corners[static_cast<std::size_t>(k)] + i * in.vertex_stride]); };
            typename traced::matrix A;
            for (int k = 0; k < D; ++k)
                for (int i = 0; i < D; ++i) A[k][i] = coordinate(k + 1, i) - coordinate(0, i);
            return A;
        }
    };
};

} // namespace taut::impl
