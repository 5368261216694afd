// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <span>
#include <utility>
#include <vector>

#include <taut/constraints.hpp>
#include <taut/impl/core/compute/vector_space.hpp>
#include <taut/impl/core/core/fixed_marks.hpp>
#include <taut/impl/core/mesh/layout.hpp>
#include <taut/impl/core/objective/element_hessian.hpp>
#include <taut/impl/core/objective/real_types.hpp>
#include <taut/kernel.hpp>

namespace taut::impl
{

/// Projection of displacements to the admissible ones, beside the vertices that are pinned in the layout: single
/// coordinates are fixed (P is diagonal, of 0 and 1), and vertices slide along lines or planes of any direction.
/// Vectors are projected, and so are rows and columns of element Hessians, and with them the matrices of all levels.
/// What is fixed, and where it is to go, can change without rebuilding anything else. Kernels run over fixed
/// coordinates and sliding vertices, and the elements at them.
template <class Element>
class fixed_terms
{
public:
    static constexpr int D = Element::dimension;

    fixed_terms(queue q, const real_types& types, const layout<Element>& mesh_layout);

    /// Replaces what is fixed, in the user's numbering. marks: one per vertex, or none. slides: at most one per vertex.
    void fix(const layout<Element>& mesh_layout, const fixed_marks<D>& marks, std::span<const taut::slide<D>> slides)
    {
        fix(mesh_layout, marks);
        slide(mesh_layout, slides);
    }

    /// Sets the targets of fixed coordinates: target(v) is that of vertex v, in the user's numbering and units.
    template <class Target>
    void aim(const layout<Element>& mesh_layout, const Target& target);

    /// v = P v.
    void project(device_vector& v);

    /// H = P H P for the Hessians of elements, packed as in hessian_slots; blocks of a sliding vertex with itself get
    /// their mean diagonal where P gives 0, so that they can be inverted. No vector depends on that.
    void project_hessian(real_buffer& hessian)
    {
        if (!sliding_.empty()) slide_hessian(hessian);
        clear("mask_hessian", entries_, hessian);
    }

    /// d = a fraction of the remaining displacement at fixed coordinates; other places stay as they are.
    void gap(const device_vector& x, double share, device_vector& d);

    /// Sets x to the targets at fixed coordinates.
    void put(device_vector& x);

    /// Adds to the gradients of corners the products of the Hessians of elements, not projected yet, with d, which is
    /// zero at all free coordinates.
    void add_product(const real_buffer& hessian, const device_vector& d, real_buffer& corner_gradients);

private:
    using slots = hessian_slots<D>;
    static constexpr int pairs = D * (D + 1) / 2; ///< entries of a symmetric matrix

    static constexpr std::size_t at(idx k) { return static_cast<std::size_t>(k); }
    static constexpr int pair(int i, int j) { return i > j ? pair(j, i) : i * D - i * (i - 1) / 2 + (j - i); }

    void fix(const layout<Element>& mesh_layout, const fixed_marks<D>& marks);

    void slide(const layout<Element>& mesh_layout, std::span<const taut::slide<D>> slides);

    void slide_hessian(real_buffer& hessian);

    static void store(const glm::mat<D, D, double>& P, std::vector<double>& to, std::size_t first, std::size_t stride)
    {
        for (int i = 0; i < D; ++i)
            for (int j = i; j < D; ++j) to[first + at(pair(i, j)) * stride] = P[j][i];
    }

    static std::vector<idx> distinct(std::vector<idx> numbers)
    {
        std::sort(numbers.begin(), numbers.end());
        numbers.erase(std::unique(numbers.begin(), numbers.end()), numbers.end());
        return numbers;
    }

    buffer<idx> buffer_of(const std::vector<idx>& numbers)
    {
        return numbers.empty() ? buffer<idx>() : buffer<idx>(queue_, numbers);
    }

    void clear(const char* name, const buffer<idx>& where, real_buffer& what);

    template <class Prepare>
    void over_places(const char* name, const Prepare& prepare);

