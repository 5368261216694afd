// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <memory>
#include <numeric>
#include <span>
#include <vector>

#include <taut/impl/core/mesh/layout.hpp>
#include <taut/impl/core/objective/traced_element.hpp>
#include <taut/solve.hpp>
#include <taut/symbolic.hpp>

namespace taut::test
{

/// What map_objective<Element> computes on the device in double, computed on the host from the energy's double
/// instance: values directly, gradients by the chain rule through the evaluated derivative of E(S). Slow and plain.
template <class Element>
class reference_problem
{
public:
    static constexpr int D = Element::dimension;

    reference_problem(std::shared_ptr<const impl::layout<Element>> l, any_energy energy, energy::weighting weights)
        : layout_(std::move(l)), energy_(std::move(energy)), weight_(layout_->measure)
    {
        if (weights == energy::weighting::uniform) std::fill(weight_.begin(), weight_.end(), 1.0);
        weight_.resize(static_cast<std::size_t>(layout_->cell_count));
        const double total = std::accumulate(weight_.begin(), weight_.end(), 0.0);
        for (double& w : weight_) w /= total;
    }

    std::size_t size() const { return D * layout_->vertex_stride; }

    /// f(x); if g is not empty, also its gradient.
    double operator()(std::span<const double> x, std::span<double> g) const
    {
        std::fill(g.begin(), g.end(), 0.0);
        double sum = 0;
        for (std::size_t c = 0; c < weight_.size(); ++c)
        {
            const mat<D> W = inverse(c), S = edges(x, c) * W;
            const element<double, D> e{S, glm::determinant(S), layout_->measure[c]};
            if (energy_.barrier() && !(e.det > 0)) return std::numeric_limits<double>::infinity();
            sum += weight_[c] * energy_(e);
            if (!g.empty()) add_gradient(e, W, c, g);
        }
        return sum;
    }

private:
    std::size_t corner(std::size_t k, std::size_t c) const
    {
        return static_cast<std::size_t>(layout_->corners[k * layout_->cell_stride + c]);
    }

    mat<D> inverse(std::size_t c) const
    {
        mat<D> W(0.0);
        std::size_t entry = 0;
        for (int column = 0; column < D; ++column)
            for (int row = 0; row <= column; ++row)
                W[column][row] = layout_->inverse[entry++ * layout_->cell_stride + c];
        return W;
    }

    mat<D> edges(std::span<const double> x, std::size_t c) const
    {
        mat<D> A;
        for (int k = 0; k < D; ++k)
            for (int r = 0; r < D; ++r)
            {
                const auto at = [&](std::size_t corner_number)
                { return x[corner(corner_number, c) + static_cast<std::size_t>(r) * layout_->vertex_stride]; };
                A[k][r] = at(static_cast<std::size_t>(k) + 1) - at(0);
            }
        return A;
    }

    void add_gradient(const element<double, D>& e, const mat<D>& W, std::size_t c, std::span<double> g) const
    {
        // dE/dS by evaluating the traced derivative at this S, with det as a function of S.
        using real = sym<double>;
        tape recorded;
        const tape_scope scope(recorded);
        glm::mat<D, D, real> S;
        std::vector<real> unknowns;
        std::vector<binding> values;
        for (int k = 0; k < D; ++k)
            for (int r = 0; r < D; ++r)
            {
                unknowns.push_back(S[k][r] = real::variable());
                values.emplace_back(S[k][r], e.S[k][r]);
            }
        const real value = energy_(element<real, D>{S, glm::determinant(S), real(e.measure)});
        const auto partials = differentiate(value, unknowns);
        const auto p = evaluate(partials, values);
        mat<D> P;
        for (int k = 0; k < D; ++k)
            for (int r = 0; r < D; ++r) P[k][r] = p[static_cast<std::size_t>(k * D + r)];
        const mat<D> dA = P * glm::transpose(W);
        for (int k = 0; k < D; ++k)
            for (int r = 0; r < D; ++r)
            {
                const auto row = static_cast<std::size_t>(r) * layout_->vertex_stride;
                add(g, corner(static_cast<std::size_t>(k) + 1, c), row, weight_[c] * dA[k][r]);
                add(g, corner(0, c), row, -weight_[c] * dA[k][r]);
            }
    }

    void add(std::span<double> g, std::size_t vertex, std::size_t row, double value) const
    {
        if (vertex < static_cast<std::size_t>(layout_->free_count)) g[row + vertex] += value;
    }

    std::shared_ptr<const impl::layout<Element>> layout_;
    any_energy energy_;
    std::vector<double> weight_;
};

} // namespace taut::test
