// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <vector>

#include <taut/compute/record.hpp>
#include <taut/objective/first_flip.hpp>
#include <taut/objective/traced_element.hpp>

namespace taut
{

/// The kernels of one energy over one kind of element, one work-item an element, traced from the energy's C++ template.
/// P is the type of positions and of the arithmetic, R that of directions, energies and what is constant in a mesh.
/// Arrays are laid out as in layout.hpp; ranges are whole
/// multiples of its step, so there are no bounds tests, and loads and stores have stride 1 but for the vertices, which
/// is what lets a CPU device vectorise them.
template <class Element, class P, class R>
struct element_kernels
{
    static constexpr int D = Element::dimension;
    static constexpr int trials = 4; ///< step lengths that one launch of `along` tries

    /// corners, W^-1, measure, weight, x -> weighted energy of each element
    traced_kernel<in<idx>, in<R>, in<R>, in<R>, in<P>, out<R>, uniform<idx>, uniform<idx>> value;

    /// the same, and the gradient of each corner: entry ((corner * D) + k) * cell_stride + cell
    traced_kernel<in<idx>, in<R>, in<R>, in<R>, in<P>, out<R>, out<P>, uniform<idx>, uniform<idx>> gradient;

    /// the same as value at x + unit[0] a d for `trials` step lengths a, one segment of cell_stride each
    traced_kernel<in<idx>, in<R>, in<R>, in<R>, in<P>, in<R>, in<R>, out<R>, uniform<idx>, uniform<idx>, uniform<R>,
                  uniform<R>, uniform<R>, uniform<R>>
        along;

    /// corners, x, d -> the first a > 0 at which det(x + a d) of each element vanishes
    traced_kernel<in<idx>, in<P>, in<R>, out<R>, uniform<idx>, uniform<idx>> first_flips;

    element_kernels(const queue& q, const any_energy& energy)
        : element_kernels(traced_program(q, record(energy, detail::form_for(q.device()))))
    {
    }

    /// From a program with all that record() gives.
    explicit element_kernels(const traced_program& p)
        : value(p, "element_value"),
          gradient(p, "element_gradient"),
          along(p, "element_along"),
          first_flips(p, "element_first_flip")
    {
    }

    /// The kernels as text: for a program that others share, for tests and for the curious.
    static std::vector<kernel_text> record(const any_energy& energy, kernel_form form)
    {
        return {record_value(energy, form), record_gradient(energy, form), record_along(energy, form),
                record_first_flips(form)};
    }

    static kernel_text record_value(const any_energy& energy, kernel_form form)
    {
        recording r;
        const inputs in(r);
        auto energies = r.out<R>("energy");
        const strides n(r);
        const typename traced::rest W(in.cell, in.inverse, n.cell);
        const auto S = W.shape_matrix(traced::edges(in.cell, in.corners, in.x, n.cell, n.vertex));
        energies[in.cell] =
            cast<R>(traced::weighted(energy, S, cast<P>(in.measure[in.cell]), cast<P>(in.weight[in.cell])));
        return r.finish("element_value", form);
    }

    static kernel_text record_gradient(const any_energy& energy, kernel_form form)
    {
        recording r;
        const inputs in(r);
        auto energies = r.out<R>("energy");
        auto gradients = r.out<P>("corner_gradient");
        const strides n(r);
        const typename traced::rest W(in.cell, in.inverse, n.cell);
        const auto S = W.shape_matrix(traced::edges(in.cell, in.corners, in.x, n.cell, n.vertex));
        const real measure = cast<P>(in.measure[in.cell]), weight = cast<P>(in.weight[in.cell]);
        energies[in.cell] = cast<R>(traced::weighted(energy, S, measure, weight));
        const auto g = traced::corner_gradients(energy, S, W, measure, weight);
        for (int k = 0; k <= D; ++k)
            for (int i = 0; i < D; ++i)
                gradients[in.cell + (k * D + i) * n.cell] = g[static_cast<std::size_t>(k)][static_cast<std::size_t>(i)];
        return r.finish("element_gradient", form);
    }

    static kernel_text record_along(const any_energy& energy, kernel_form form)
    {
        recording r;
        const inputs in(r);
        auto d = r.in<R>("d");
        auto unit = r.in<R>("unit");
        auto energies = r.out<R>("energy");
        const strides n(r);
        // S is linear in x: S(x + a d) = S(x) + a S(d), so the vertices are read once for all step lengths.
        const typename traced::rest W(in.cell, in.inverse, n.cell);
        const auto S = W.shape_matrix(traced::edges(in.cell, in.corners, in.x, n.cell, n.vertex));
        const auto dS = W.shape_matrix(traced::edges(in.cell, in.corners, d, n.cell, n.vertex));
        const real measure = cast<P>(in.measure[in.cell]), weight = cast<P>(in.weight[in.cell]);
        for (int t = 0; t < trials; ++t)
        {
            const real a = cast<P>(unit[sym<idx>(0)] * r.scalar<R>("step" + std::to_string(t)));
            typename traced::matrix trial;
            for (int c = 0; c < D; ++c)
                for (int k = 0; k < D; ++k) trial[c][k] = S[c][k] + a * dS[c][k];
            energies[in.cell + t * n.cell] = cast<R>(traced::weighted(energy, trial, measure, weight));
        }
        return r.finish("element_along", form);
    }

    static kernel_text record_first_flips(kernel_form form)
    {
        recording r;
        auto corners = r.in<idx>("corners");
        auto x = r.in<P>("x");
        auto d = r.in<R>("d");
        auto first = r.out<R>("first");
        const strides n(r);
        const auto cell = r.global_id();
        first[cell] = cast<R>(first_flip(traced::edges(cell, corners, x, n.cell, n.vertex),
                                         traced::edges(cell, corners, d, n.cell, n.vertex)));
        return r.finish("element_first_flip", form);
    }

private:
    using traced = traced_element<D, P, P>;
    using real = typename traced::real;

    /// What every energy kernel reads, in the order of its signature.
    struct inputs
    {
        explicit inputs(recording& r)
            : corners(r.in<idx>("corners")),
              inverse(r.in<R>("inverse")),
              measure(r.in<R>("measure")),
              weight(r.in<R>("weight")),
              x(r.in<P>("x")),
              cell(r.global_id())
        {
        }

        in_array<idx> corners;
        in_array<R> inverse, measure, weight;
        in_array<P> x;
        sym<idx> cell;
    };

    struct strides
    {
        explicit strides(recording& r) : cell(r.scalar<idx>("cell_stride")), vertex(r.scalar<idx>("vertex_stride")) {}
        sym<idx> cell, vertex;
    };
};

} // namespace taut
