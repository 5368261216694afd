// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <limits>
#include <vector>

#include <taut/compute/record.hpp>
#include <taut/objective/newton_step.hpp>
#include <taut/objective/traced_element.hpp>
#include <taut/symbolic/loop.hpp>

namespace taut
{

/// The kernels of vertex relaxation for one energy, traced once and good for any number of meshes. Lists are those of
/// relaxation_schedule.hpp, of which each launch takes one colour; numbers of entries and rows lie by slots, `stride`
/// apart, from the colour's first.
///
/// Elements of a star are work-items of their own, and the sums over a star are another launch: loops over loads only,
/// beside element formulas that vectorise.
template <class Element, class P, class R>
struct relaxation_kernels
{
    static constexpr int D = Element::dimension;

    /// Multiples of Newton's step that are tried. Near a barrier such as 1/det^2 Newton's step multiplies the distance
    /// to it by 4/3 only: the long ones get a sliver away in a few sweeps.
    static constexpr std::array<double, 8> step_lengths = {64, 32, 16, 8, 4, 2, 1, 0.25};
    /// Of Newton's step. Across a sliver the energy is many orders stiffer than along it; undamped, the way along it is
    /// long and spoils the long multiples, and slivers take three times as many sweeps (docs/numerics.md).
    static constexpr double damping = 1e-2;
    static constexpr int trials = static_cast<int>(step_lengths.size());

    /// Numbers an entry: value, gradient and upper triangle of the Hessian by the vertex.
    static constexpr int term_count = 1 + D + D * (D + 1) / 2;
    /// Numbers a row: Newton's step, and the value of the star.
    static constexpr int step_count = D + 1;

    /// corners, W^-1, measure, x, cell_stride, vertex_stride -> minus the density of each cell: the worst is the
    /// minimum
    traced_kernel<in<idx>, in<R>, in<R>, in<P>, out<R>, uniform<idx>, uniform<idx>> densities;

    /// Where a launch finds its part: first entry and row, stride of the lists, stride of everything else.
    template <class... Tags>
    using star_kernel = traced_kernel<in<idx>, Tags..., uniform<idx>, uniform<idx>, uniform<idx>, uniform<idx>>;

    /// lists, x, corners, W^-1, measure, weight, strides of cells and vertices -> terms; one work-item an entry
    star_kernel<in<P>, in<idx>, in<R>, in<R>, in<R>, uniform<idx>, uniform<idx>, out<R>> terms;

    /// lists, terms -> steps; one work-item a row
    star_kernel<in<R>, out<R>> steps;

    /// lists, x, corners, W^-1, measure, weight, strides, steps -> value at each step length; one work-item an entry
    star_kernel<in<P>, in<idx>, in<R>, in<R>, in<R>, uniform<idx>, uniform<idx>, in<R>, out<R>> tries;

    /// lists, steps, values at the step lengths, x, vertex stride: a row's vertex goes to its best trial, if that is
    /// better than to stay; one work-item a row
    star_kernel<in<R>, in<R>, inout<P>, uniform<idx>> moves;

    double rest; ///< density of the identity

    relaxation_kernels(const queue& q, const any_energy& energy)
        : relaxation_kernels(traced_program(q, record(energy, detail::form_for(q.device()))), energy)
    {
    }

    /// From a program with all that record() gives for this energy.
    relaxation_kernels(const traced_program& p, const any_energy& energy)
        : densities(p, "relaxation_densities"),
          terms(p, "relaxation_terms"),
          steps(p, "relaxation_steps"),
          tries(p, "relaxation_tries"),
          moves(p, "relaxation_moves"),
          rest(energy(element<double, D>{mat<D>(1.0), 1.0, 1.0}))
    {
    }

    /// The kernels as text, for a program that others share.
    static std::vector<kernel_text> record(const any_energy& energy, kernel_form form)
    {
        return {record_densities(energy, form), record_terms(energy, form), record_steps(form),
                record_tries(energy, form), record_moves(form)};
    }

