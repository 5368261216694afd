// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include <taut/impl/core/compute/gather.hpp>
#include <taut/impl/core/objective/volume_objective.hpp>

namespace taut::dist::impl
{

/// What the elements of a part need beside the mesh, the same on all processes.
template <class Element>
struct element_model
{
    any_energy energy;
    taut::impl::real_types types;
    double total = 1; ///< sum of the weights of all elements
};

/// The elements of a part on the device of its process: energies, gradients, first flips and Hessians, by the kernels
/// of the serial library. Vectors on the host have D numbers a vertex, of the vertices here. A part without elements
/// has no device.
template <class Element>
class local_elements
{
public:
    static constexpr int D = Element::dimension;
    using kernels = taut::impl::newton_kernels<Element>;
    using layout = taut::impl::layout<Element>;
    using numbers = std::vector<double>;
    static constexpr std::size_t trials = taut::impl::element_kernels<Element>::trials;

    local_elements() = default;

    /// own: the first vertices, whose gradients are formed. weights: one a cell.
    local_elements(queue q, std::shared_ptr<const layout> l, const std::vector<typename mesh<Element>::cell>& cells,
                   std::size_t own, const std::vector<double>& weights, const element_model<Element>& model)
        : made_(std::make_unique<on_device>(std::move(q), std::move(l), cells, own, weights, model))
    {
    }

    bool empty() const { return !made_; }
    std::size_t cells() const { return made_ ? static_cast<std::size_t>(made_->l->cell_count) : 0; }

    void move_to(const numbers& x)
    {
        if (made_) made_->upload(x, made_->x);
    }

    /// Energies of all cells at the current positions.
    numbers energies()
    {
        if (!made_) return {};
        made_->kernel->first.value(made_->range(), made_->with({{"energy", made_->energy}}));
        return made_->downloaded_energies(1);
    }

    /// The same, and the gradient at owned vertices.
    numbers energies(numbers& gradient)
    {
        if (!made_) return {};
        auto& m = *made_;
        m.kernel->first.gradient(m.range(), m.with({{"energy", m.energy}, {"corner_gradient", m.corner_gradients}}));
        m.gather(m.corner_gradients, m.v.data());
        m.download(m.v, gradient);
        return m.downloaded_energies(1);
    }

    /// Energies of all cells at x + a[i] d, at most `trials` of them, one after the other.
    numbers energies(const numbers& d, std::span<const double> a)
    {
        if (!made_) return {};
        auto& m = *made_;
        m.upload(d, m.v);
        const auto step = [&](std::size_t k) { return a[std::min(k, a.size() - 1)]; };
        m.kernel->first.along(m.range(), m.with({{"d", m.v.data()},
                                                 {"unit", m.one},
                                                 {"energy", m.energy},
                                                 {"step0", step(0)},
                                                 {"step1", step(1)},
                                                 {"step2", step(2)},
                                                 {"step3", step(3)}}));
        return m.downloaded_energies(a.size());
    }

    /// The least step along d at which a cell flips; infinite where none does.
    double first_flip(const numbers& d)
    {
        if (!made_) return std::numeric_limits<double>::infinity();
        auto& m = *made_;
        m.upload(d, m.v);
        m.kernel->first.first_flips(m.range(), m.with({{"d", m.v.data()}, {"first", m.energy}}));
        const auto flips = m.downloaded_energies(1);
        double least = std::numeric_limits<double>::infinity();
        for (const double f : flips) least = std::min(least, f);
        return least;
    }

    /// Forms the matrix of the Hessians at the current positions: the projected one, or, beside it, the exact one.
    void linearize(definiteness sign)
    {
        if (!made_) return;
        auto& m = *made_;
        const bool exact = sign == definiteness::indefinite;
        if (exact && !m.exact) m.exact.emplace(m.matrix.like());
        const auto& kernel = m.kernel->second;
        kernel.launch(m.range(), m.with({kernel.as_argument(sign), {"hessian", m.hessian}}));
        m.assemble(m.hessian, exact ? *m.exact : m.matrix);
    }

    /// out = A v at owned vertices, of the projected matrix or the exact one.
    void product(bool exact, const numbers& v, numbers& out)
    {
        if (!made_) return;
        auto& m = *made_;
        m.upload(v, m.v);
        (exact ? *m.exact : m.matrix).multiply(m.v, m.w);
        m.download(m.w, out);
    }

    /// Moves single vertices of the worst elements (vertex_relaxation.hpp), at positions x, which it changes; returns
    /// whether there were any. still: a flag per vertex: it does not move.
    bool relax(numbers& x, const std::vector<bool>& still)
    {
        if (!made_) return false;
        auto& m = *made_;
        if (!m.relaxation)
        {
            using relaxing = taut::impl::relaxation_kernels<Element>;
            m.relaxation.emplace(
                m.q, m.l, std::make_shared<const relaxing>(m.q, m.model.energy, m.model.types),
                std::shared_ptr<const taut::impl::element_arrays<Element>>(std::shared_ptr<void>(), &m.arrays), still);
        }
        else
            m.relaxation->keep_still(still);
        m.upload(x, m.x);
        if ((*m.relaxation)(m.x).vertices == 0) return false;
        m.download(m.x, x);
        return true;
    }

