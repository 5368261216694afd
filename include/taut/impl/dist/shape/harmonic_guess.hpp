// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <utility>
#include <vector>

#include <taut/impl/core/start/shape_path.hpp>
#include <taut/impl/dist/processes/fixed_sum.hpp>
#include <taut/impl/dist/shape/free_rows.hpp>
#include <taut/impl/dist/shape/pinned_bodies.hpp>

namespace taut::dist::impl
{

/// Initial guess of a shape with pinned vertices at their targets, where bodies of them rotate, by harmonic guidance as
/// harmonic_guess of one process: rotations, axis times angle, are harmonic between those of the bodies, and gradients
/// nearest to the rotations of the elements (Zayer et al. 2005, "Harmonic guidance for surface deformation"). Six
/// systems of one scalar Laplacian, by conjugate gradients with BoomerAMG.
template <class Element>
class harmonic_guess
{
public:
    static constexpr int D = Element::dimension;
    static constexpr std::size_t K = static_cast<std::size_t>(Element::corners);
    using point = vec<D>;
    using numbers = std::vector<double>; ///< D a vertex of the part

    /// pattern: of the part, null where it has no elements; from: the current shape, no element inverted. Referred to.
    harmonic_guess(const part<Element>& p, const fixed_part<Element>& held, const taut::impl::block_pattern* pattern,
                   const numbers& from)
        : part_(p), held_(held), pattern_(pattern)
    {
        for (const auto& c : p.corners)
        {
            mat<D> A;
            for (int k = 0; k < D; ++k) A[k] = at(from, c[static_cast<std::size_t>(k) + 1]) - at(from, c[0]);
            const mat<D> inverse = glm::transpose(glm::inverse(A));
            std::array<point, K> b{};
            for (int k = 0; k < D; ++k) b[static_cast<std::size_t>(k) + 1] = inverse[k], b[0] -= inverse[k];
            basis_.push_back(b);
            measure_.push_back(glm::determinant(A));
        }
        fill_entries();
    }

    /// Collective. The better of two where the sense of half turns is open. bodies: from the current shape.
    numbers operator()(const pinned_bodies<Element>& bodies, const numbers& from) const
    {
        auto [x, left] = guided(bodies, from, false);
        if (!bodies.half_turned()) return x;
        auto [other, more] = guided(bodies, from, true);
        return more < left ? other : x;
    }

    /// Collective. Whether an element is inverted, or shrunk to less than `least` in some direction.
    bool shrinks(const numbers& x, double least) const
    {
        bool any = false;
        for (std::size_t c = 0; c < basis_.size() && !any; ++c)
        {
            const mat<D> F = gradient(c, x);
            any = !(glm::determinant(F) > 0 && norm2(glm::inverse(F)) < D - 1 + 1 / (least * least));
        }
        return part_.all.any(any);
    }

private:
    static point at(const numbers& x, idx v)
    {
        point p;
        for (int k = 0; k < D; ++k) p[k] = x[static_cast<std::size_t>(D * v + k)];
        return p;
    }

    mat<D> gradient(std::size_t c, const numbers& x) const
    {
        mat<D> G(0.0);
        for (std::size_t k = 0; k < K; ++k) G += glm::outerProduct(at(x, part_.corners[c][k]), basis_[c][k]);
        return G;
    }

    /// The Laplacian at the places of the pattern.
    void fill_entries()
    {
        if (!pattern_) return;
        entries_.assign(pattern_->columns.size(), 0.0);
        for (std::size_t c = 0; c < basis_.size(); ++c)
            for (std::size_t k = 0; k < K; ++k)
            {
                const idx v = part_.corners[c][k];
                if (!part_.owns(v)) continue;
                const auto row = static_cast<std::size_t>(v);
                for (std::size_t j = 0; j < K; ++j)
                    entries_[pattern_->place(row, pattern_->find(row, part_.corners[c][j]))] +=
                        measure_[c] * glm::dot(basis_[c][k], basis_[c][j]);
            }
    }

    static constexpr double fine = 1e-4, rough = 1e-2; ///< gains of an initial guess, and of corrections to it

