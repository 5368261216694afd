// SPDX-License-Identifier: MIT
#include <taut/impl/enter.inl>
#if TAUT_OPEN == 1 // the parts that its calls need
#define TAUT_PART_COMPUTE
#endif
#ifndef TAUT_DEVICE_VECTORS_HPP
#define TAUT_DEVICE_VECTORS_HPP

#include <cstddef>
#include <memory>
#include <span>
#include <vector>

#include <taut/queue.hpp>

/// Vectors on a device, for the solvers of <taut/minimize.hpp>.
namespace taut
{

/// Vector space of n-vectors of one type on a device, a model of the concept solve::vector_space. dot and multi_dot
/// wait once for the host; everything else is only enqueued. Copies share one workspace and one queue.
class device_vectors
{
public:
    struct shared;

    /// n real numbers, in float or double, in a buffer padded with zeros to a multiple of 1024: kernels run over
    /// padded_size() items without a bounds test, and the padding adds nothing to sums.
    class vector
    {
    public:
        vector() = default;
        vector(taut::queue& q, scalar_type type, std::size_t n);
        vector(taut::queue& q, scalar_type type, std::span<const double> values) : vector(q, type, values.size())
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

    /// type: f32 or f64.
    device_vectors(const taut::queue& q, scalar_type type, std::size_t n);
    device_vectors(std::shared_ptr<shared> workspace, std::size_t n);

    std::size_t size() const noexcept { return size_; }
    scalar_type type() const noexcept;
    taut::queue& queue() const noexcept;

    /// The zero vector.
    vector make() const { return make_points(type()); }
    /// The same in another precision, for positions.
    vector make_points(scalar_type points) const { return vector(queue(), points, size_); }

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
    /// out = a[0] x[0] + ..., up to eight vectors in one launch; out may be one of them.
    void combine(std::span<const double> a, std::span<const vector* const> x, vector& out) const;

    std::size_t size_;
    std::size_t padded_;
    std::shared_ptr<shared> shared_;
};

} // namespace taut

namespace taut::impl
{

using device_vector = device_vectors::vector;

} // namespace taut::impl

#endif
#include <taut/impl/leave.inl>
