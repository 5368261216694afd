// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstddef>
#include <functional>
#include <limits>
#include <memory>
#include <mutex>
#include <span>
#include <utility>
#include <vector>

#include <taut/impl/core/constrain/point_constraints.hpp>
#include <taut/impl/core/core/parallel.hpp>
#include <taut/impl/core/untangle/target_shapes.hpp>

namespace taut::impl
{

/// Objective of Newton's method in untangling: the sum over elements of weight * energy::regularized, plus springs.
template <class Element>
struct regularized_problem
{
    static constexpr int D = Element::dimension;

    const mesh<Element>& rest;                   ///< referred to
    const fixed_marks<D>& held;                  ///< these coordinates are not moved; referred to
    std::vector<impl::target_shape<D>> shapes{}; ///< one per element
    double area_weight = 1;                      ///< of det + 1 / det against the shape
    std::vector<directed_spring<D>> springs{};
    std::span<const idx> owners{}; ///< as in untangle_problem, which the state fills in; referred to
};

/// Steps of Newton's method on a regularised energy, with the Hessian of each element projected to positive
/// semi-definite, so that every step descends.
template <class Element>
class regularized_newton
{
public:
    static constexpr int D = Element::dimension;
    using map = std::vector<vec<D>>;

    explicit regularized_newton(regularized_problem<Element> problem)
        : springs(std::move(problem.springs)),
          cells_(problem.rest.cells()),
          shapes_(std::move(problem.shapes)),
          area_weight_(problem.area_weight)
    {
    }
    virtual ~regularized_newton() = default;
    regularized_newton(const regularized_newton&) = delete;
    regularized_newton& operator=(const regularized_newton&) = delete;

    double eps = 0;                          ///< 0: the energy is a barrier
    std::vector<directed_spring<D>> springs; ///< other stiffnesses and targets may be set
    std::function<bool()> proceed;           ///< asked within a step, if given; once it says no, nothing moves

    virtual double value(const map& x) = 0;

    /// One step from x with decrease; returns the new value, or the old one if no step decreases it.
    virtual double step(map& x, double here) = 0;

    double last_length() const { return length_; } ///< of the last step, in Newton steps

    /// Smallest det S.
    double least_det(const map& x) const
    {
        std::mutex guard;
        double least = std::numeric_limits<double>::infinity();
        parallel_for(
            cells_.size(),
            [&](std::size_t begin, std::size_t end)
            {
                double here = std::numeric_limits<double>::infinity();
                for (std::size_t c = begin; c < end; ++c) here = std::min(here, glm::determinant(mapped(x, c)));
                const std::scoped_lock lock(guard);
                least = std::min(least, here);
            },
            0, 4096);
        return least;
    }

    /// Measure of the inverted elements as a fraction of the target measure of all.
    double inverted_measure(const map& x) const
    {
        double sum = 0;
        for (std::size_t c = 0; c < cells_.size(); ++c)
            sum += std::max(0.0, -glm::determinant(mapped(x, c))) * shapes_[c].weight;
        return sum;
    }

protected:
    mat<D> mapped(const map& x, std::size_t c) const
    {
        return shape_matrix<D>(cells_[c], std::span<const vec<D>>(x), shapes_[c].inverse);
    }

    std::span<const typename mesh<Element>::cell> cells_;
    std::vector<impl::target_shape<D>> shapes_;
    double area_weight_;
    double length_ = 0;
};

/// Factory of device objectives. Null where there is none for the element.
template <class Element>
using newton_maker = std::function<std::unique_ptr<regularized_newton<Element>>(regularized_problem<Element> problem)>;

} // namespace taut::impl
