// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstddef>
#include <memory>
#include <span>
#include <string>
#include <type_traits>
#include <vector>

#include <taut/compute/reductions.hpp>

namespace taut
{

/// A vector of n real numbers on a device, in float or double, in a buffer padded with zeros to a multiple of 1024:
/// kernels run over padded_size() items without a bounds test, and the padding adds nothing to sums.
class device_vector
{
public:
    device_vector() = default;
    device_vector(queue& q, scalar_type type, std::size_t n) : data_(q, type, padded(n)), size_(n) { data_.fill(0); }
    device_vector(queue& q, scalar_type type, std::span<const double> values) : device_vector(q, type, values.size())
    {
        upload(values);
    }

    std::size_t size() const noexcept { return size_; }
    std::size_t padded_size() const noexcept { return data_.size(); }

    real_buffer& data() noexcept { return data_; }
    const real_buffer& data() const noexcept { return data_; }

    void upload(std::span<const double> values)
    {
        if (values.size() != size_)
            throw parameter_error("upload", "a vector of " + std::to_string(size_) + " is needed");
        data_.upload(values);
    }
    std::vector<double> download() const
    {
        std::vector<double> values(size_);
        data_.download(std::span(values));
        return values;
    }

private:
    real_buffer data_;
    std::size_t size_ = 0;
};

/// The space of n-vectors of one type on a device: what the solvers need, on their own terms (see
/// solve/vector_space.hpp). dot and multi_dot wait once for the host; everything else is only enqueued. Copies share
/// one workspace and one queue.
class device_vectors
{
public:
    using vector = device_vector;

    /// type: f32 or f64.
    device_vectors(const queue& q, scalar_type type, std::size_t n)
        : device_vectors(q, type, n, reduction_plan::for_device(q.device()))
    {
    }
    device_vectors(const queue& q, scalar_type type, std::size_t n, reduction_plan plan)
        : size_(n), padded_(padded(n)), shared_(std::make_shared<shared>(q, type, plan))
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
    void axpby(double a, const vector& x, double b, vector& y) const
    {
        if (b == 0)
            shared_->get(shared_->scale, "scale")(all(), {{"a", a}, {"x", x.data()}, {"y", y.data()}});
        else
            shared_->get(shared_->axpby, "axpby")(all(), {{"a", a}, {"x", x.data()}, {"b", b}, {"y", y.data()}});
    }

    double dot(const vector& x, const vector& y) const
    {
        auto& r = shared_->reductions;
        const auto product = r.dot(x.data(), y.data(), padded_);
        r.fetch();
        return r.value(product);
    }

    /// out[i * right.size() + j] = left[i] . right[j]
    void multi_dot(std::span<const vector* const> left, std::span<const vector* const> right,
                   std::span<double> out) const
    {
        if (left.empty() || right.empty()) return;
        auto& r = shared_->reductions;
        const auto products = r.dots(views(left), views(right), padded_);
        r.fetch();
        std::copy_n(r.values(products).begin(), products.count, out.begin());
    }

    /// out = a[0] x[0] + a[1] x[1] + ..., up to eight vectors a launch. out must not be one of x.
    void linear_combination(std::span<const double> a, std::span<const vector* const> x, vector& out) const
    {
        require_type(out);
        for (const vector* v : x) require_type(*v);
        std::size_t done = 0;
        if (x.empty()) out.data().fill(0);
        while (done < x.size())
        {
            std::vector<detail::argument> arguments{out.data()};
            std::size_t n = 0;
            const auto add = [&](double coefficient, const detail::argument& v)
            {
                arguments.push_back(detail::argument(coefficient).as(spelling(type())));
                arguments.push_back(v);
                ++n;
            };
            // From the second launch on, the sum so far takes part.
            if (done > 0) add(1, out.data());
            for (; n < 8 && done < x.size(); ++done) add(a[done], x[done]->data());
            const std::size_t used = n;
            // A filler has coefficient 0 and repeats a vector that is in the sum, so that it cannot bring a new NaN.
            while (n < 8) add(0, detail::argument(arguments[2]));
            shared_->combination(used)(all(), std::span<const detail::argument>(arguments));
        }
    }

    /// out = x + a d for positions x in their own precision, in which it is computed; out may be x.
    void step(const vector& x, double a, const vector& d, vector& out) const
    {
        const bool wide = x.data().type() == scalar_type::f64;
        auto& along = wide ? shared_->step_double : shared_->step_float;
        shared_->get(along, wide ? "step_along_double" : "step_along_float")(
            all(), {{"x", x.data()}, {"a", a}, {"d", d.data()}, {"out", out.data()}});
    }

private:
    static constexpr std::size_t group = 256;
    range all() const { return {padded_, group}; }

    void require_type(const vector& x) const
    {
        if (x.data().type() != type()) throw parameter_error("vector", "is not of the type of the space");
    }

    static std::vector<real_view> views(std::span<const vector* const> vectors)
    {
        std::vector<real_view> v;
        for (const vector* x : vectors) v.emplace_back(x->data());
        return v;
    }

    /// Workspace, shared by copies of the space; kernels are built when first used.
    struct shared
    {
        shared(const taut::queue& q, scalar_type real, reduction_plan plan) : queue(q), type(real), reductions(q, plan)
        {
        }

        const kernel& get(kernel& k, const char* name)
        {
            if (!k)
                k = kernel(queue, detail::vector_program(), name,
                           detail::vector_options(type, queue.device(), reductions.plan()), type);
            return k;
        }

        /// The narrowest one for n vectors.
        const kernel& combination(std::size_t n)
        {
            const std::size_t width = n <= 2 ? 0 : n <= 4 ? 1 : 2;
            static constexpr const char* names[] = {"combine_2", "combine_4", "combine_8"};
            return get(combine[width], names[width]);
        }

        taut::queue queue;
        scalar_type type;
        taut::reductions reductions;
        kernel scale, axpby, combine[3], step_float, step_double;
    };

    std::size_t size_;
    std::size_t padded_;
    std::shared_ptr<shared> shared_;
};

} // namespace taut
