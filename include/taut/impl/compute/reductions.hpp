// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <span>
#include <vector>

#include <taut/impl/compute/kernel.hpp>
#include <taut/impl/compute/partials.hpp>
#include <taut/impl/compute/program/vector_program.hpp>

namespace taut::impl
{

/// K runs of n elements each, from start, stride apart.
struct segments
{
    std::size_t count = 1;
    std::size_t length = 0;
    std::size_t stride = 0;
    std::size_t start = 0;
};

} // namespace taut::impl

namespace taut
{

/// Deterministic sums, dot products and minima that share one host wait: enqueue any number, then fetch() once.
///
///     reductions r(q);
///     auto energy = r.sum(values, {.length = n});
///     auto least  = r.minimum(dets, n);
///     r.fetch();                               // the only wait
///     double e = r.value(energy);
///
/// float data is accumulated in double (in float on a device without fp64). The device leaves one partial result per
/// block; the host adds them in their order, in double. Enqueuing after a fetch() begins a new round and ends the old
/// results.
class reductions
{
public:
    /// Names the numbers that one call will have produced after fetch().
    struct result
    {
        std::size_t first = 0;
        std::size_t count = 0;
    };

    explicit reductions(const queue& q);
    reductions(const queue& q, impl::reduction_plan plan) : queue_(q), plan_(plan), partials_(q) {}

    const impl::reduction_plan& plan() const noexcept { return plan_; }

    /// The sum of each segment of x.
    result sum(const impl::real_view& x, const impl::segments& s);
    result sum(const impl::real_view& x) { return sum(x, impl::segments{.length = x.size()}); }

    /// The smallest of n elements from start: +inf for none, NaN if any is NaN.
    result minimum(const impl::real_view& x, std::size_t n, std::size_t start = 0);

    /// Enqueues out[0] = min(most, fraction * the minimum r): what a later launch can read without a wait. NaN stays
    /// NaN.
    void limit(result r, double fraction, double most, const impl::real_view& out);

    /// Every left times every right vector over their first n elements: result i * right.size() + j. Tiles of up to
    /// four by four share their loads, one launch a tile.
    result dots(std::span<const impl::real_view> left, std::span<const impl::real_view> right, std::size_t n);

    result dot(const impl::real_view& x, const impl::real_view& y, std::size_t n)
    {
        return dots(std::span(&x, 1), std::span(&y, 1), n);
    }

    /// Waits once and folds all that was enqueued in this round.
    void fetch();

    double value(result r, std::size_t k = 0) const { return values_[r.first + k]; }
    std::span<const double> values(result r) const { return std::span(values_).subspan(r.first, r.count); }

private:
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

    /// Enqueuing after a fetch starts afresh.
    void begin_round();

    std::size_t reserve(std::size_t count);

    result add(std::size_t first, std::size_t groups, std::size_t count, fold how);

    void launch(scalar_type real, slot what, std::size_t local, std::size_t groups,
                std::initializer_list<impl::argument> arguments);

    static double folded(const job& j, std::span<const double> part);

    void check(const impl::real_view& x, std::size_t end, const char* what) const;

    static std::uint32_t as_uint(std::size_t n);

    queue queue_;
    impl::reduction_plan plan_;
    impl::partials partials_;
    bool fetched_ = false;
    std::vector<job> jobs_;
    std::vector<double> values_;
    std::array<std::array<kernel, static_cast<std::size_t>(slot::end)>, 2> kernels_;
};

} // namespace taut

#ifdef TAUT_IMPLEMENTATION
#include <taut/impl/compute/reductions.ipp>
#endif
