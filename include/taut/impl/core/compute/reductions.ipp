// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <span>
#include <string>
#include <utility>

#include <taut/impl/core/compute/kernel.hpp>
#include <taut/impl/core/compute/reductions.hpp>

namespace taut::impl
{

inline void check_elements(const real_view& x, std::size_t end, const char* what)
{
    if (end > x.size())
        throw parameter_error(what,
                              std::to_string(end) + " elements wanted of a buffer of " + std::to_string(x.size()));
}

inline std::uint32_t as_uint(std::size_t n)
{
    if (n > std::numeric_limits<std::int32_t>::max()) throw size_error("reductions", "more than 2^31 elements");
    return static_cast<std::uint32_t>(n);
}

} // namespace taut::impl

namespace taut
{

reductions::reductions(const queue& q)
    : reductions(std::make_unique<body>(q, impl::reduction_plan::for_device(q.device())))
{
}

reductions::reductions(std::unique_ptr<body> b) : body_(std::move(b)) {}
reductions::reductions(reductions&&) noexcept = default;
reductions& reductions::operator=(reductions&&) noexcept = default;
reductions::~reductions() = default;

reductions::result reductions::sum(const real_view& x, const segments& s)
{
    impl::check_elements(x, s.count == 0 ? 0 : s.start + (s.count - 1) * s.stride + s.length, "sum");
    const auto blocks = body_->plan.cut(s.length);
    const std::size_t first = body_->reserve(s.count * blocks.count);
    body_->launch(x.type(), body::slot::sums, body_->plan.local, s.count * blocks.count,
                  {impl::as_uint(s.length), impl::as_uint(blocks.length), impl::as_uint(blocks.count),
                   impl::as_uint(first), body_->partials.data(), x, std::uint64_t{s.start}, std::uint64_t{s.stride}});
    return body_->add(first, blocks.count, s.count, body::fold::sum);
}

reductions::result reductions::minimum(const real_view& x, std::size_t n, std::size_t start)
{
    impl::check_elements(x, start + n, "minimum");
    const auto blocks = body_->plan.cut(n);
    const std::size_t first = body_->reserve(blocks.count);
    body_->launch(x.type(), body::slot::minima, body_->plan.local, blocks.count,
                  {impl::as_uint(n), impl::as_uint(blocks.length), impl::as_uint(first), body_->partials.data(), x,
                   std::uint64_t{start}});
    return body_->add(first, blocks.count, 1, body::fold::minimum);
}

void reductions::limit(result r, double fraction, double most, const real_view& out)
{
    const body::job& j = body_->jobs[r.first];
    const auto number = [&](double x) { return impl::number_of(impl::spelling(body_->partials.data().type()), x); };
    body_->launch(
        out.type(), body::slot::limit, 1, 1,
        {impl::as_uint(j.first), impl::as_uint(j.groups), body_->partials.data(), number(fraction), number(most), out});
}

reductions::result reductions::dots(std::span<const real_view> left, std::span<const real_view> right, std::size_t n)
{
    const auto& some = left.empty() ? right : left;
    for (const auto& vectors : {left, right})
        for (const auto& x : vectors)
        {
            impl::check_elements(x, n, "dot");
            if (x.type() != some[0].type()) throw parameter_error("dot", "float and double do not mix");
        }
    body_->begin_round();
    const result all = {body_->jobs.size(), left.size() * right.size(), body_->round};
    const auto blocks = body_->plan.cut(n);
    const std::size_t local = std::min<std::size_t>(body_->plan.local, 128); // as the kernel has it
    body_->jobs.resize(all.first + all.count);
    for (std::size_t l = 0; l < left.size(); l += 4)
    {
        const std::size_t nl = std::min<std::size_t>(4, left.size() - l);
        for (std::size_t r = 0; r < right.size(); r += 4)
        {
            const std::size_t nr = std::min<std::size_t>(4, right.size() - r);
            const auto a = [&](std::size_t k) { return left[l + std::min(k, nl - 1)]; };
            const auto b = [&](std::size_t k) { return right[r + std::min(k, nr - 1)]; };
            const std::size_t first = body_->reserve(nl * nr * blocks.count);
            body_->launch(a(0).type(), body::slot::dots, local, blocks.count,
                          {impl::as_uint(n), impl::as_uint(blocks.length), impl::as_uint(blocks.count),
                           impl::as_uint(first), impl::as_uint(nl), impl::as_uint(nr), body_->partials.data(), a(0),
                           a(1), a(2), a(3), b(0), b(1), b(2), b(3)});
            for (std::size_t i = 0; i < nl; ++i)
                for (std::size_t j = 0; j < nr; ++j)
                    body_->jobs[all.first + (l + i) * right.size() + r + j] = {first + (i * nr + j) * blocks.count,
                                                                               blocks.count, body::fold::sum};
        }
    }
    return all;
}

void reductions::fetch()
{
    body_->fetched = true;
    body_->known = body_->round;
    const auto host = body_->partials.fetch();
    body_->values.clear();
    for (const body::job& j : body_->jobs) body_->values.push_back(body_->folded(j, host.subspan(j.first, j.groups)));
}

std::span<const double> reductions::values(result r) const
{
    if (r.round != body_->known)
        throw parameter_error("result", r.round > body_->known ? "is not there yet; call fetch() first"
                                                               : "is not one of the last fetch()");
    return std::span<const double>(body_->values).subspan(r.first, r.count);
}

void reductions::body::begin_round()
{
    if (!fetched) return;
    fetched = false;
    ++round;
    partials.clear();
    jobs.clear();
}

std::size_t reductions::body::reserve(std::size_t count)
{
    begin_round();
    return partials.reserve(count);
}

reductions::result reductions::body::add(std::size_t first, std::size_t groups, std::size_t count, fold how)
{
    const result r = {jobs.size(), count, round};
    for (std::size_t k = 0; k < count; ++k) jobs.push_back({first + k * groups, groups, how});
    return r;
}

void reductions::body::launch(scalar_type real, slot what, std::size_t local, std::size_t groups,
                              std::initializer_list<impl::argument> arguments)
{
    if (groups == 0) return;
    const auto which = static_cast<std::size_t>(what);
    auto& known = kernels[real == scalar_type::f64][which];
    if (!known)
    {
        static constexpr const char* names[] = {"dots", "sums", "minima", "limit"};
        known = impl::make_kernel(queue, impl::vector_program(real, queue.device(), plan), names[which]);
    }
    known({groups * local, local}, std::span(arguments.begin(), arguments.size()));
}

double reductions::body::folded(const job& j, std::span<const double> part)
{
    if (j.how == fold::sum) return std::accumulate(part.begin(), part.end(), 0.0);
    double least = std::numeric_limits<double>::infinity();
    for (const double p : part)
    {
        if (std::isnan(p)) return p;
        least = std::min(least, p);
    }
    return least;
}

} // namespace taut
