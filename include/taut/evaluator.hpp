// SPDX-License-Identifier: MIT
#include <taut/impl/enter.inl>
#if TAUT_OPEN == 1 // the parts that its calls need
#define TAUT_PART_VOLUME
#endif
#ifndef TAUT_EVALUATOR_HPP
#define TAUT_EVALUATOR_HPP

#include <memory>
#include <span>
#include <vector>

#include <taut/any_energy.hpp>
#include <taut/cell_data.hpp>
#include <taut/device_vectors.hpp>
#include <taut/energies.hpp>
#include <taut/mesh.hpp>
#include <taut/options.hpp>
#include <taut/queue.hpp>

/// The objective of a map as a function of your own: values, gradients, Hessians.
///
///     map_evaluator<triangle> f(q, surface, energy::isometric{});
///     std::vector<vec2> g(uv.size());
///     const double value = f.value_gradient(uv, g);
///     const auto H = f.hessian(uv, definiteness::projected);     // matrix_of(H) of <taut/eigen.hpp>
namespace taut
{

/// A square matrix of D x D blocks by rows (CSR): block k of row r, in column columns[k], for k = offsets[r] ..
/// offsets[r + 1] - 1, columns ascending; entry (i, j) of a block is blocks[k][j][i], as GLM has it.
template <int D>
struct block_rows
{
    std::vector<idx> offsets, columns;
    std::vector<mat<D>> blocks;
};

/// Evaluator of the energy, gradient and Hessian of a map, for solvers of your own:
///
///     f(x) = sum over cells of w_c E(S_c(x)) / sum of w_c
///
/// in the user's order and units, calculated on the device. Nothing is pinned. Not for use by two threads at once.
template <class Element>
class map_evaluator
{
public:
    static constexpr int D = Element::dimension;

    /// One point per vertex.
    using points = std::span<const vec<D>>;

    /// how: fp64, mixed or fp32. data: numbers and directions of the cells, which the energy reads. Throws mesh_error
    /// for degenerate cells, parameter_error, device_error.
    map_evaluator(queue q, const mesh<Element>& m, const any_energy& energy,
                  energy::weighting weights = energy::weighting::measure, precision how = precision::fp64,
                  const cell_data& data = {});
    map_evaluator(map_evaluator&&) noexcept;
    map_evaluator& operator=(map_evaluator&&) noexcept;
    ~map_evaluator();

    /// Value f(x); infinity where the energy is a barrier and an element is not positive. Throws parameter_error for
    /// another number of points than vertices.
    double value(points x);

    /// The same, and its gradient, one vector per vertex.
    double value_gradient(points x, std::span<vec<D>> gradient);

    /// Hessian at x, or the projected one (positive semi-definite element by element).
    block_rows<D> hessian(points x, definiteness sign = definiteness::indefinite);

    /// Maximum step a for which no element flips on [x, x + a d); infinity if none ever does.
    double max_step(points x, points d);

private:
    struct state;
    std::unique_ptr<state> state_;
};

} // namespace taut

#include <taut/impl/core/objective/map_evaluator.hpp> // bodies

#endif
#include <taut/impl/leave.inl>
