// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <limits>
#include <string>
#include <vector>

#include <taut/elements.hpp>
#include <taut/impl/core/compute/record.hpp>
#include <taut/impl/core/mesh/first_flip.hpp>
#include <taut/impl/core/objective/traced_element.hpp>

namespace taut::impl
{

/// Kernels of one energy over one kind of element, one work-item per element, traced from the energy's C++ template.
/// All of them take element_inputs. Arrays are laid out as in layout.hpp; ranges are whole multiples of its step, so
/// there are no bounds tests, and loads and stores have stride 1 but for the vertices, which is what lets a CPU device
/// vectorise them.
template <class Element>
struct element_kernels
{
    static constexpr int D = Element::dimension;
    static constexpr int trials = 4; ///< step lengths that one launch of `along` tries

    /// -> "energy": weighted energy of each element
    recorded_kernel value;

    /// -> "energy", and "corner_gradient": entry ((corner * D) + k) * cell_stride + cell
    recorded_kernel gradient;

    /// "d", "unit", "step0".."step3" -> "energy" as value has it, at x + unit[0] a d for `trials` step lengths a, one
    /// segment of cell_stride each
    recorded_kernel along;

    /// "d" -> "first": the least a > 0 at which det(x + a d) of each element vanishes; never of what has no orientation
    recorded_kernel first_flips;

    element_kernels(const queue& q, const any_energy& energy, const real_types& types)
        : element_kernels(traced_program(q, record(energy, types, impl::form_for(q.device())),
                                         record_common(energy, types, impl::form_for(q.device()))))
    {
    }

    /// Takes the kernels from a program with the texts of record() and record_common().
    explicit element_kernels(const traced_program& p);

    /// Texts of the kernels: for a shared program, and for tests.
    static std::vector<kernel_text> record(const any_energy& energy, const real_types& types, kernel_form form)
    {
        return {record_value(energy, types, form), record_gradient(energy, types, form),
                record_along(energy, types, form)};
    }
    /// Texts of the kernels that are the same for all energies without data.
    static std::vector<kernel_text> record_common(const any_energy& energy, const real_types& types, kernel_form form)
    {
        return {record_first_flips(energy, types, form)};
    }

    static kernel_text record_value(const any_energy& energy, const real_types& types, kernel_form form);

    static kernel_text record_gradient(const any_energy& energy, const real_types& types, kernel_form form);

    static kernel_text record_along(const any_energy& energy, const real_types& types, kernel_form form);

    /// energy: determines the optional arguments.
    static kernel_text record_first_flips(const any_energy& energy, const real_types& types, kernel_form form);

private:
    using traced = traced_element<D>;
    using real = typename traced::real;
};

template <class Element>
element_kernels<Element>::element_kernels(const traced_program& p)
    : value(p, "element_value"),
      gradient(p, "element_gradient"),
      along(p, "element_along"),
      first_flips(p, "element_first_flip")
{
}

template <class Element>
kernel_text element_kernels<Element>::record_value(const any_energy& energy, const real_types& types, kernel_form form)
{
    recording r(types.position);
    const element_inputs in(r, types, energy);
    auto energies = r.out<double>("energy", types.vector);
    const auto cell = r.global_id();
    const traced e(in, cell, types.position, types.position);
    energies[cell] = e.weighted(energy, e.shape_matrix());
    return r.finish("element_value", form);
}

template <class Element>
kernel_text element_kernels<Element>::record_gradient(const any_energy& energy, const real_types& types,
                                                      kernel_form form)
{
    recording r(types.position);
    const element_inputs in(r, types, energy);
    auto energies = r.out<double>("energy", types.vector);
    auto gradients = r.out<double>("corner_gradient", types.position);
    const auto cell = r.global_id();
    const traced e(in, cell, types.position, types.position);
    const auto S = e.shape_matrix();
    energies[cell] = e.weighted(energy, S);
    const auto g = e.corner_gradients(energy, S);
    for (int k = 0; k <= D; ++k)
        for (int i = 0; i < D; ++i)
            gradients[cell + (k * D + i) * in.cell_stride] =
                g[static_cast<std::size_t>(k)][static_cast<std::size_t>(i)];
    return r.finish("element_gradient", form);
}

template <class Element>
kernel_text element_kernels<Element>::record_along(const any_energy& energy, const real_types& types, kernel_form form)
{
    recording r(types.position);
    const element_inputs in(r, types, energy);
    auto d = r.in<double>("d", types.vector);
    auto unit = r.in<double>("unit", types.vector);
    auto energies = r.out<double>("energy", types.vector);
    const auto cell = r.global_id();
    const traced e(in, cell, types.position, types.position);
    // S is linear in x: S(x + a d) = S(x) + a S(d), so the vertices are read once for all step lengths.
    const auto S = e.shape_matrix(), dS = e.shape_matrix(e.edges(d));
    for (int t = 0; t < trials; ++t)
    {
        const auto step = r.scalar<double>("step" + std::to_string(t), types.vector);
        const real a = cast(types.position, unit[sym<idx>(0)] * step);
        typename traced::matrix trial;
        for (int c = 0; c < D; ++c)
            for (int k = 0; k < D; ++k) trial[c][k] = S[c][k] + a * dS[c][k];
        energies[cell + t * in.cell_stride] = e.weighted(energy, trial);
    }
    return r.finish("element_along", form);
}

template <class Element>
kernel_text element_kernels<Element>::record_first_flips(const any_energy& energy, const real_types& types,
                                                         kernel_form form)
{
    recording r(types.position);
    const element_inputs in(r, types, energy);
    auto d = r.in<double>("d", types.vector);
    auto first = r.out<double>("first", types.vector);
    const auto cell = r.global_id();
    const traced e(in, cell, types.position, types.position);
    if constexpr (Element::oriented)
        first[cell] = first_flip(e.edges(in.x), e.edges(d));
    else
        first[cell] = real(std::numeric_limits<double>::infinity());
    return r.finish("element_first_flip", form);
}

// Compiled once, with the bodies.
extern template struct element_kernels<triangle>;

} // namespace taut::impl
