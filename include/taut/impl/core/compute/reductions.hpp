// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <memory>
#include <span>
#include <vector>

#include <taut/impl/core/compute/partials.hpp>
#include <taut/impl/core/compute/program/vector_program.hpp>
#include <taut/impl/core/compute/reduction_plan.hpp>
#include <taut/kernel.hpp>
#include <taut/reductions.hpp>

namespace taut
{

/// What is enqueued of a round, and where its partial results are.
struct reductions::body
{
    enum class fold
    {
        sum,
        minimum
    };
    enum class slot
    {
        dots,
        sums,
        minima,
        limit,
        end
    };
    struct job
    {
        std::size_t first, groups;
        fold how;
    };

    body(const taut::queue& q, impl::reduction_plan p) : queue(q), plan(p), partials(q) {}

    /// Enqueuing after a fetch starts afresh.
    void begin_round();

    std::size_t reserve(std::size_t count);

    result add(std::size_t first, std::size_t groups, std::size_t count, fold how);

    void launch(scalar_type real, slot what, std::size_t local, std::size_t groups,
                std::initializer_list<kernel::argument> arguments);

    static double folded(const job& j, std::span<const double> part);

    taut::queue queue;
    impl::reduction_plan plan;
    impl::partials partials;
    bool fetched = false;
    std::size_t round = 1, known = 0; ///< of jobs, and of values
    std::vector<job> jobs;
    std::vector<double> values;
    std::array<std::array<kernel, static_cast<std::size_t>(slot::end)>, 2> kernels;
};

} // namespace taut

namespace taut::impl
{

/// Sums and minima with another partition than that of the device.
inline reductions reductions_by(const queue& q, const reduction_plan& plan)
{
    return reductions(std::make_unique<reductions::body>(q, plan));
}

} // namespace taut::impl
