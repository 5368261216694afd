// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstddef>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <taut/evaluator.hpp>
#include <taut/impl/core/objective/element_hessian.hpp>
#include <taut/impl/core/objective/map_objective.hpp>
#include <taut/impl/core/sparse/block_assembly.hpp>

namespace taut::impl
{

/// Device objective of a map in the user's order and units, and its Hessian, whose data are made on first use.
template <class Element>
class map_evaluation
{
public:
    static constexpr int D = Element::dimension;
    using points = std::span<const vec<D>>;

    /// Throws mesh_error for degenerate cells, parameter_error, device_error.
    map_evaluation(queue q, const mesh<Element>& m, const any_energy& energy, energy::weighting weights, precision how,
                   const cell_data& data)
        : queue_(std::move(q)),
          energy_(energy.with_data(data.mean_attributes(), !data.directions.empty())),
          weights_(weights),
          types_(types_of(how)),
          layout_(with_data(m, data)),
          cells_(permute(m, layout_->order).cells()),
          objective_(queue_, layout_, energy_, weights, types_),
          x_(objective_.make_point()),
          g_(objective_.space().make())
    {
    }

    /// Value f(x); infinity where the energy is a barrier and an element is not positive. x: one point per vertex.
    double value(points x)
    {
        upload(x);
        return objective_.value(x_);
    }

    /// The same, and its gradient, one vector per vertex. Throws parameter_error for another number of them.
    double value_gradient(points x, std::span<vec<D>> gradient)
    {
        require(gradient.size(), "gradient");
        upload(x);
        const double value = objective_.value_gradient(x_, g_);
        const auto local = g_.download();
        for (std::size_t v = 0; v < gradient.size(); ++v)
            for (int k = 0; k < D; ++k)
                gradient[old_vertex(v)][k] =
                    local[static_cast<std::size_t>(k) * layout_->vertex_stride + v] * layout_->scale;
        return value;
    }

    /// Hessian at x, or the projected one (positive semi-definite element by element).
    block_rows<D> hessian(points x, definiteness sign)
    {
        upload(x);
        if (!second_) second_.emplace(queue_, energy_, weights_, types_, *layout_, cells_);
        const auto& kernel = second_->kernel;
        kernel.launch({layout_->cell_stride, layout<Element>::step},
                      second_->arrays.with(x_.data(), {kernel.as_argument(sign), {"hessian", second_->elements}}));
        second_->assemble(second_->elements, second_->matrix);
        return rows();
    }

    /// Maximum step a for which no element flips on [x, x + a d); infinity if none ever does.
    double max_step(points x, points d)
    {
        require(d.size(), "d");
        upload(x);
        auto local = layout_->to_local({d.begin(), d.end()});
        g_.upload(local);
        return objective_.max_step(x_, g_);
    }

private:
    /// Data for the Hessian, made on first use.
    struct second_order
    {
        element_hessian_kernel<Element> kernel;
        element_arrays<Element> arrays;
        real_buffer elements;
        block_matrix matrix;
        block_assembly assemble;

        second_order(queue& q, const any_energy& energy, energy::weighting weights, const real_types& types,
                     const layout<Element>& l, const std::vector<typename mesh<Element>::cell>& cells)
            : kernel(q, energy, types),
              arrays(q, types.vector, l, weights, energy),
              elements(q, types.vector, hessian_slots<D>::count * l.cell_stride),
              matrix(q, types.vector,
                     pattern_of_cells(cells, static_cast<std::size_t>(l.vertex_count),
                                      lane_form::for_device(q.device()).slice),
                     D),
              assemble(matrix, assembly_lists(matrix.pattern(), D, cells, l.cell_stride))
        {
        }
    };

    static std::shared_ptr<const layout<Element>> with_data(const mesh<Element>& m, const cell_data& data)
    {
        data.validate(m.cells().size());
        auto l = std::make_shared<layout<Element>>(m);
        l->attach(data.reordered(l->order.cells), permute(m, l->order));
        return l;
    }

    void require(std::size_t n, const char* what) const
    {
        const auto vertices = static_cast<std::size_t>(layout_->vertex_count);
        if (n != vertices)
            throw parameter_error(what, std::to_string(n) + " of them for " + std::to_string(vertices) + " vertices");
    }

    void upload(points x)
    {
        require(x.size(), "x");
        objective_.upload({x.begin(), x.end()}, x_);
    }

    std::size_t old_vertex(std::size_t v) const
    {
        return static_cast<std::size_t>(layout_->order.vertices.new_to_old[v]);
    }

    /// The matrix in the user's order and units.
    block_rows<D> rows() const
    {
        const auto values = second_->matrix.download();
        const auto& pattern = second_->matrix.pattern();
        const std::size_t n = pattern.rows();
        const double unit = layout_->scale * layout_->scale;
        block_rows<D> result;
        result.offsets.push_back(0);
        std::vector<std::pair<idx, std::size_t>> row; // column and place
        for (std::size_t old = 0; old < n; ++old)
        {
            const auto r = static_cast<std::size_t>(layout_->order.vertices.old_to_new[old]);
            row.clear();
            for (std::size_t j = 0; j < pattern.length(r); ++j)
                row.emplace_back(static_cast<idx>(old_vertex(static_cast<std::size_t>(pattern.column(r, j)))),
                                 pattern.place(r, j));
            std::sort(row.begin(), row.end());
            for (const auto& [column, place] : row)
            {
                mat<D> block;
                for (int i = 0; i < D; ++i)
                    for (int j = 0; j < D; ++j)
                        block[j][i] = unit * values[place * D * D + static_cast<std::size_t>(i * D + j)];
                result.columns.push_back(column);
                result.blocks.push_back(block);
            }
            result.offsets.push_back(static_cast<idx>(result.columns.size()));
        }
        return result;
    }

    queue queue_;
    any_energy energy_;
    energy::weighting weights_;
    real_types types_;
    std::shared_ptr<const layout<Element>> layout_;
    std::vector<typename mesh<Element>::cell> cells_;
    map_objective<Element> objective_;
    device_vector x_, g_;
    std::optional<second_order> second_;
};

} // namespace taut::impl

namespace taut
{

template <class Element>
struct map_evaluator<Element>::state : impl::map_evaluation<Element>
{
    using impl::map_evaluation<Element>::map_evaluation;
};

template <class Element>
map_evaluator<Element>::map_evaluator(queue q, const mesh<Element>& m, const any_energy& energy,
                                      energy::weighting weights, precision how, const cell_data& data)
    : state_(std::make_unique<state>(std::move(q), m, energy, weights, how, data))
{
}

template <class Element>
map_evaluator<Element>::map_evaluator(map_evaluator&&) noexcept = default;

template <class Element>
map_evaluator<Element>& map_evaluator<Element>::operator=(map_evaluator&&) noexcept = default;

template <class Element>
map_evaluator<Element>::~map_evaluator() = default;

template <class Element>
double map_evaluator<Element>::value(points x)
{
    return state_->value(x);
}

template <class Element>
double map_evaluator<Element>::value_gradient(points x, std::span<vec<D>> gradient)
{
    return state_->value_gradient(x, gradient);
}

template <class Element>
block_rows<map_evaluator<Element>::D> map_evaluator<Element>::hessian(points x, definiteness sign)
{
    return state_->hessian(x, sign);
}

template <class Element>
double map_evaluator<Element>::max_step(points x, points d)
{
    return state_->max_step(x, d);
}

} // namespace taut
