// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstddef>
#include <initializer_list>
#include <numeric>
#include <string>
#include <utility>
#include <vector>

#include <taut/any_energy.hpp>
#include <taut/impl/core/compute/kernel.hpp>
#include <taut/impl/core/mesh/layout.hpp>

namespace taut::impl
{

/// Arrays of a mesh on a device that the element kernels read, besides positions; strides as in layout.hpp.
template <class Element>
struct element_arrays
{
    buffer<idx> corners;
    real_buffer inverse; ///< W^-1
    real_buffer measure; ///< 0 for padding
    real_buffer weight;  ///< w_c / sum of w_c over the cells
    idx cell_stride, vertex_stride;

    real_buffer attributes, frames; ///< cell_data, if the energy has any
    std::vector<std::pair<std::string, double>> parameters;

    /// Throws parameter_error where the energy expects other data of cells than the layout has.
    element_arrays(queue& q, scalar_type type, const layout<Element>& mesh_layout, energy::weighting weights,
                   const any_energy& energy);

    /// Arguments of a kernel with element_inputs: these arrays, the map x and further ones.
    std::vector<named_argument> with(const real_buffer& x, std::initializer_list<named_argument> more) const;

private:
    static std::vector<double> relative_weights(const layout<Element>& mesh_layout, energy::weighting weights);
};

template <class Element>
element_arrays<Element>::element_arrays(queue& q, scalar_type type, const layout<Element>& mesh_layout,
                                        energy::weighting weights, const any_energy& energy)
    : corners(q, mesh_layout.corners),
      inverse(q, type, mesh_layout.inverse),
      measure(q, type, mesh_layout.measure),
      weight(q, type, relative_weights(mesh_layout, weights)),
      cell_stride(static_cast<idx>(mesh_layout.cell_stride)),
      vertex_stride(static_cast<idx>(mesh_layout.vertex_stride))
{
    if (energy.attributes().size() != mesh_layout.attribute_count || energy.directions() != !mesh_layout.frames.empty())
        throw parameter_error("energy", "expects other data of cells than the layout has (any_energy::with_data)");
    if (mesh_layout.attribute_count > 0) attributes = real_buffer(q, type, mesh_layout.attributes);
    if (energy.directions()) frames = real_buffer(q, type, mesh_layout.frames);
    for (const double p : energy.parameters())
        parameters.emplace_back("parameter" + std::to_string(parameters.size()), p);
}

template <class Element>
std::vector<named_argument> element_arrays<Element>::with(const real_buffer& x,
                                                          std::initializer_list<named_argument> more) const
{
    std::vector<named_argument> all = {{"corners", corners},
                                       {"inverse", inverse},
                                       {"measure", measure},
                                       {"weight", weight},
                                       {"x", x},
                                       {"cell_stride", cell_stride},
                                       {"vertex_stride", vertex_stride}};
    if (!attributes.empty()) all.push_back({"attributes", attributes});
    if (!frames.empty()) all.push_back({"frames", frames});
    for (const auto& [name, value] : parameters) all.push_back({name.c_str(), value});
    all.insert(all.end(), more.begin(), more.end());
    return all;
}

template <class Element>
std::vector<double> element_arrays<Element>::relative_weights(const layout<Element>& mesh_layout,
                                                              energy::weighting weights)
{
    std::vector<double> w = mesh_layout.measure;
    const auto end = w.begin() + static_cast<std::ptrdiff_t>(mesh_layout.cell_count);
    if (weights == energy::weighting::uniform) std::fill(w.begin(), end, 1.0);
    for (std::size_t c = 0; c < mesh_layout.weight.size(); ++c) w[c] *= mesh_layout.weight[c];
    const double total = std::accumulate(w.begin(), end, 0.0);
    for (auto& v : w) v /= total;
    return w;
}

// Compiled once, with the bodies.
extern template struct element_arrays<triangle>;

} // namespace taut::impl
