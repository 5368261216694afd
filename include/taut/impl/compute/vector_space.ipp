// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <string>

#include <taut/impl/compute/vector_space.hpp>

namespace taut::impl
{

device_vector::device_vector(queue& q, scalar_type type, std::size_t n) : data_(q, type, padded(n)), size_(n)
{
    data_.fill(0);
}

void device_vector::upload(std::span<const double> values)
{
    if (values.size() != size_) throw parameter_error("upload", "a vector of " + std::to_string(size_) + " is needed");
    data_.upload(values);
}

std::vector<double> device_vector::download() const
{
    std::vector<double> values(size_);
    data_.download(std::span(values));
    return values;
}

} // namespace taut::impl

namespace taut
{

device_vectors::device_vectors(const taut::queue& q, scalar_type type, std::size_t n)
    : device_vectors(q, type, n, impl::reduction_plan::for_device(q.device()))
{
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
    const auto products = r.dots(views(left), views(right), padded_);
    r.fetch();
    std::copy_n(r.values(products).begin(), products.count, out.begin());
}

void device_vectors::linear_combination(std::span<const double> a, std::span<const vector* const> x, vector& out) const
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

void device_vectors::step(const vector& x, double a, const vector& d, vector& out) const
{
    const bool wide = x.data().type() == scalar_type::f64;
    auto& along = wide ? shared_->step_double : shared_->step_float;
    shared_->get(along, wide ? "step_along_double" : "step_along_float")(
        {padded_, group}, {{"x", x.data()}, {"a", a}, {"d", d.data()}, {"out", out.data()}});
}

void device_vectors::combine(std::span<const double> a, std::span<const vector* const> x, vector& out) const
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

std::vector<impl::real_view> device_vectors::views(std::span<const vector* const> vectors)
{
    std::vector<impl::real_view> v;
    for (const vector* x : vectors) v.emplace_back(x->data());
    return v;
}

const kernel& device_vectors::shared::get(kernel& k, const char* name)
{
    if (!k)
        k = kernel(queue, impl::vector_program(), name, impl::vector_options(type, queue.device(), reductions.plan()),
                   type);
    return k;
}

} // namespace taut
