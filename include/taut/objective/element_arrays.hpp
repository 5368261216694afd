// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <numeric>
#include <vector>

#include <taut/compute/buffer.hpp>
#include <taut/energy/element.hpp>
#include <taut/mesh/layout.hpp>

namespace taut
{

/// What the kernels of elements read of a mesh besides positions, on a device; strides as in layout.hpp.
template <class Element, class R>
struct element_arrays
{
    buffer<idx> corners;
    buffer<R> inverse; ///< W^-1
    buffer<R> measure; ///< 0 for padding
    buffer<R> weight;  ///< w_c / sum of w_c over the cells

    element_arrays(queue& q, const layout<Element>& mesh_layout, energy::weighting weights)
        : corners(q, mesh_layout.corners),
          inverse(q, to_real(mesh_layout.inverse)),
          measure(q, to_real(mesh_layout.measure)),
          weight(q, to_real(relative_weights(mesh_layout, weights)))
    {
    }

private:
    static std::vector<R> to_real(const std::vector<double>& values) { return {values.begin(), values.end()}; }

    static std::vector<double> relative_weights(const layout<Element>& mesh_layout, energy::weighting weights)
    {
        std::vector<double> w = mesh_layout.measure;
        const auto end = w.begin() + static_cast<std::ptrdiff_t>(mesh_layout.cell_count);
        if (weights == energy::weighting::uniform) std::fill(w.begin(), end, 1.0);
        const double total = std::accumulate(w.begin(), end, 0.0);
        for (auto& v : w) v /= total;
        return w;
    }
};

} // namespace taut
