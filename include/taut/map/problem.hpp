// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <memory>
#include <span>
#include <vector>

#include <taut/compute/gather.hpp>
#include <taut/compute/vector_space.hpp>
#include <taut/map/element_kernels.hpp>
#include <taut/map/layout.hpp>

namespace taut
{

/// The distortion of a map of a mesh as an objective for the solvers (solve/objective.hpp), evaluated on a device:
///
///     f(x) = sum over cells of w_c E(S_c(x)) / sum of w_c
///
/// with w_c = 1 or the rest measure. A point holds the coordinates of all vertices in layout order, D x vertex_stride,
/// in P; vectors have the same shape in R and are zero on pinned vertices, so that those never move.
/// Kernels per evaluation: elements, gather (paper Fig. 8), one reduction; one host wait.
template <class Element, class P, class R>
class problem
{
public:
    static constexpr int D = Element::dimension;
    using space_type = device_vectors<R>;
    using vector = typename space_type::vector;
    using point = device_vector<P>;

    problem(queue q, std::shared_ptr<const layout<Element>> mesh_layout, const any_energy& energy,
            energy::weighting weights)
        : queue_(std::move(q)),
          layout_(std::move(mesh_layout)),
          space_(queue_, D * layout_->vertex_stride),
          reductions_(queue_),
          kernels_(queue_, energy),
          corners_(queue_, layout_->corners),
          inverse_(queue_, to<R>(layout_->inverse)),
          measure_(queue_, to<R>(layout_->measure)),
          weight_(queue_, to<R>(cell_weights(weights))),
          energies_(queue_, element_kernels<Element, P, R>::trials * layout_->cell_stride),
          corner_gradients_(queue_, (D + 1) * D * layout_->cell_stride),
          gather_(make_gather()),
          gradient_scale_(characteristic_gradient(energy, weights))
    {
    }

    const space_type& space() const { return space_; }
    const taut::layout<Element>& layout() const { return *layout_; }
    point make_point() const { return space_.template make_points<P>(); }
    void copy(const point& x, point& y) const { space_.copy(x, y); }
    void step(const point& x, double a, const vector& d, point& out) const { space_.step(x, a, d, out); }

    /// Coordinates in the user's order and units, to the device and back.
    void upload(const std::vector<vec<D>>& x, point& p) const { p.upload(to<P>(layout_->to_local(x))); }
    std::vector<vec<D>> download(const point& p) const { return layout_->to_user(to<double>(p.download())); }

    double value(const point& x)
    {
        kernels_.value(cells(), corners_, inverse_, measure_, weight_, x.data(), energies_, cell_stride(),
                       vertex_stride());
        return summed();
    }

    double value_gradient(const point& x, vector& g)
    {
        kernels_.gradient(cells(), corners_, inverse_, measure_, weight_, x.data(), energies_, corner_gradients_,
                          cell_stride(), vertex_stride());
        gather_(corner_gradients_, g.data());
        return summed();
    }

    /// f at x + a[i] d, four step lengths a launch, one wait in all.
    void values(const point& x, const vector& d, std::span<const double> a, std::span<double> out)
    {
        constexpr std::size_t batch = element_kernels<Element, P, R>::trials;
        std::vector<reductions::result> sums;
        for (std::size_t first = 0; first < a.size(); first += batch)
        {
            const auto step = [&](std::size_t k) { return static_cast<R>(a[std::min(first + k, a.size() - 1)]); };
            kernels_.along(cells(), corners_, inverse_, measure_, weight_, x.data(), d.data(), energies_, cell_stride(),
                           vertex_stride(), step(0), step(1), step(2), step(3));
            // Commands run in order: the next launch overwrites the energies after they are summed.
            sums.push_back(reductions_.sum(energies_, {.count = std::min(batch, a.size() - first),
                                                       .length = static_cast<std::size_t>(layout_->cell_count),
                                                       .stride = layout_->cell_stride}));
        }
        if (!sums.empty()) reductions_.fetch();
        for (std::size_t i = 0; i < a.size(); ++i) out[i] = reductions_.value(sums[i / batch], i % batch);
    }

    /// The largest a for which no element has flipped anywhere on [x, x + a d); infinity if none ever does.
    double max_step(const point& x, const vector& d)
    {
        kernels_.first_flips(cells(), corners_, x.data(), d.data(), energies_, cell_stride(), vertex_stride());
        const auto least = reductions_.minimum(energies_, static_cast<std::size_t>(layout_->cell_count));
        reductions_.fetch();
        return reductions_.value(least);
    }

    /// Launches every kernel once, so that what the driver compiles at the first launch is compiled: those of the
    /// elements, and the vector operations in the shapes in which the solvers ask for them.
    void warm_up(const point& x)
    {
        auto g = space_.make(), d = space_.make();
        auto y = make_point();
        value_gradient(x, g);
        value(x);
        max_step(x, g);
        const double a[8] = {};
        double e[15];
        values(x, g, std::span(a).first(1), e);

        const vector* const v[8] = {&g, &g, &g, &g, &g, &g, &g, &g};
        for (const std::size_t n : {2, 4, 8}) space_.linear_combination(std::span(a, n), std::span(v, n), d);
        space_.axpby(0, g, 0, d);
        space_.dot(g, g);
        space_.multi_dot(std::span(v, 3), std::span(v, 5), e);
        step(x, 0, d, y);
        queue_.finish();
    }