    queue queue_;
    real_types types_;
    idx cell_stride_, vertex_stride_;
    std::vector<std::pair<std::size_t, int>> coordinates_; ///< vertex and coordinate of each place, the user's numbers
    buffer<idx> places_;                                   ///< fixed coordinates in vectors
    buffer<idx> entries_;                                  ///< entries of element Hessians
    buffer<idx> cells_, corners_;                          ///< elements at fixed vertices, and their vertices
    real_buffer targets_;                                  ///< by place
    buffer<idx> sliding_, sliding_cells_;                  ///< sliding vertices, and the elements at them
    real_buffer projections_, corner_projections_;         ///< of these
};

template <class Element>
fixed_terms<Element>::fixed_terms(queue q, const real_types& types, const layout<Element>& mesh_layout)
    : queue_(std::move(q)),
      types_(types),
      cell_stride_(static_cast<idx>(mesh_layout.cell_stride)),
      vertex_stride_(static_cast<idx>(mesh_layout.vertex_stride))
{
}

template <class Element>
template <class Target>
void fixed_terms<Element>::aim(const layout<Element>& mesh_layout, const Target& target)
{
    if (places_.empty()) return;
    std::vector<double> targets;
    for (const auto& [v, i] : coordinates_) targets.push_back(target(v)[i] * mesh_layout.scale);
    targets_ = real_buffer(queue_, types_.position, targets);
}

template <class Element>
void fixed_terms<Element>::project(device_vector& v)
{
    clear("mask", places_, v.data());
    if (sliding_.empty()) return;
    queue_.submit(
        [&](handler& h)
        {
            const auto vertices = sliding_.read(h);
            const auto P = projections_.read(h);
            const auto x = v.data().read_write(h);
            const auto n = h.uniform(static_cast<idx>(sliding_.size())), stride = h.uniform(vertex_stride_);
            h.parallel_for("slide", sliding_.size(),
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

template <class Element>
void fixed_terms<Element>::gap(const device_vector& x, double share, device_vector& d)
{
    over_places("gap",
                [&](handler& h)
                {
                    const auto to = targets_.read(h), from = x.data().read(h);
                    const auto out = d.data().read_write(h);
                    const auto part = h.uniform(types_.position, share);
                    return [=, this](const auto& i, const auto& place)
                    { out[place] = cast(types_.vector, part * (to[i] - from[place])); };
                });
}

template <class Element>
void fixed_terms<Element>::put(device_vector& x)
{
    over_places("put",
                [&](handler& h)
                {
                    const auto to = targets_.read(h);
                    const auto out = x.data().read_write(h);
                    return [=](const auto& i, const auto& place) { out[place] = to[i]; };
                });
}

template <class Element>
void fixed_terms<Element>::add_product(const real_buffer& hessian, const device_vector& d,
                                       real_buffer& corner_gradients)
{
    if (cells_.empty()) return;
    queue_.submit(
        [&](handler& h)
        {
            const auto cells = cells_.read(h), corners = corners_.read(h);
            const auto n = h.uniform(static_cast<idx>(cells_.size()));
            const auto cell_stride = h.uniform(cell_stride_), vertex_stride = h.uniform(vertex_stride_);
            const auto H = hessian.read(h);
            const auto along = d.data().read(h);
            const auto g = corner_gradients.read_write(h);
            h.parallel_for("fixed_product", cells_.size(),
                           [&](auto c)
                           {
                               const auto cell = cells[c];
                               for (int l = 0; l < Element::corners; ++l)
                                   for (int j = 0; j < D; ++j)
                                   {
                                       sym<double> sum = 0.0;
                                       for (int k = 0; k < Element::corners; ++k)
                                           for (int i = 0; i < D; ++i)
                                               sum = sum + H[cell + slots::at(k, i, l, j) * cell_stride] *
                                                               along[corners[c + k * n] + i * vertex_stride];
                                       const auto place = cell + (l * D + j) * cell_stride;
                                       g[place] = g[place] + cast(types_.position, sum);
                                   }
                           });
        });
}

template <class Element>
void fixed_terms<Element>::fix(const layout<Element>& mesh_layout, const fixed_marks<D>& marks)
{
    coordinates_.clear();
    std::vector<idx> places, entries, cells, corners;
    for (std::size_t v = 0; v < marks.size(); ++v)
    {
        if (!marks.any(v)) continue;
        const idx here = mesh_layout.order.vertices.old_to_new[v];
        const auto around = mesh_layout.vertex_corners.row(here);
        for (const idx corner : around) cells.push_back(corner / Element::corners);
        for (int i = 0; i < D; ++i)
        {
            if (!marks.test(v, i)) continue;
            coordinates_.push_back({v, i});
            places.push_back(here + i * vertex_stride_);
            for (const idx corner : around)
                for (int l = 0; l < Element::corners; ++l)
                    for (int j = 0; j < D; ++j)
                        entries.push_back(corner / idx(Element::corners) +
                                          slots::at(corner % Element::corners, i, l, j) * cell_stride_);
        }
    }
    places_ = buffer_of(places);
    entries_ = buffer_of(distinct(std::move(entries)));
    cells = distinct(std::move(cells));
    cells_ = buffer_of(cells);
    for (std::size_t k = 0; k < Element::corners; ++k)
        for (const idx c : cells) corners.push_back(mesh_layout.corners[k * mesh_layout.cell_stride + at(c)]);
    corners_ = buffer_of(corners);
}

template <class Element>
void fixed_terms<Element>::slide(const layout<Element>& mesh_layout, std::span<const taut::slide<D>> slides)
{
    std::vector<idx> vertices, cells, number(at(mesh_layout.vertex_count), -1);
    std::vector<double> projections(slides.size() * pairs);
    for (std::size_t n = 0; n < slides.size(); ++n)
    {
        const idx here = mesh_layout.order.vertices.old_to_new[at(slides[n].vertex)];
        number[at(here)] = static_cast<idx>(n);
        vertices.push_back(here);
        store(slides[n].projection, projections, n, slides.size());
        for (const idx corner : mesh_layout.vertex_corners.row(here)) cells.push_back(corner / Element::corners);
    }
    cells = distinct(std::move(cells));
    std::vector<double> of_corners(Element::corners * pairs * cells.size());
    for (std::size_t k = 0; k < Element::corners; ++k)
        for (std::size_t c = 0; c < cells.size(); ++c)
        {
            const idx n = number[at(mesh_layout.corners[k * mesh_layout.cell_stride + at(cells[c])])];
            store(n < 0 ? glm::mat<D, D, double>(1.0) : slides[at(n)].projection, of_corners,
                  k * pairs * cells.size() + c, cells.size());
        }
    sliding_ = buffer_of(vertices);
    sliding_cells_ = buffer_of(cells);
    if (slides.empty()) return;
    projections_ = real_buffer(queue_, types_.vector, projections);
    corner_projections_ = real_buffer(queue_, types_.vector, of_corners);
}

template <class Element>
void fixed_terms<Element>::slide_hessian(real_buffer& hessian)
{
    queue_.submit(
        [&](handler& h)
        {
            const auto cells = sliding_cells_.read(h);
            const auto P = corner_projections_.read(h);
            const auto H = hessian.read_write(h);
            const auto n = h.uniform(static_cast<idx>(sliding_cells_.size())), stride = h.uniform(cell_stride_);
            h.parallel_for(
                "slide_hessian", sliding_cells_.size(),
                [&](auto c)
                {
                    const auto cell = cells[c];
                    const auto projection = [&](int k, int i, int j) { return P[c + (k * pairs + pair(i, j)) * n]; };
                    for (int k = 0; k < Element::corners; ++k)
                        for (int l = k; l < Element::corners; ++l)
                        {
                            std::array<std::array<sym<double>, D>, D> HP;
                            for (int i = 0; i < D; ++i)
                                for (int j = 0; j < D; ++j)
                                {
                                    sym<double> sum = 0.0;
                                    for (int m = 0; m < D; ++m)
                                        sum = sum + H[cell + slots::at(k, i, l, m) * stride] * projection(l, m, j);
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
                                    for (int m = 0; m < D; ++m) sum = sum + projection(k, i, m) * HP[at(m)][at(j)];
                                    if (k == l) sum = sum + mean * (double(i == j) - projection(k, i, j));
                                    H[cell + slots::at(k, i, l, j) * stride] = sum;
                                }
                        }
                });
        });
}

template <class Element>
void fixed_terms<Element>::clear(const char* name, const buffer<idx>& where, real_buffer& what)
{
    if (where.empty()) return;
    queue_.submit(
        [&](handler& h)
        {
            const auto places = where.read(h);
            const auto out = what.read_write(h);
            h.parallel_for(name, where.size(), [&](auto i) { out[places[i]] = 0.0; });
        });
}

template <class Element>
template <class Prepare>
void fixed_terms<Element>::over_places(const char* name, const Prepare& prepare)
{
    if (places_.empty()) return;
    queue_.submit(
        [&](handler& h)
        {
            const auto places = places_.read(h);
            const auto work = prepare(h);
            h.parallel_for(name, places_.size(), [&](auto i) { work(i, places[i]); });
        });
}

// Compiled once, with the bodies.
extern template class fixed_terms<triangle>;

} // namespace taut::impl
