// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <memory>
#include <span>
#include <string>
#include <type_traits>
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
    device_vectors(const queue& q, scalar_type type, std::size_t n)
        : device_vectors(q, type, n, impl::reduction_plan::for_device(q.device()))
    {
    }
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
    void axpby(double a, const vector& x, double b, vector& y) const
    {
        const double coefficients[] = {a, b};
        const vector* const vectors[] = {&x, &y};
        const std::size_t n = b == 0 ? 1 : 2;
        combine(std::span(coefficients, n), std::span(vectors, n), y);
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

    /// out = a[0] x[0] + a[1] x[1] + ..., up to eight vectors per launch. out may be x[0], and no other of them.
    void linear_combination(std::span<const double> a, std::span<const vector* const> x, vector& out) const
    {
        if (x.empty()) out.data().fill(0);
        for (std::size_t done = 0; done < x.size();)
        {
            // From the second launch on, the sum so far takes part.
            const std::size_t sum = done > 0 ? 1 : 0, n = std::min(x.size() - done, widest - sum);
            std::array<double, widest> coefficients{1.0};
            std::array<const vector*, widest> vectors{&out};
            std::copy_n(a.begin() + std::ptrdiff_t(done), n, coefficients.begin() + std::ptrdiff_t(sum));
            std::copy_n(x.begin() + std::ptrdiff_t(done), n, vectors.begin() + std::ptrdiff_t(sum));
            combine(std::span(coefficients).first(sum + n), std::span(vectors).first(sum + n), out);
            done += n;
        }
    }

    /// out = x + a d for positions x in their own precision, in which it is computed; out may be x.
    void step(const vector& x, double a, const vector& d, vector& out) const
    {
        const bool wide = x.data().type() == scalar_type::f64;
        auto& along = wide ? shared_->step_double : shared_->step_float;
        shared_->get(along, wide ? "step_along_double" : "step_along_float")(
            {padded_, group}, {{"x", x.data()}, {"a", a}, {"d", d.data()}, {"out", out.data()}});
    }

private:
    static constexpr std::size_t group = 256;
    static constexpr std::size_t widest = 8; ///< vectors that one launch combines

    /// out = a[0] x[0] + ..., up to `widest` vectors in one launch; out may be one of them.
    void combine(std::span<const double> a, std::span<const vector* const> x, vector& out) const
    {
        require_type(out);
        std::vector<impl::argument> arguments{impl::argument(static_cast<idx>(x.size())), out.data()};
        for (std::size_t k = 0; k < widest; ++k)
        {
            const vector& v = *x[std::min(k, x.size() - 1)];
            require_type(v);
            arguments.push_back(impl::argument(k < a.size() ? a[k] : 0).as(impl::spelling(type())));
            arguments.push_back(v.data());
        }
        const std::size_t lanes = shared_->reductions.plan().width;
        shared_->get(shared_->combine, "combine")({padded_ / lanes, group / lanes},
                                                  std::span<const impl::argument>(arguments));
    }

    void require_type(const vector& x) const
    {
        if (x.data().type() != type()) throw parameter_error("vector", "is not of the type of the space");
    }

    static std::vector<impl::real_view> views(std::span<const vector* const> vectors)
    {
        std::vector<impl::real_view> v;
        for (const vector* x : vectors) v.emplace_back(x->data());
        return v;
    }

    /// Workspace, shared by copies of the space; kernels are built when first used.
    struct shared
    {
        shared(const taut::queue& q, scalar_type real, impl::reduction_plan plan)
            : queue(q), type(real), reductions(q, plan)
        {
        }

        const kernel& get(kernel& k, const char* name)
        {
            if (!k)
                k = kernel(queue, impl::vector_program(), name,
                           impl::vector_options(type, queue.device(), reductions.plan()), type);
            return k;
        }

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
