// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <functional>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include <taut/elements.hpp>
#include <taut/impl/core/compute/vector_space.hpp>
#include <taut/impl/core/core/parallel.hpp>
#include <taut/impl/core/objective/patch_cells.hpp>
#include <taut/impl/core/objective/plane_newton.hpp>

namespace taut::impl
{

/// Nonlinear elimination: minimises the map of a surface in patches where it is farthest from quadratic, each
/// separately with all around it fixed (Lanzkron, Rose, Wilkes 1996; Cai, Keyes 2002). Creases and rotations between
/// pins are far from quadratic, but small; with one step length for the whole map the hardest of them would decide.
///
/// A step is Newton's with a direct solver on the host: along the Hessian where it is positive definite, else along its
/// projection, to the best of four lengths, none beyond 0.9 of the way to the first flip. Formulas are those of the
/// kernels of the mesh. The energy decreases, no element flips, and vertices outside of patches keep their positions
/// bit for bit.
///
/// Costs two or three waits per step, and some tenths of a microsecond per triangle of the patches.
class nonlinear_elimination
{
    static constexpr int D = triangle::dimension;

public:
    /// Refers to the kernels. arrays: of the mesh, whose parameters of the energy are read at each call. still: one
    /// flag per vertex in the user's numbers, or none; these are not moved, as they have constraints besides the
    /// energy.
    nonlinear_elimination(const queue& q, std::shared_ptr<const layout<triangle>> mesh_layout,
                          std::shared_ptr<const element_arrays<triangle>> arrays,
                          const element_kernels<triangle>& first, const element_hessian_kernel<triangle>& second,
                          const real_types& types, energy::weighting weights, const any_energy& energy,
                          const std::vector<bool>& still = {})
        : queue_(q),
          layout_(std::move(mesh_layout)),
          arrays_(std::move(arrays)),
          first_(first),
          second_(second),
          types_(types),
          weights_(weights),
          energy_(energy)
    {
        keep_still(still);
    }

    /// Replaces the flags of vertices that are not moved, as in the constructor.
    void keep_still(const std::vector<bool>& still)
    {
        barred_.assign(at(layout_->vertex_count), 0);
        for (std::size_t v = 0; v < still.size(); ++v)
            if (still[v]) barred_[at(layout_->order.vertices.old_to_new[v])] = 1;
    }

    /// Minimises x around the vertices where the vectors of `unexpected`, the difference of the gradient from the
    /// model's after a step, are longest. proceed() is called between steps. Returns whether x moved.
    bool operator()(device_vector& x, const device_vector& unexpected, const std::function<bool()>& proceed);

private:
    using patch = impl::patch<triangle>;
    using patch_cells = impl::patch_cells<triangle>;
    using solver = impl::front_cholesky;
    static constexpr int most_steps = 15;
    static constexpr std::size_t trials = patch_cells::trials;

    static std::size_t at(idx i) { return static_cast<std::size_t>(i); }

    std::vector<patch> find(const std::vector<double>& vectors) const;

    std::vector<vec<D>> coordinates(const std::vector<double>& places, const std::vector<idx>& vertices) const
    {
        std::vector<vec<D>> x;
        for (const idx v : vertices) x.push_back({places[at(v)], places[layout_->vertex_stride + at(v)]});
        return x;
    }

    /// State of the minimisation of one patch.
    class minimisation
    {
    public:
        minimisation(const patch& p, std::size_t first_cell, std::vector<vec<D>> x)
            : patch_(&p), first_cell_(first_cell), x_(std::move(x)), d_(x_.size(), vec<D>(0.0))
        {
        }

        /// Starts the patch, before all other calls.
        void prepare() { solver_.emplace(patch_->cells, patch_->fixed); }

        std::size_t first_cell() const { return first_cell_; }
        bool done() const { return done_; }
        /// Returns whether its next step is to be along the Hessian itself.
        bool exact() const { return !done_ && pause_ <= 0; }
        const std::vector<vec<D>>& x() const { return x_; }
        /// Maximum trial step, as a vector per vertex; 0 where the patch is done.
        const std::vector<vec<D>>& d() const { return d_; }

        solver& factors() { return *solver_; }

        /// Computes the direction d() by the factors, of the Hessian itself if `exact`.
        void direct(const std::vector<double>& gradients, std::size_t stride, bool exact);

        /// Moves to the best of x + steps[k] d by the energies there and at x.
        void choose(const std::vector<double>& energies, std::size_t stride, const std::array<double, trials>& steps);

        /// Writes the positions of its vertices; returns whether any has moved.
        bool put(std::vector<double>& places, std::size_t stride) const
        {
            if (!moved_) return false;
            for (std::size_t v = 0; v < x_.size(); ++v)
                for (std::size_t k = 0; k < D && !patch_->fixed[v]; ++k)
                    places[k * stride + at(patch_->vertices[v])] = x_[v][static_cast<int>(k)];
            return true;
        }

    private:
        static constexpr int patience = 2; // steps along the projected Hessian before the Hessian is tried again

        void finish()
        {
            done_ = true;
            std::fill(d_.begin(), d_.end(), vec<D>(0.0));
        }

        std::vector<vec<D>> forces(const std::vector<double>& gradients, std::size_t stride) const
        {
            std::vector<vec<D>> force(x_.size(), vec<D>(0.0));
            for (std::size_t c = 0; c < patch_->cells.size(); ++c)
                for (std::size_t k = 0; k < triangle::corners; ++k)
                    for (std::size_t i = 0; i < D; ++i)
                        force[at(patch_->cells[c][k])][static_cast<int>(i)] -=
                            gradients[(k * D + i) * stride + first_cell_ + c];
            for (std::size_t v = 0; v < force.size(); ++v)
                if (patch_->fixed[v]) force[v] = vec<D>(0.0);
            return force;
        }

        const patch* patch_;
        std::size_t first_cell_; // among those of all patches
        std::vector<vec<D>> x_, d_;
        std::optional<solver> solver_;
        double slope_ = 0, most_ = 0; // along d_; the largest decrease so far
        int pause_ = 0;               // steps until the Hessian itself is tried
        bool exact_ = false, done_ = false, moved_ = false;
    };

    /// Makes a step of every patch that is not done; returns false if there is none.
    bool advance(std::vector<minimisation>& all, patch_cells& cells);

    /// Computes the directions of some patches; none where the Hessian is not positive definite.
    static void direct(const std::vector<minimisation*>& some, const patch_cells& cells, bool exact);

    static std::vector<vec<D>> joined(const std::vector<minimisation>& all,
                                      const std::vector<vec<D>>& (minimisation::*part)() const)
    {
        std::vector<vec<D>> values;
        for (const auto& m : all) values.insert(values.end(), (m.*part)().begin(), (m.*part)().end());
        return values;
    }

    queue queue_;
    std::shared_ptr<const layout<triangle>> layout_;
    std::shared_ptr<const element_arrays<triangle>> arrays_;
    const element_kernels<triangle>& first_;
    const element_hessian_kernel<triangle>& second_;
    real_types types_;
    energy::weighting weights_;
    any_energy energy_;
    std::vector<char> barred_; // by vertex
};

} // namespace taut::impl
