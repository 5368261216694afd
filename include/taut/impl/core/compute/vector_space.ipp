// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <taut/impl/core/compute/kernel.hpp>
#include <taut/impl/core/compute/vector_space.hpp>
#include <taut/impl/core/core/padded.hpp>

namespace taut::impl
{

inline constexpr std::size_t vector_group = 256;
inline constexpr std::size_t widest = 8; ///< vectors that one launch combines

inline void require_type(const device_vectors& space, const device_vector& x)
{
    if (x.data().type() != space.type()) throw parameter_error("vector", "is not of the type of the space");
}

inline std::vector<real_view> views(std::span<const device_vector* const> vectors)
{
    std::vector<real_view> v;
    for (const device_vector* x : vectors) v.emplace_back(x->data());
    return v;
}

} // namespace taut::impl

namespace taut
{

device_vectors::vector::vector(taut::queue& q, scalar_type type, std::size_t n)
    : data_(q, type, impl::padded(n)), size_(n)
{
    data_.fill(0);
}

void device_vectors::vector::upload(std::span<const double> values)
{
    if (values.size() != size_) throw parameter_error("upload", "a vector of " + std::to_string(size_) + " is needed");
    data_.upload(values);
}

std::vector<double> device_vectors::vector::download() const
{
    std::vector<double> values(size_);
    data_.download(std::span(values));
    return values;
}

device_vectors::device_vectors(const taut::queue& q, scalar_type type, std::size_t n)
    : device_vectors(std::make_shared<shared>(q, type, impl::reduction_plan::for_device(q.device())), n)
{
}

device_vectors::device_vectors(std::shared_ptr<shared> workspace, std::size_t n)
    : size_(n), padded_(impl::padded(n)), shared_(std::move(workspace))
{
}

scalar_type device_vectors::type() const noexcept
{
    return shared_->type;
}

taut::queue& device_vectors::queue() const noexcept
{
    return shared_->queue;
}

void device_vectors::axpby(double a, const vector& x, double b, vector& y) const
{
    const double coefficients[] = {a, b};
    const vector* const vectors[] = {&x, &y};
    const std::size_t n = b == 0 ? 1 : 2;
    combine(std::span(coefficients, n), std::span(vectors, n), y);
}

double device_vectors::dot(const vector& x, const vector& y) const
{
    auto& r = shared_->reductions;
    const auto product = r.dot(x.data(), y.data(), padded_);
    r.fetch();
    return r.value(product);
}

void device_vectors::multi_dot(std::span<const vector* const> left, std::span<const vector* const> right,
                               std::span<double> out) const
{
    if (left.empty() || right.empty()) return;
    auto& r = shared_->reductions;
    const auto products = r.dots(impl::views(left), impl::views(right), padded_);
    r.fetch();
    std::copy_n(r.values(products).begin(), products.count, out.begin());
}

void device_vectors::linear_combination(std::span<const double> a, std::span<const vector* const> x, vector& out) const
{
    if (x.empty()) out.data().fill(0);
    for (std::size_t done = 0; done < x.size();)
    {
        // From the second launch on, the sum so far takes part.
        const std::size_t sum = done > 0 ? 1 : 0, n = std::min(x.size() - done, impl::widest - sum);
        std::array<double, impl::widest> coefficients{1.0};
        std::array<const vector*, impl::widest> vectors{&out};
        std::copy_n(a.begin() + std::ptrdiff_t(done), n, coefficients.begin() + std::ptrdiff_t(sum));
        std::copy_n(x.begin() + std::ptrdiff_t(done), n, vectors.begin() + std::ptrdiff_t(sum));
        combine(std::span(coefficients).first(sum + n), std::span(vectors).first(sum + n), out);
        done += n;
    }
}

void device_vectors::step(const vector& x, double a, const vector& d, vector& out) const
{
    const bool wide = x.data().type() == scalar_type::f64;
    auto& along = wide ? shared_->step_double : shared_->step_float;
    shared_->get(along, wide ? "step_along_double" : "step_along_float")(
        {padded_, impl::vector_group}, {{"x", x.data()}, {"a", a}, {"d", d.data()}, {"out", out.data()}});
}

void device_vectors::combine(std::span<const double> a, std::span<const vector* const> x, vector& out) const
{
    impl::require_type(*this, out);
    std::vector<impl::argument> arguments{impl::argument(static_cast<idx>(x.size())), out.data()};
    for (std::size_t k = 0; k < impl::widest; ++k)
    {
        const vector& v = *x[std::min(k, x.size() - 1)];
        impl::require_type(*this, v);
        arguments.push_back(impl::number_of(impl::spelling(type()), k < a.size() ? a[k] : 0));
        arguments.push_back(v.data());
    }
    const std::size_t lanes = shared_->plan.width;
    shared_->get(shared_->combine, "combine")({padded_ / lanes, impl::vector_group / lanes},
                                              std::span<const impl::argument>(arguments));
}

const kernel& device_vectors::shared::get(kernel& k, const char* name)
{
    if (!k) k = impl::make_kernel(queue, impl::vector_program(type, queue.device(), plan), name);
    return k;
}

} // namespace taut
