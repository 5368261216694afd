// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <taut/impl/core/objective/element_arrays.hpp>
#include <taut/impl/core/objective/element_hessian.hpp>
#include <taut/impl/core/objective/element_kernels.hpp>
#include <taut/impl/core/objective/patches.hpp>

namespace taut::impl
{

/// The elements of some patches, one patch after the other, on a device, by the kernels that evaluate the whole mesh.
/// Entries of arrays stand as in layout.hpp; vertices that two patches have are two here.
template <class Element>
class patch_cells
{
public:
    static constexpr int D = Element::dimension;
    static constexpr int trials = element_kernels<Element>::trials;

    patch_cells(const queue& q, const layout<Element>& whole, std::span<const patch<Element>> patches,
                const element_kernels<Element>& first, const element_hessian_kernel<Element>& second,
                const real_types& types, energy::weighting weights, const any_energy& energy,
                const std::vector<std::pair<std::string, double>>& parameters)
        : queue_(q),
          layout_(part_of(whole, patches)),
          first_(first),
          second_(second),
          arrays_(queue_, types.vector, layout_, weights, energy),
          x_(queue_, types.position, D * layout_.vertex_stride),
          d_(queue_, types.vector, D * layout_.vertex_stride),
          one_(queue_, types.vector, std::array{1.0}),
          energies_(queue_, types.vector, trials * layout_.cell_stride),
          gradients_(queue_, types.position, (D + 1) * D * layout_.cell_stride),
          hessians_(queue_, types.vector, hessian_slots<D>::count * layout_.cell_stride),
          energies_here_(energies_.size()),
          gradients_here_(gradients_.size()),
          hessians_here_(types.vector, hessians_.size())
    {
        arrays_.parameters = parameters;
    }

    std::size_t stride() const { return layout_.cell_stride; }

    /// Sets the positions of vertices, in units of the layout of the mesh.
    void place(const std::vector<vec<D>>& x) { x_.upload(layout_.to_local(x)); }

    /// Computes gradients() and hessians() at the current positions, in one wait.
    void differentiate(definiteness sign)
    {
        first_.gradient(cells(), arrays_.with(x_, {{"energy", energies_}, {"corner_gradient", gradients_}}));
        second_.launch(cells(), arrays_.with(x_, {second_.as_argument(sign), {"hessian", hessians_}}));
        hessians_.begin_download(hessians_here_);
        gradients_.download(gradients_here_);
    }

    /// Gradients of the corners: entry ((corner * D) + k) * stride() + cell.
    const std::vector<double>& gradients() const { return gradients_here_; }

    /// hessian_slots.
    const real_buffer::numbers& hessians() const { return hessians_here_; }

    /// Energies at x + step d for each of the steps: entry trial * stride() + cell.
    const std::vector<double>& energies(const std::vector<vec<D>>& d, const std::array<double, trials>& steps)
    {
        d_.upload(layout_.to_local(d));
        first_.along(cells(), arrays_.with(x_, {{"d", d_},
                                                {"unit", one_},
                                                {"energy", energies_},
                                                {"step0", steps[0]},
                                                {"step1", steps[1]},
                                                {"step2", steps[2]},
                                                {"step3", steps[3]}}));
        energies_.download(energies_here_);
        return energies_here_;
    }

private:
    range cells() const { return {layout_.cell_stride, layout<Element>::step}; }

    static layout<Element> part_of(const layout<Element>& whole, std::span<const patch<Element>> patches)
    {
        std::vector<typename mesh<Element>::cell> cells;
        std::vector<idx> ids;
        idx vertices = 0;
        for (const auto& p : patches)
        {
            for (auto cell : p.cells)
            {
                for (idx& v : cell) v += vertices;
                cells.push_back(cell);
            }
            ids.insert(ids.end(), p.cell_ids.begin(), p.cell_ids.end());
            vertices += static_cast<idx>(p.vertices.size());
        }
        std::vector<mat<D>> inverses;
        std::vector<double> measures;
        for (const idx c : ids)
        {
            mat<D> inverse(0.0);
            std::size_t entry = static_cast<std::size_t>(c);
            for (int column = 0; column < D; ++column)
                for (int row = 0; row <= column; ++row, entry += whole.cell_stride)
                    inverse[column][row] = whole.inverse[entry];
            inverses.push_back(inverse);
            measures.push_back(whole.measure[static_cast<std::size_t>(c)]);
        }
        const mesh<Element> part(std::vector<vec3>(static_cast<std::size_t>(vertices)), std::move(cells));
        layout<Element> result(part, identity_order(part), vertices,
                               ideal_elements<Element>(std::move(inverses), std::move(measures)));
        result.attribute_count = whole.attribute_count;
        result.weight = picked(whole.weight, whole.cell_stride, ids, result.cell_stride);
        result.attributes = picked(whole.attributes, whole.cell_stride, ids, result.cell_stride);
        result.frames = picked(whole.frames, whole.cell_stride, ids, result.cell_stride);
        return result;
    }

    /// Gathers the values of some cells, padded with those of the last one.
    static std::vector<double> picked(const std::vector<double>& whole, std::size_t stride, std::span<const idx> ids,
                                      std::size_t new_stride)
    {
        std::vector<double> part(whole.size() / stride * new_stride);
        for (std::size_t i = 0; i < part.size(); ++i)
        {
            const idx c = ids[std::min(i % new_stride, ids.size() - 1)];
            part[i] = whole[i / new_stride * stride + static_cast<std::size_t>(c)];
        }
        return part;
    }

    queue queue_;
    layout<Element> layout_;
    const element_kernels<Element>& first_;
    const element_hessian_kernel<Element>& second_;
    element_arrays<Element> arrays_;
    real_buffer x_, d_, one_, energies_, gradients_, hessians_;
    std::vector<double> energies_here_, gradients_here_;
    real_buffer::numbers hessians_here_;
};

} // namespace taut::impl