    static kernel_text record_densities(const any_energy& energy, kernel_form form)
    {
        recording r;
        const auto corners = r.in<idx>("corners");
        const auto inverse = r.in<R>("inverse"), measure = r.in<R>("measure");
        const auto x = r.in<P>("x");
        auto density = r.out<R>("minus_density");
        const auto cell_stride = r.scalar<idx>("cell_stride"), vertex_stride = r.scalar<idx>("vertex_stride");
        const auto cell = r.global_id();
        const typename traced::rest W(cell, inverse, cell_stride);
        const auto S = W.shape_matrix(traced::edges(cell, corners, x, cell_stride, vertex_stride));
        density[cell] = -traced::weighted(energy, S, measure[cell], real(1.0));
        return r.finish("relaxation_densities", form);
    }

    static kernel_text record_terms(const any_energy& energy, kernel_form form)
    {
        recording r;
        const entry_inputs in(r);
        auto terms = r.out<R>("terms");
        const colour_part part(r);
        const star_corner at(r.global_id(), in, part);

        const auto S = at.W.shape_matrix(at.edges(in, [&](int i) { return in.x[at.vertex + i * in.vertex_stride]; }));
        const real weight = in.weight[at.cell];
        const real value = weight * energy(element<real, D>{S, glm::determinant(S), in.measure[at.cell]});

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
        put(traced::weighted(energy, S, in.measure[at.cell], weight));
        std::vector<real> g;
        for (int i = 0; i < D; ++i) put(g.emplace_back(along(gradient, i)));
        for (int j = 0; j < D; ++j)
        {
            const auto row = differentiate(g[static_cast<std::size_t>(j)], entries);
            for (int i = 0; i <= j; ++i) put(along(row, i));
        }
        return r.finish("relaxation_terms", form);
    }

    static kernel_text record_steps(kernel_form form)
    {
        recording r;
        const auto lists = r.in<idx>("lists");
        const auto terms = r.in<R>("terms");
        auto steps = r.out<R>("steps");
        const colour_part part(r);
        const auto row = r.global_id();

        int slot = 0;
        const auto sum = [&] { return part.sum_of_row(lists, row, terms, slot++); };
        steps[row + D * part.stride] = sum();
        std::array<real, static_cast<std::size_t>(D)> g;
        for (auto& entry : g) entry = sum();
        symmetric_matrix<real, D> H;
        for (int j = 0; j < D; ++j)
            for (int i = 0; i <= j; ++i) H(i, j) = sum();
        const auto d = newton_step<R, D>(H, g, damping);
        for (int i = 0; i < D; ++i) steps[row + i * part.stride] = d[static_cast<std::size_t>(i)];
        return r.finish("relaxation_steps", form);
    }

    static kernel_text record_tries(const any_energy& energy, kernel_form form)
    {
        recording r;
        const entry_inputs in(r);
        const auto steps = r.in<R>("steps");
        auto values = r.out<R>("values");
        const colour_part part(r);
        const star_corner at(r.global_id(), in, part);
        const real measure = in.measure[at.cell], weight = in.weight[at.cell];
        for (int t = 0; t < trials; ++t)
        {
            const auto moved = [&](int i) {
                return moved_coordinate(in.x[at.vertex + i * in.vertex_stride], length(t),
                                        steps[at.row + i * part.stride]);
            };
            const auto S = at.W.shape_matrix(at.edges(in, moved));
            values[at.entry + t * part.stride] = traced::weighted(energy, S, measure, weight);
        }
        return r.finish("relaxation_tries", form);
    }

    static kernel_text record_moves(kernel_form form)
    {
        recording r;
        const auto lists = r.in<idx>("lists");
        const auto steps = r.in<R>("steps"), values = r.in<R>("values");
        auto x = r.inout<P>("x");
        const auto vertex_stride = r.scalar<idx>("vertex_stride");
        const colour_part part(r);
        const auto row = r.global_id();

        // Less by more than rounding; NaN and infinity are never less.
        const real stay = steps[row + D * part.stride];
        real best = stay - real(16.0 * std::numeric_limits<R>::epsilon()) * abs(stay), a = 0.0;
        for (int t = 0; t < trials; ++t)
        {
            const real value = part.sum_of_row(lists, row, values, t);
            a = select(value < best, real(length(t)), a);
            best = select(value < best, value, best);
        }
        const auto vertex = lists[row + part.first_row];
        for (int i = 0; i < D; ++i)
        {
            const auto coordinate = x[vertex + i * vertex_stride];
            const sym<P> from = coordinate;
            coordinate = select(a > real(0.0), moved_coordinate(from, a, steps[row + i * part.stride]), from);
        }
        return r.finish("relaxation_moves", form);
    }

private:
    using traced = traced_element<D, P, R>;
    using real = typename traced::real;