    /// Norm of a gradient that is typical of the mesh: the same relative gradient then means the same on every mesh and
    /// scale. After Zhu, Bridson, Kaufman 2018 ("Blended cured quasi-Newton"), section 4.
    double gradient_scale(const point&) const { return gradient_scale_; }

    /// Relative rounding error of a value: sums are in double, and the errors of many elements average out.
    double rounding() const { return std::is_same_v<R, double> ? 1e-14 : 1e-8; }

private:
    template <class To, class From>
    static std::vector<To> to(const std::vector<From>& values)
    {
        return {values.begin(), values.end()};
    }

    range cells() const { return {layout_->cell_stride, taut::layout<Element>::step}; }
    index cell_stride() const { return static_cast<index>(layout_->cell_stride); }
    index vertex_stride() const { return static_cast<index>(layout_->vertex_stride); }

    /// Rows of free vertices only: the others get zero.
    gather<R> make_gather()
    {
        const auto& corners = layout_->vertex_corners;
        const auto rows = static_cast<std::size_t>(layout_->free_count);
        const auto used = static_cast<std::size_t>(corners.offsets[rows]);
        std::vector<index> cell(used), corner(used);
        for (std::size_t k = 0; k < used; ++k)
        {
            cell[k] = corners.items[k] / Element::corners;
            corner[k] = corners.items[k] % Element::corners;
        }
        return gather<R>(
            queue_, std::span(corners.offsets).first(rows + 1), cell, corner,
            {.components = D, .cell_stride = layout_->cell_stride, .vertex_stride = layout_->vertex_stride});
    }

    double summed()
    {
        const auto sum = reductions_.sum(energies_, {.length = static_cast<std::size_t>(layout_->cell_count)});
        reductions_.fetch();
        return reductions_.value(sum);
    }

    /// w_c / sum of w_c.
    std::vector<double> cell_weights(energy::weighting weights) const
    {
        std::vector<double> w = layout_->measure;
        if (weights == energy::weighting::uniform) std::fill(w.begin(), w.end(), 1.0);
        const auto n = static_cast<std::ptrdiff_t>(layout_->cell_count);
        const double total = std::accumulate(w.begin(), w.begin() + n, 0.0);
        for (auto& v : w) v /= total;
        return w;
    }

    /// 2 lambda |l|, where l_v = sum over cells at v of w_c |grad phi_v| and lambda is the largest eigenvalue of the
    /// energy's Hessian at rest (8 for the isometric energy in the plane, which makes the factor 16).
    double characteristic_gradient(const any_energy& energy, energy::weighting weights) const
    {
        const auto w = cell_weights(weights);
        std::vector<double> l(static_cast<std::size_t>(layout_->vertex_count), 0.0);
        const auto stride = layout_->cell_stride;
        for (std::size_t c = 0; c < static_cast<std::size_t>(layout_->cell_count); ++c)
        {
            // Rows of W^-1 are the gradients of the basis functions of corners 1..D; corner 0 has minus their sum.
            vec<D> sum(0.0);
            for (int k = 0; k < D; ++k)
            {
                vec<D> row(0.0);
                for (int column = k; column < D; ++column)
                    row[column] =
                        layout_->inverse[static_cast<std::size_t>(column * (column + 1) / 2 + k) * stride + c];
                sum += row;
                l[corner(static_cast<std::size_t>(k) + 1, c)] += w[c] * glm::length(row);
            }
            l[corner(0, c)] += w[c] * glm::length(sum);
        }
        double squares = 0;
        for (const double v : l) squares += v * v;
        return 2 * stiffness(energy) * std::sqrt(squares);
    }

    std::size_t corner(std::size_t k, std::size_t cell) const
    {
        return static_cast<std::size_t>(layout_->corners[k * layout_->cell_stride + cell]);
    }

    /// Largest curvature of the energy at the identity along single entries of S and the dilation, by differences.
    static double stiffness(const any_energy& energy)
    {
        const auto at = [&](const mat<D>& S) { return energy(element<double, D>{S, glm::determinant(S), 1.0}); };
        // At a kink the quotient grows as 1/h: such an energy has no stiffness, and 1 is as good as any.
        const double coarse = stiffness(at, 1e-3), fine = stiffness(at, 1e-4);
        return coarse > 0 && std::isfinite(fine) && fine < 2 * coarse ? fine : 1;
    }

    template <class Function>
    static double stiffness(const Function& at, double h)
    {
        double most = 0;
        const auto probe = [&](const mat<D>& direction)
        {
            const mat<D> I(1.0);
            const double second = (at(I + h * direction) - 2 * at(I) + at(I - h * direction)) / (h * h);
            most = std::max(most, second / norm2(direction));
        };
        probe(mat<D>(1.0));
        for (int c = 0; c < D; ++c)
            for (int r = 0; r < D; ++r)
            {
                mat<D> direction(0.0);
                direction[c][r] = 1;
                direction[r][c] = 1;
                probe(direction);
            }
        return most;
    }

    queue queue_;
    std::shared_ptr<const taut::layout<Element>> layout_;
    space_type space_;
    reductions reductions_;
    element_kernels<Element, P, R> kernels_;
    buffer<index> corners_;
    buffer<R> inverse_, measure_, weight_;
    buffer<R> energies_, corner_gradients_;
    gather<R> gather_;
    double gradient_scale_;
};

} // namespace taut
