// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstddef>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include <taut/impl/charts/paste/rbf_evaluator.hpp>
#include <taut/impl/charts/paste/rbf_system.hpp>

namespace taut::impl
{

/// Chooses at most `most` of these, evenly.
inline std::vector<idx> some_of(std::span<const idx> all, idx most)
{
    const std::size_t n = std::min(all.size(), static_cast<std::size_t>(most));
    std::vector<idx> some;
    for (std::size_t i = 0; i < n; ++i) some.push_back(all[i * all.size() / n]);
    return some;
}

/// Displacement field of points with moving and fixed control points. Factored once; a displacement costs a
/// back-substitution and a kernel.
class bending
{
public:
    bending() = default; ///< of no point

    /// moving, staying: control points; bent: points to be displaced.
    bending(queue& q, std::vector<vec3> moving, std::span<const vec3> staying, std::span<const vec3> bent,
            rbf_basis basis)
        : moving_(moving.size()),
          all_(moving.size() + staying.size()),
          solver_(rbf_system(joined(std::move(moving), staying), {.basis = basis})),
          evaluate_(q, solver_->solve(std::vector<vec3>(all_, vec3(0.0))), bent)
    {
    }

    /// Computes the field for displacements of the moving controls. Throws as rbf::solve.
    rbf_field field(std::span<const vec3> moves) const
    {
        std::vector<vec3> values(moves.begin(), moves.end());
        values.resize(all_, vec3(0.0));
        return solver_->solve(values);
    }

    /// Displacement of each point.
    std::vector<vec3> operator()(const rbf_field& field) { return evaluate_(field); }

    explicit operator bool() const { return solver_.has_value(); }
    const rbf_system& solver() const { return *solver_; }
    std::size_t moving() const { return moving_; }

private:
    static std::vector<vec3> joined(std::vector<vec3> moving, std::span<const vec3> staying)
    {
        moving.insert(moving.end(), staying.begin(), staying.end());
        return moving;
    }

    std::size_t moving_ = 0, all_ = 0;
    std::optional<rbf_system> solver_;
    rbf_evaluator evaluate_;
};

} // namespace taut::impl