    static real length(int t) { return real(step_lengths[static_cast<std::size_t>(t)]); }

    /// One spelling for the trial and for the move: what was measured is what is taken.
    static sym<P> moved_coordinate(sym<P> from, real a, real step) { return from + cast<P>(a * step); }

    /// The part of the lists that a launch has. Entries and rows count from its beginning.
    struct colour_part
    {
        explicit colour_part(recording& r)
            : first_entry(r.scalar<idx>("first_entry")),
              first_row(r.scalar<idx>("first_row")),
              list_stride(r.scalar<idx>("list_stride")),
              stride(r.scalar<idx>("stride"))
        {
        }

        real sum_of_row(const in_array<idx>& lists, sym<idx> row, const in_array<R>& numbers, int slot) const
        {
            const auto offset = row + first_row + list_stride;
            const auto base = slot * stride - first_entry;
            return sum_over(lists[offset], lists[offset + 1], [&](sym<idx> entry) { return numbers[entry + base]; });
        }

        sym<idx> first_entry, first_row, list_stride, stride;
    };

    /// What the kernels of entries read, in the order of their signature.
    struct entry_inputs
    {
        explicit entry_inputs(recording& r)
            : lists(r.in<idx>("lists")),
              x(r.in<P>("x")),
              corners(r.in<idx>("corners")),
              inverse(r.in<R>("inverse")),
              measure(r.in<R>("measure")),
              weight(r.in<R>("weight")),
              cell_stride(r.scalar<idx>("cell_stride")),
              vertex_stride(r.scalar<idx>("vertex_stride"))
        {
        }

        in_array<idx> lists;
        in_array<P> x;
        in_array<idx> corners;
        in_array<R> inverse, measure, weight;
        sym<idx> cell_stride, vertex_stride;
    };

    /// An element at the vertex of a row. Which corner the vertex is, only the device knows.
    struct star_corner
    {
        sym<idx> entry, row, cell, vertex;
        std::array<sym<idx>, static_cast<std::size_t>(D) + 1> corners;
        typename traced::rest W;
        std::array<real, static_cast<std::size_t>(D)> q; ///< gradient of the vertex' basis function

        star_corner(sym<idx> entry_of_part, const entry_inputs& in, const colour_part& part)
            : entry(entry_of_part),
              row(in.lists[entry + part.first_entry + 3 * part.list_stride] - part.first_row),
              cell(in.lists[entry + part.first_entry + 2 * part.list_stride]),
              vertex(in.lists[row + part.first_row]),
              W(cell, in.inverse, in.cell_stride)
        {
            for (int k = 0; k <= D; ++k) corners[static_cast<std::size_t>(k)] = in.corners[cell + k * in.cell_stride];
            // Rows of W^-1 belong to corners 1..D; corner 0 has minus their sum.
            std::array<real, static_cast<std::size_t>(D)> sign;
            for (int k = 0; k < D; ++k) sign[static_cast<std::size_t>(k)] = here(k + 1) - here(0);
            for (int c = 0; c < D; ++c)
            {
                real sum = sign[0] * W(0, c);
                for (int k = 1; k <= c; ++k) sum = sum + sign[static_cast<std::size_t>(k)] * W(k, c);
                q[static_cast<std::size_t>(c)] = sum;
            }
        }

        /// 1 if corner k is the vertex, else 0.
        real here(int k) const { return select(is_here(k), real(1.0), real(0.0)); }
        sym_bool is_here(int k) const { return corners[static_cast<std::size_t>(k)] == vertex; }

        /// Edges as in traced_element, with coordinate i of the vertex at place(i).
        template <class Place>
        glm::mat<D, D, sym<P>> edges(const entry_inputs& in, const Place& place) const
        {
            const auto coordinate = [&](int k, int i)
            { return select(is_here(k), place(i), in.x[corners[static_cast<std::size_t>(k)] + i * in.vertex_stride]); };
            glm::mat<D, D, sym<P>> A;
            for (int k = 0; k < D; ++k)
                for (int i = 0; i < D; ++i) A[k][i] = coordinate(k + 1, i) - coordinate(0, i);
            return A;
        }
    };
};

} // namespace taut
