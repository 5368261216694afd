// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <span>
#include <utility>
#include <vector>

#include <taut/impl/compute/handler.hpp>
#include <taut/impl/compute/vector_space.hpp>
#include <taut/impl/constrain/slide.hpp>
#include <taut/impl/mesh/layout.hpp>
#include <taut/impl/objective/element_hessian.hpp>
#include <taut/impl/objective/real_types.hpp>

namespace taut::impl
{

/// Vertices that slide along lines or planes of any direction: vectors are projected there, and so are rows and columns
/// of element Hessians, and with them the matrices of all levels. Kernels run over those vertices, and the elements at
/// them.
template <class Element>
class sliding_terms
{
public:
    static constexpr int D = Element::dimension;

    sliding_terms(queue q, const real_types& types, const layout<Element>& mesh_layout)
        : queue_(std::move(q)),
          types_(types),
          cell_stride_(static_cast<idx>(mesh_layout.cell_stride)),
          vertex_stride_(static_cast<idx>(mesh_layout.vertex_stride))
    {
    }

    /// Replaces the slides: in the user's numbering, at most one per vertex.
    void slide(const layout<Element>& mesh_layout, std::span<const taut::slide<D>> slides)
    {
        count_ = slides.size();
        cells_count_ = 0;
        if (slides.empty()) return;
        std::vector<idx> vertices, cells;
        std::vector<double> projections(count_ * pairs);
        std::vector<idx> number(static_cast<std::size_t>(mesh_layout.vertex_count), -1);
        for (std::size_t n = 0; n < count_; ++n)
        {
            const idx here = mesh_layout.order.vertices.old_to_new[static_cast<std::size_t>(slides[n].vertex)];
            number[static_cast<std::size_t>(here)] = static_cast<idx>(n);
            vertices.push_back(here);
            store(slides[n].projection, projections, n, count_);
            for (const idx corner : mesh_layout.vertex_corners.row(here)) cells.push_back(corner / Element::corners);
        }
        std::sort(cells.begin(), cells.end());
        cells.erase(std::unique(cells.begin(), cells.end()), cells.end());
        cells_count_ = cells.size();
        std::vector<double> of_corners(Element::corners * pairs * cells_count_);
        for (std::size_t k = 0; k < Element::corners; ++k)
            for (std::size_t c = 0; c < cells_count_; ++c)
            {
                const idx v = mesh_layout.corners[k * mesh_layout.cell_stride + static_cast<std::size_t>(cells[c])];
                const idx n = number[static_cast<std::size_t>(v)];
                store(n < 0 ? glm::mat<D, D, double>(1.0) : slides[static_cast<std::size_t>(n)].projection, of_corners,
                      k * pairs * cells_count_ + c, cells_count_);
            }
        vertices_ = buffer<idx>(queue_, vertices);
        projections_ = real_buffer(queue_, types_.vector, projections);
        cells_ = buffer<idx>(queue_, cells);
        corner_projections_ = real_buffer(queue_, types_.vector, of_corners);
    }

    bool empty() const noexcept { return count_ == 0; }

    /// Projects v, v = P v, at sliding vertices.
    void project(device_vector& v)
    {
        if (empty()) return;
        queue_.submit(
            [&](handler& h)
            {
                const auto vertices = vertices_.read(h);
                const auto P = projections_.read(h);
                const auto x = v.data().read_write(h);
                const auto n = h.uniform(static_cast<idx>(count_)), stride = h.uniform(vertex_stride_);
                h.parallel_for("slide", count_,
                               [&](auto i)
                               {
                                   std::array<sym<double>, D> before;
                                   for (int k = 0; k < D; ++k) before[at(k)] = x[vertices[i] + k * stride];
                                   for (int k = 0; k < D; ++k)
                                   {
                                       sym<double> sum = 0.0;
                                       for (int j = 0; j < D; ++j) sum = sum + P[i + pair(k, j) * n] * before[at(j)];
                                       x[vertices[i] + k * stride] = sum;
                                   }
                               });
            });
    }

    /// Projects the Hessians of elements, H = P H P, packed as in hessian_slots; blocks of a sliding vertex with itself
    /// get their mean diagonal where P gives 0, so that they can be inverted. No vector depends on that.
    void project_hessian(real_buffer& hessian)
    {
        if (empty()) return;
        queue_.submit(
            [&](handler& h)
            {
                const auto cells = cells_.read(h);
                const auto P = corner_projections_.read(h);
                const auto H = hessian.read_write(h);
                const auto n = h.uniform(static_cast<idx>(cells_count_)), stride = h.uniform(cell_stride_);
                h.parallel_for("slide_hessian", cells_count_,
                               [&](auto c)
                               {
                                   const auto cell = cells[c];
                                   const auto projection = [&](int k, int i, int j)
                                   { return P[c + (k * pairs + pair(i, j)) * n]; };
                                   for (int k = 0; k < Element::corners; ++k)
                                       for (int l = k; l < Element::corners; ++l)
                                       {
                                           std::array<std::array<sym<double>, D>, D> HP;
                                           for (int i = 0; i < D; ++i)
                                               for (int j = 0; j < D; ++j)
                                               {
                                                   sym<double> sum = 0.0;
                                                   for (int m = 0; m < D; ++m)
                                                       sum = sum + H[cell + slots::at(k, i, l, m) * stride] *
                                                                       projection(l, m, j);
                                                   HP[at(i)][at(j)] = sum;
                                               }
                                           sym<double> mean = 0.0;
                                           if (k == l)
                                               for (int i = 0; i < D; ++i)
                                                   mean = mean + H[cell + slots::at(k, i, k, i) * stride] / double(D);
                                           for (int i = 0; i < D; ++i)
                                               for (int j = k == l ? i : 0; j < D; ++j)
                                               {
                                                   sym<double> sum = 0.0;
                                                   for (int m = 0; m < D; ++m)
                                                       sum = sum + projection(k, i, m) * HP[at(m)][at(j)];
                                                   if (k == l)
                                                       sum = sum + mean * (double(i == j) - projection(k, i, j));
                                                   H[cell + slots::at(k, i, l, j) * stride] = sum;
                                               }
                                       }
                               });
            });
    }

private:
    using slots = hessian_slots<D>;
    static constexpr int pairs = D * (D + 1) / 2; ///< entries of a symmetric matrix

    static constexpr std::size_t at(int k) { return static_cast<std::size_t>(k); }
    static constexpr int pair(int i, int j)
    {
        if (i > j) return pair(j, i);
        return i * D - i * (i - 1) / 2 + (j - i);
    }

    static void store(const glm::mat<D, D, double>& P, std::vector<double>& to, std::size_t first, std::size_t stride)
    {
        for (int i = 0; i < D; ++i)
            for (int j = i; j < D; ++j) to[first + static_cast<std::size_t>(pair(i, j)) * stride] = P[j][i];
    }

    queue queue_;
    real_types types_;
    idx cell_stride_, vertex_stride_;
    std::size_t count_ = 0, cells_count_ = 0;
    buffer<idx> vertices_, cells_;
    real_buffer projections_, corner_projections_;
};

} // namespace taut::impl