    /// The pattern of the matrix, with rows of all vertices here; those of the halo lack elements.
    const taut::impl::block_pattern* pattern() const { return made_ ? &made_->matrix.pattern() : nullptr; }
    /// Its values, D * D a place of the pattern, by rows.
    numbers values() const { return made_ ? made_->matrix.download() : numbers(); }

    /// Bytes on the device.
    std::uint64_t bytes() const { return made_ ? made_->q.allocated() : 0; }

private:
    struct on_device
    {
        on_device(queue given, std::shared_ptr<const layout> mesh_layout,
                  const std::vector<typename mesh<Element>::cell>& cells, std::size_t owned,
                  const std::vector<double>& weights, const element_model<Element>& of)
            : q(std::move(given)),
              model(of),
              l(std::move(mesh_layout)),
              own(owned),
              kernel(std::make_shared<const kernels>(q, model.energy, model.types, taut::impl::capping_elements::left)),
              arrays(q, model.types.vector, *l, energy::weighting::measure, model.energy),
              energy(q, model.types.vector, trials * l->cell_stride),
              one(q, model.types.vector, std::array{1.0}),
              corner_gradients(q, model.types.position, (D + 1) * D * l->cell_stride),
              hessian(q, model.types.vector, taut::impl::hessian_slots<D>::count * l->cell_stride),
              x(q, model.types.position, D * l->vertex_stride),
              v(q, model.types.vector, D * l->vertex_stride),
              w(q, model.types.vector, D * l->vertex_stride),
              form(taut::impl::lane_form::for_device(q.device())),
              gather(make_gather(model.types)),
              matrix(q, model.types.vector,
                     taut::impl::pattern_of_cells(cells, static_cast<std::size_t>(l->vertex_count), form.slice), D),
              assemble(matrix, taut::impl::assembly_lists(matrix.pattern(), D, cells, l->cell_stride))
        {
            std::vector<double> shares(l->cell_stride, 0.0);
            for (std::size_t c = 0; c < weights.size(); ++c) shares[c] = weights[c] / model.total;
            arrays.weight.upload(shares);
        }

        taut::range range() const { return {l->cell_stride, layout::step}; }

        std::vector<taut::impl::named_argument> with(std::initializer_list<taut::impl::named_argument> more) const
        {
            return arrays.with(x.data(), more);
        }

        void upload(const numbers& from, taut::impl::device_vector& to)
        {
            const auto n = static_cast<std::size_t>(l->vertex_count);
            rows.assign(D * l->vertex_stride, 0.0);
            for (std::size_t p = 0; p < n; ++p)
                for (std::size_t k = 0; k < D; ++k) rows[k * l->vertex_stride + p] = from[D * p + k];
            to.upload(rows);
        }
        void download(const taut::impl::device_vector& from, numbers& to)
        {
            rows = from.download();
            for (std::size_t p = 0; p < own; ++p)
                for (std::size_t k = 0; k < D; ++k) to[D * p + k] = rows[k * l->vertex_stride + p];
        }

        /// Of so many segments of the buffer, one after the other.
        numbers downloaded_energies(std::size_t segments) const
        {
            const auto n = static_cast<std::size_t>(l->cell_count);
            numbers all(segments * n);
            for (std::size_t s = 0; s < segments; ++s)
                energy.download(std::span(all).subspan(s * n, n), s * l->cell_stride);
            return all;
        }

        /// Sums over the cells of owned vertices, in the order of the cells.
        taut::impl::gather make_gather(const taut::impl::real_types& types)
        {
            const auto& corners = l->vertex_corners;
            const auto used = static_cast<std::size_t>(corners.offsets[own]);
            std::vector<idx> cell(used), corner(used);
            for (std::size_t k = 0; k < used; ++k)
            {
                cell[k] = corners.items[k] / Element::corners;
                corner[k] = corners.items[k] % Element::corners;
            }
            return {q,
                    std::span(corners.offsets).first(own + 1),
                    cell,
                    corner,
                    {.components = D, .cell_stride = l->cell_stride, .vertex_stride = l->vertex_stride},
                    types.position,
                    types.vector};
        }

        queue q;
        element_model<Element> model;
        std::shared_ptr<const layout> l;
        std::size_t own;
        std::shared_ptr<const kernels> kernel;
        taut::impl::element_arrays<Element> arrays;
        taut::real_buffer energy, one, corner_gradients, hessian;
        taut::impl::device_vector x, v, w;
        taut::impl::lane_form form;
        taut::impl::gather gather;
        taut::impl::block_matrix matrix;
        taut::impl::block_assembly assemble;
        std::optional<taut::impl::block_matrix> exact;
        std::optional<taut::impl::vertex_relaxation<Element>> relaxation;
        numbers rows;
    };

    std::unique_ptr<on_device> made_;
};

} // namespace taut::dist::impl
