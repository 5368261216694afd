// SPDX-License-Identifier: MIT
#pragma once

#include <taut/impl/core/sparse/multigrid.hpp>

namespace taut::impl
{

multigrid::multigrid(queue& q, scalar_type type, multigrid_plan plan)
{
    for (std::size_t l = 0; l < plan.patterns.size(); ++l)
    {
        levels_.emplace_back(block_matrix(q, type, std::move(plan.patterns[l]), plan.D, plan.form));
        auto& A = levels_[l].A;
        if (l > 0)
        {
            levels_[l].b = A.vector();
            levels_[l].x = A.vector();
            const auto lists = std::move(plan.transfers[l - 1]); // freed as soon as they are on the device
            transfers_.emplace_back(levels_[l - 1].A, lists, A);
        }
        A.forget_pattern();
    }
    const auto& last = levels_.back().A;
    const auto& params = plan.params;
    if (plan.active.size() * static_cast<std::size_t>(plan.D) <= params.dense_limit)
        coarsest_ = impl::dense_inverse(last, plan.active);
    constexpr std::size_t few = 2048; // rows; a product takes one core as long as a launch takes
    fused_ = last.form().lanes > 1 && levels() > 1 && solves_coarsest() && levels_[levels() - 2].A.rows() <= few;
    if (fused_)
        small_cycle_ = impl::transfer_kernel(last.queue(), "small_cycle", type, last.block_size(),
                                             transfers_.back().K(), last.form());
    // Chebyshev iteration on [lambda_max / ratio, lambda_max] (Saad, Iterative Methods, algorithm 12.1).
    const double low = params.lambda_max / params.lambda_ratio, middle = (params.lambda_max + low) / 2,
                 half = (params.lambda_max - low) / 2, sigma = middle / half;
    const double rho = 1 / (2 * sigma - 1 / sigma);
    first_ = 1 / middle;
    momentum_ = rho / sigma;
    second_ = 2 * rho / half;
}

std::size_t multigrid::launches() const noexcept
{
    const std::size_t single = levels() - (fused_ ? 2 : solves_coarsest() ? 1 : 0); // levels of separate launches
    if (!solves_coarsest()) return 6 * single - 2;
    return 6 * single + 1 + (single > 0 ? 1 : 0);
}

void multigrid::refresh()
{
    for (std::size_t l = 0; l < levels(); ++l)
    {
        if (l > 0) transfers_[l - 1].refresh(levels_[l - 1].A, levels_[l].A);
        if (l + 1 < levels() || !solves_coarsest()) levels_[l].A.invert_diagonal();
    }
    if (solves_coarsest()) coarsest_.refresh(levels_.back().A);
}

void multigrid::apply(const device_vector& b, device_vector& x)
{
    // The smoother's first step on the finest level; restriction makes it on the others.
    if (!is_small(0) && !is_solved(0)) levels_[0].A.jacobi(b, first_, levels_[0].y);
    cycle(0, b, x);
}

std::size_t multigrid::bytes() const
{
    std::size_t sum = coarsest_.bytes();
    for (const auto& t : transfers_) sum += t.bytes();
    for (const auto& l : levels_) sum += l.A.bytes() + l.b.data().bytes() + l.x.data().bytes() + l.y.data().bytes();
    return sum;
}

void multigrid::cycle(std::size_t l, const device_vector& b, device_vector& x)
{
    level& here = levels_[l];
    if (is_solved(l)) return coarsest_.apply(b, x);
    if (is_small(l)) return cycle_small(b, x);
    here.A.smooth(b, here.y, here.y, 1 + momentum_, 0, second_, x);
    if (l + 1 < levels())
    {
        level& coarse = levels_[l + 1];
        here.A.residual(x, b, here.y);
        transfers_[l].restrict_residual(here.y, coarse.A, first_, coarse.b, coarse.y);
        cycle(l + 1, coarse.b, coarse.x);
        transfers_[l].prolong(coarse.x, x);
    }
    here.A.smooth(b, x, x, 1, 0, first_, here.y);
    here.A.smooth(b, here.y, x, 1 + momentum_, -momentum_, second_, x);
}

void multigrid::cycle_small(const device_vector& b, device_vector& x)
{
    level &here = levels_[levels() - 2], &coarse = levels_.back();
    const auto& P = transfers_.back();
    const auto number = [](std::size_t n) { return static_cast<idx>(n); };
    small_cycle_({1, 1}, {{"rows", number(here.A.rows())},
                          {"stride", number(here.A.stride())},
                          {"coarse_stride", number(coarse.A.stride())},
                          {"size", coarsest_.size()},
                          {"pitch", coarsest_.pitch()},
                          {"first", first_},
                          {"momentum", momentum_},
                          {"second", second_},
                          {"offsets", here.A.offsets()},
                          {"columns", here.A.columns()},
                          {"A", here.A.values()},
                          {"inverse", here.A.inverse()},
                          {"prolongation", P.columns()},
                          {"weights", P.weights()},
                          {"at", coarsest_.at()},
                          {"dense_inverse", coarsest_.inverse()},
                          {"b", b.data()},
                          {"coarse_b", coarse.b.data()},
                          {"coarse_x", coarse.x.data()},
                          {"y", here.y.data()},
                          {"x", x.data()}});
}

} // namespace taut::impl
