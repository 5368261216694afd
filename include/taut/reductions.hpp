// SPDX-License-Identifier: MIT
#include <taut/impl/enter.inl>
#if TAUT_OPEN == 1 // the parts that its calls need
#define TAUT_PART_COMPUTE
#endif
#ifndef TAUT_REDUCTIONS_HPP
#define TAUT_REDUCTIONS_HPP

#include <cstddef>
#include <memory>
#include <span>

#include <taut/queue.hpp>

/// Sums, dot products and minima over numbers on a device.
namespace taut
{

/// Real numbers on a device, whatever holds them; it refers to them.
class real_view
{
public:
    real_view(const buffer<float>& b) : memory_(&impl::memory_of(b)) {}
    real_view(const buffer<double>& b) : memory_(&impl::memory_of(b)) {}
    real_view(const real_buffer& b) : memory_(&b.memory_) {}

    std::size_t size() const noexcept { return memory_->size(); }
    scalar_type type() const noexcept { return memory_->is_double() ? scalar_type::f64 : scalar_type::f32; }

private:
    friend class kernel;

    const impl::device_memory* memory_;
};

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
/// results. Throws parameter_error for elements beyond the end of a buffer, size_error for more than 2^31.
class reductions
{
public:
    struct body;

    /// Names the numbers that one call will have produced after fetch().
    struct result
    {
        std::size_t first = 0;
        std::size_t count = 0;
        std::size_t round = 0; ///< that fetch() ends, from 1; 0: none
    };

    /// `count` runs of `length` elements each, from `start`, `stride` apart.
    struct segments
    {
        std::size_t count = 1;
        std::size_t length = 0;
        std::size_t stride = 0;
        std::size_t start = 0;
    };

    explicit reductions(const queue& q);
    explicit reductions(std::unique_ptr<body> b);
    reductions(reductions&&) noexcept;
    reductions& operator=(reductions&&) noexcept;
    ~reductions();

    /// The sum of each segment of x.
    result sum(const real_view& x, const segments& s);
    result sum(const real_view& x) { return sum(x, segments{.length = x.size()}); }

    /// The smallest of n elements from start: +inf for none, NaN if any is NaN.
    result minimum(const real_view& x, std::size_t n, std::size_t start = 0);

    /// Every left times every right vector over their first n elements: result i * right.size() + j.
    result dots(std::span<const real_view> left, std::span<const real_view> right, std::size_t n);

    result dot(const real_view& x, const real_view& y, std::size_t n)
    {
        return dots(std::span(&x, 1), std::span(&y, 1), n);
    }

    /// Enqueues out[0] = min(most, fraction * the minimum r): what a later launch can read without a wait. NaN stays
    /// NaN.
    void limit(result r, double fraction, double most, const real_view& out);

    /// Waits once and folds all that was enqueued in this round.
    void fetch();

    /// Numbers of the last round that was fetched. Throws parameter_error for results of others.
    double value(result r, std::size_t k = 0) const { return values(r)[k]; }
    std::span<const double> values(result r) const;

private:
    std::unique_ptr<body> body_;
};

} // namespace taut

#endif
#include <taut/impl/leave.inl>
