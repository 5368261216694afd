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

/// A vector of n numbers on a device, in a buffer padded with zeros to a multiple of 1024: kernels run over
/// padded_size() items without a bounds test, and the padding adds nothing to sums.
template <class T>
class device_vector
{
public:
    device_vector() = default;
    device_vector(queue& q, std::size_t n) : data_(q, padded(n)), size_(n) { data_.fill(0); }
    device_vector(queue& q, std::span<const T> values) : device_vector(q, values.size()) { upload(values); }

    std::size_t size() const noexcept { return size_; }
    std::size_t padded_size() const noexcept { return data_.size(); }

    buffer<T>& data() noexcept { return data_; }
    const buffer<T>& data() const noexcept { return data_; }

    void upload(std::span<const T> values)
    {
        if (values.size() != size_)
            throw parameter_error("upload", "a vector of " + std::to_string(size_) + " is needed");
        data_.upload(values);
    }
    std::vector<T> download() const
    {
        std::vector<T> values(size_);
        data_.download(std::span(values));
        return values;
    }

private:
    buffer<T> data_;
    std::size_t size_ = 0;
};

/// The space of n-vectors of T on a device: what the solvers need, on their own terms (see solve/vector_space.hpp). dot
/// and multi_dot wait once for the host; everything else is only enqueued. Copies share one workspace and one queue.
template <class T>
class device_vectors
{
public:
    using scalar = T;
    using vector = device_vector<T>;

    device_vectors(const queue& q, std::size_t n) : device_vectors(q, n, reduction_plan::for_device(q.device())) {}
    device_vectors(const queue& q, std::size_t n, reduction_plan plan)
        : size_(n), padded_(padded(n)), shared_(std::make_shared<shared>(q, plan))
    {
    }

    std::size_t size() const noexcept { return size_; }
    taut::queue& queue() const noexcept { return shared_->queue; }

    /// The zero vector; make_points in another precision, for positions.
    vector make() const { return vector(shared_->queue, size_); }
    template <class P>
    device_vector<P> make_points() const
    {
        return device_vector<P>(shared_->queue, size_);
    }

    template <class P>
    void copy(const device_vector<P>& source, device_vector<P>& target) const
    {
        target.data().copy_from(source.data());
    }

    /// y = a x + b y. y is not read for b = 0.
    void axpby(double a, const vector& x, double b, vector& y) const
    {
        if (b == 0)
            shared_->scale(all(), T(a), x.data(), y.data());
        else
            shared_->axpby(all(), T(a), x.data(), T(b), y.data());
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
        const auto products = r.template dots<T>(buffers(left), buffers(right), padded_);
        r.fetch();
        std::copy_n(r.values(products).begin(), products.count, out.begin());
    }

    /// out = a[0] x[0] + a[1] x[1] + ..., up to eight vectors a launch. out must not be one of x.
    void linear_combination(std::span<const double> a, std::span<const vector* const> x, vector& out) const
    {
        std::size_t done = 0;
        if (x.empty()) out.data().fill(0);
        while (done < x.size())
        {
            const buffer<T>* v[8];
            T c[8] = {};
            std::size_t n = 0;
            // From the second launch on, the sum so far takes part.
            if (done > 0) v[n] = &out.data(), c[n++] = 1;
            while (n < 8 && done < x.size()) v[n] = &x[done]->data(), c[n++] = T(a[done++]);
            // A filler has coefficient 0 and repeats a vector that is in the sum, so that it cannot bring a new NaN.
            for (std::size_t k = n; k < 8; ++k) v[k] = v[0];
            shared_->combination(n)(all(), out.data(), c[0], *v[0], c[1], *v[1], c[2], *v[2], c[3], *v[3], c[4], *v[4],
                                    c[5], *v[5], c[6], *v[6], c[7], *v[7]);
        }
    }

    /// out = x + a d for positions x in their own precision P, computed in P; out may be x.
    template <class P>
    void step(const device_vector<P>& x, double a, const vector& d, device_vector<P>& out) const
    {
        auto& kernel = shared_->template step<P>();
        if (!kernel) shared_->load(kernel, std::is_same_v<P, double> ? "step_along_double" : "step_along_float");
        kernel(all(), x.data(), P(a), d.data(), out.data());
    }

private:
    static constexpr std::size_t group = 256;
    range all() const { return {padded_, group}; }

    static std::vector<const buffer<T>*> buffers(std::span<const vector* const> vectors)
    {
        std::vector<const buffer<T>*> b;
        for (const vector* v : vectors) b.push_back(&v->data());
        return b;
    }

    using in = const buffer<T>;
    using combine_kernel = typed_kernel<buffer<T>, T, in, T, in, T, in, T, in, T, in, T, in, T, in, T, in>;
    template <class P>
    using step_kernel = typed_kernel<const buffer<P>, P, in, buffer<P>>;

    /// Workspace, shared by copies of the space; kernels are built when first used.
    struct shared
    {
        shared(const taut::queue& q, reduction_plan plan) : queue(q), reductions(q, plan)
        {
            load(scale, "scale");
            load(axpby, "axpby");
        }

        template <class Kernel>
        void load(Kernel& kernel, const char* name)
        {
            kernel = {queue, detail::vector_program(), name,
                      detail::vector_options<T>(queue.device(), reductions.plan())};
        }

        /// The narrowest one for n vectors.
        combine_kernel& combination(std::size_t n)
        {
            const std::size_t width = n <= 2 ? 0 : n <= 4 ? 1 : 2;
            static constexpr const char* names[] = {"combine_2", "combine_4", "combine_8"};
            if (!combine[width]) load(combine[width], names[width]);
            return combine[width];
        }

        template <class P>
        step_kernel<P>& step()
        {
            if constexpr (std::is_same_v<P, double>)
                return step_double;
            else
                return step_float;
        }

        taut::queue queue;
        taut::reductions reductions;
        typed_kernel<T, in, buffer<T>> scale;
        typed_kernel<T, in, T, buffer<T>> axpby;
        combine_kernel combine[3];
        step_kernel<float> step_float;
        step_kernel<double> step_double;
    };

    std::size_t size_;
    std::size_t padded_;
    std::shared_ptr<shared> shared_;
};

} // namespace taut
