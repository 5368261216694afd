// SPDX-License-Identifier: MIT
#pragma once

#include <numeric>

#include <taut/impl/core/energy/definiteness.hpp>
#include <taut/impl/core/objective/nonlinear_elimination.hpp>

namespace taut::impl
{

bool nonlinear_elimination::operator()(device_vector& x, const device_vector& unexpected,
                                       const std::function<bool()>& proceed)
{
    const auto patches = find(unexpected.download());
    if (patches.empty()) return false;
    auto places = x.download();
    patch_cells cells(queue_, *layout_, patches, first_, second_, types_, weights_, energy_, arrays_->parameters);
    std::vector<minimisation> all;
    all.reserve(patches.size());
    std::size_t first_cell = 0;
    for (const auto& p : patches)
    {
        all.emplace_back(p, first_cell, coordinates(places, p.vertices));
        first_cell += p.cells.size();
    }
    if (!proceed()) return false;
    parallel_for(
        all.size(),
        [&](std::size_t begin, std::size_t end)
        {
            for (std::size_t i = begin; i < end; ++i) all[i].prepare();
        },
        0, 1);
    for (int step = 0; step < most_steps && proceed(); ++step)
        if (!advance(all, cells)) break;

    bool moved = false;
    for (const minimisation& m : all) moved |= m.put(places, layout_->vertex_stride);
    if (moved) x.upload(places);
    return moved;
}

std::vector<nonlinear_elimination::patch> nonlinear_elimination::find(const std::vector<double>& vectors) const
{
    std::vector<double> squares(at(layout_->free_count), 0.0);
    for (std::size_t v = 0; v < squares.size(); ++v)
        for (std::size_t k = 0; k < D; ++k)
        {
            const double entry = vectors[k * layout_->vertex_stride + v];
            squares[v] += entry * entry;
        }
    return impl::patch_finder<triangle>(*layout_, squares, barred_).patches();
}

void nonlinear_elimination::minimisation::direct(const std::vector<double>& gradients, std::size_t stride, bool exact)
{
    const auto force = forces(gradients, stride);
    d_ = solver_->solve(force);
    slope_ = slope_along(force, d_);
    pause_ = exact ? 0 : pause_ > 0 ? pause_ - 1 : patience;
    exact_ = exact;
    if (!(slope_ < 0)) return finish();
    const double longest = longest_step(patch_->cells, x_, d_, exact_ ? 1 : 4); // the projection is too stiff
    for (auto& v : d_) v *= longest;
    slope_ *= longest;
}

void nonlinear_elimination::minimisation::choose(const std::vector<double>& energies, std::size_t stride,
                                                 const std::array<double, trials>& steps)
{
    if (done_) return;
    const auto sum = [&](std::size_t trial)
    {
        const auto begin = energies.begin() + static_cast<std::ptrdiff_t>(trial * stride + first_cell_);
        return std::accumulate(begin, begin + static_cast<std::ptrdiff_t>(patch_->cells.size()), 0.0);
    };
    constexpr double sufficient = 1e-4, little = 0.2;
    const double here = sum(trials - 1); // its step is 0
    double best = 0, least = here;
    for (std::size_t t = 0; t + 1 < trials; ++t)
        if (const double there = sum(t); there < least && there <= here + sufficient * steps[t] * slope_)
        {
            least = there;
            best = steps[t];
        }
    if (best == 0 && exact_)
        pause_ = patience; // the projected Hessian may still bring something
    else if (best == 0 || here - least < little * most_)
        done_ = true;
    most_ = std::max(most_, here - least);
    for (std::size_t v = 0; v < x_.size(); ++v) x_[v] += best * d_[v];
    moved_ |= best > 0;
    if (done_) finish();
}

bool nonlinear_elimination::advance(std::vector<minimisation>& all, patch_cells& cells)
{
    std::vector<minimisation*> exact, others;
    for (auto& m : all)
        if (!m.done()) (m.exact() ? exact : others).push_back(&m);
    if (exact.empty() && others.empty()) return false;

    cells.place(joined(all, &minimisation::x));
    if (!exact.empty())
    {
        cells.differentiate(definiteness::indefinite);
        direct(exact, cells, true);
        for (minimisation* m : exact)
            if (!m->factors().definite()) others.push_back(m);
        std::sort(others.begin(), others.end()); // as in all: the largest first
    }
    if (!others.empty())
    {
        cells.differentiate(definite(energy_.eigenvalues()));
        direct(others, cells, false);
    }
    constexpr std::array<double, trials> steps{1, 0.5, 0.2, 0};
    const auto& energies = cells.energies(joined(all, &minimisation::d), steps);
    for (auto& m : all) m.choose(energies, cells.stride(), steps);
    return true;
}

void nonlinear_elimination::direct(const std::vector<minimisation*>& some, const patch_cells& cells, bool exact)
{
    constexpr auto slots = []
    {
        std::array<std::array<std::size_t, 6>, 6> at{};
        for (int i = 0; i < 6; ++i)
            for (int j = 0; j < 6; ++j)
                at[static_cast<std::size_t>(i)][static_cast<std::size_t>(j)] =
                    static_cast<std::size_t>(hessian_slots<D>::at(i / D, i % D, j / D, j % D));
        return at;
    }();
    std::vector<solver*> solvers;
    for (minimisation* m : some) solvers.push_back(&m->factors());
    const std::size_t stride = cells.stride();
    cells.hessians().visit(
        [&](const auto& hessians)
        {
            solver::factorize_together(
                solvers, 1e-12, exact,
                [&](std::size_t i, std::size_t c, std::size_t row, std::size_t column)
                { return static_cast<double>(hessians[slots[row][column] * stride + some[i]->first_cell() + c]); },
                [&](std::size_t i)
                {
                    if (!exact || solvers[i]->definite()) some[i]->direct(cells.gradients(), stride, exact);
                });
        });
}

} // namespace taut::impl
