// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <vector>

#include <taut/impl/compute/reductions.hpp>

namespace taut::impl
{

/// A vector of n real numbers on a device, in float or double, in a buffer padded with zeros to a multiple of 1024:
/// kernels run over padded_size() items without a bounds test, and the padding adds nothing to sums.
class device_vector
{
public:
    device_vector() = default;
    device_vector(queue& q, scalar_type type, std::size_t n);
    device_vector(queue& q, scalar_type type, std::span<const double> values) : device_vector(q, type, values.size())
    {
        upload(values);
    }

    std::size_t size() const noexcept { return size_; }
    std::size_t padded_size() const noexcept { return data_.size(); }

    real_buffer& data() noexcept { return data_; }
    const real_buffer& data() const noexcept { return data_; }

    void upload(std::span<const double> values);
    std::vector<double> download() const;

private:
    real_buffer data_;
    std::size_t size_ = 0;
};

} // namespace taut::impl

namespace taut
{

/// Vector space of n-vectors of one type on a device, a model of the concept solve::vector_space. dot and multi_dot
/// wait once for the host; everything else is only enqueued. Copies share one workspace and one queue.
class device_vectors
{
public:
    using vector = impl::device_vector;

    /// type: f32 or f64.
    device_vectors(const queue& q, scalar_type type, std::size_t n);
    device_vectors(const queue& q, scalar_type type, std::size_t n, impl::reduction_plan plan)
        : size_(n), padded_(impl::padded(n)), shared_(std::make_shared<shared>(q, type, plan))
    {
    }

    std::size_t size() const noexcept { return size_; }
    scalar_type type() const noexcept { return shared_->type; }
    taut::queue& queue() const noexcept { return shared_->queue; }

    /// The zero vector.
    vector make() const { return make_points(type()); }
    /// The same in another precision, for positions.
    vector make_points(scalar_type points) const { return vector(shared_->queue, points, size_); }

    void copy(const vector& source, vector& target) const { target.data().copy_from(source.data()); }

    /// y = a x + b y. y is not read for b = 0.
    void axpby(double a, const vector& x, double b, vector& y) const;

    double dot(const vector& x, const vector& y) const;

    /// out[i * right.size() + j] = left[i] . right[j]
    void multi_dot(std::span<const vector* const> left, std::span<const vector* const> right,
                   std::span<double> out) const;

    /// out = a[0] x[0] + a[1] x[1] + ..., up to eight vectors per launch. out may be x[0], and no other of them.
    void linear_combination(std::span<const double> a, std::span<const vector* const> x, vector& out) const;

    /// out = x + a d for positions x in their own precision, in which it is computed; out may be x.
    void step(const vector& x, double a, const vector& d, vector& out) const;

private:
    static constexpr std::size_t group = 256;
    static constexpr std::size_t widest = 8; ///< vectors that one launch combines

    /// out = a[0] x[0] + ..., up to `widest` vectors in one launch; out may be one of them.
    void combine(std::span<const double> a, std::span<const vector* const> x, vector& out) const;

    void require_type(const vector& x) const
    {
        if (x.data().type() != type()) throw parameter_error("vector", "is not of the type of the space");
    }

    static std::vector<impl::real_view> views(std::span<const vector* const> vectors);

    /// Workspace, shared by copies of the space; kernels are built when first used.
    struct shared
    {
        shared(const taut::queue& q, scalar_type real, impl::reduction_plan plan)
            : queue(q), type(real), reductions(q, plan)
        {
        }

        const kernel& get(kernel& k, const char* name);

        taut::queue queue;
        scalar_type type;
        taut::reductions reductions;
        kernel combine, step_float, step_double;
    };

    std::size_t size_;
    std::size_t padded_;
    std::shared_ptr<shared> shared_;
};

} // namespace taut

#ifdef TAUT_IMPLEMENTATION
#include <taut/impl/compute/vector_space.ipp>
#endif