    std::pair<numbers, double> guided(const pinned_bodies<Element>& bodies, const numbers& from, bool other_way) const
    {
        const auto& whole = bodies.whole();
        numbers turns(3 * part_.size()), x(from.size());
        std::vector<char> told(part_.size(), 0), still(part_.size());
        for (std::size_t v = 0; v < part_.size(); ++v)
        {
            const auto turn = bodies.turn(v, other_way);
            const vec3 w = turn ? *turn : whole.angle * whole.axis;
            still[v] = held_.still(v);
            told[v] = turn.has_value() || (still[v] && !held_.pinned(v));
            const point p = held_.pinned(v) ? at(bodies.targets(), static_cast<idx>(v))
                            : still[v]      ? at(from, static_cast<idx>(v))
                                            : whole(at(from, static_cast<idx>(v)));
            for (std::size_t k = 0; k < 3; ++k) turns[3 * v + k] = w[static_cast<int>(k)];
            for (std::size_t k = 0; k < D; ++k) x[D * v + k] = p[static_cast<int>(k)];
        }
        fit shaped(*this, still);
        const auto smooth = [](std::size_t, std::size_t) { return point(0.0); };
        if (part_.all.any(told != still))
            fit(*this, told)(turns, 3, fine, smooth);
        else
            shaped(turns, 3, fine, smooth);
        std::vector<mat<D>> wanted; // rows: gradients of coordinates
        for (const auto& c : part_.corners)
        {
            vec3 mean(0.0);
            for (const idx v : c)
                for (int k = 0; k < 3; ++k) mean[k] += turns[static_cast<std::size_t>(3 * v + k)] / double(K);
            wanted.push_back(glm::transpose(taut::impl::rotation<D>(mean)));
        }
        const auto row = [&](std::size_t c, std::size_t k) { return wanted[c][static_cast<int>(k)]; };
        shaped(x, D, fine, row);
        // The elements' own rotations: steps of Sorkine and Alexa 2007, "As-rigid-as-possible surface modeling".
        for (int step = 0; step < 2; ++step)
        {
            for (std::size_t c = 0; c < wanted.size(); ++c)
                if (const mat<D> F = gradient(c, x); glm::determinant(F) > 0)
                    wanted[c] = glm::transpose(taut::impl::nearest_rotation<D>(F));
            shaped(x, D, rough, row);
        }
        fixed_sum left;
        for (std::size_t c = 0; c < basis_.size(); ++c)
            if (part_.counted[c]) left.add(measure_[c] * norm2(glm::transpose(gradient(c, x)) - wanted[c]));
        shared_sums sum(1);
        sum[0] = left;
        return {std::move(x), sum.totals(part_.all)[0]};
    }

    /// Fits values to gradients, where they may change: one matrix and its preconditioner, for any number of fits.
    class fit
    {
    public:
        fit(const harmonic_guess& of, const std::vector<char>& still)
            : of_(of), rows_(of.part_, of.pattern_, still, 1), r_(of.part_.own), change_(of.part_.own)
        {
            if (rows_.total() == 0) return;
            rows_.set([&](std::size_t, std::size_t, std::size_t place, const auto& put)
                      { put(0, 0, of.entries_[place]); });
            solver_ = of.make_solver(rows_);
            b_ = rows_.make_vector();
            x_ = rows_.make_vector();
        }

        /// u: `width` values a vertex. gain: of the residual. wanted(cell, component): a gradient.
        template <class Wanted>
        void operator()(numbers& u, std::size_t width, double gain, const Wanted& wanted)
        {
            if (rows_.total() == 0) return;
            require(KSPSetTolerances(solver_.get(), gain, PETSC_DEFAULT, PETSC_DEFAULT, 500));
            const auto& p = of_.part_;
            for (std::size_t k = 0; k < width; ++k)
            {
                std::fill(r_.begin(), r_.end(), 0.0);
                for (std::size_t c = 0; c < of_.basis_.size(); ++c)
                {
                    const auto& basis = of_.basis_[c];
                    point missing = wanted(c, k);
                    for (std::size_t j = 0; j < K; ++j)
                        missing -= u[width * static_cast<std::size_t>(p.corners[c][j]) + k] * basis[j];
                    for (std::size_t j = 0; j < K; ++j)
                        if (const idx v = p.corners[c][j]; p.owns(v))
                            r_[static_cast<std::size_t>(v)] += of_.measure_[c] * glm::dot(missing, basis[j]);
                }
                rows_.gather(r_, b_);
                require(KSPSolve(solver_.get(), b_.get(), x_.get()));
                rows_.scatter(x_, change_);
                for (std::size_t v = 0; v < p.own; ++v) u[width * v + k] += change_[v];
            }
            p.update(u, static_cast<int>(width));
        }

    private:
        const harmonic_guess& of_;
        free_rows rows_;
        petsc_solver solver_;
        petsc_vector b_, x_;
        numbers r_, change_;
    };

    petsc_solver make_solver(const free_rows& rows) const
    {
        KSP made = nullptr;
        require(KSPCreate(part_.all.raw(), &made));
        petsc_solver solver(made);
        require(PetscOptionsPrefixPush(nullptr, "taut_draft_"));
        require(PetscOptionsInsertString(
            nullptr, "-ksp_type cg -pc_type hypre -pc_hypre_type boomeramg -pc_hypre_boomeramg_coarsen_type HMIS "
                     "-pc_hypre_boomeramg_interp_type ext+i -pc_hypre_boomeramg_P_max 4 "
                     "-pc_hypre_boomeramg_relax_type_all symmetric-SOR/Jacobi"));
        require(PetscOptionsPrefixPop(nullptr));
        require(KSPSetOptionsPrefix(made, "taut_draft_"));
        require(KSPSetOperators(made, rows.matrix(), rows.matrix()));
        require(KSPSetFromOptions(made));
        return solver;
    }

    const part<Element>& part_;
    const fixed_part<Element>& held_;
    const taut::impl::block_pattern* pattern_;
    std::vector<std::array<point, K>> basis_; ///< gradients of the basis functions
    std::vector<double> measure_, entries_;   ///< times D!
};

} // namespace taut::dist::impl
