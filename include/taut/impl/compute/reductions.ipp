// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <string>

#include <taut/impl/compute/reductions.hpp>

namespace taut
{

reductions::reductions(const queue& q) : reductions(q, impl::reduction_plan::for_device(q.device())) {}

reductions::result reductions::sum(const impl::real_view& x, const impl::segments& s)
{
    check(x, s.count == 0 ? 0 : s.start + (s.count - 1) * s.stride + s.length, "sum");
    const auto blocks = plan_.cut(s.length);
    const std::size_t first = reserve(s.count * blocks.count);
    launch(x.real(), slot::sums, plan_.local, s.count * blocks.count,
           {as_uint(s.length), as_uint(blocks.length), as_uint(blocks.count), as_uint(first), partials_.data(), x,
            std::uint64_t{s.start}, std::uint64_t{s.stride}});
    return add(first, blocks.count, s.count, fold::sum);
}

reductions::result reductions::minimum(const impl::real_view& x, std::size_t n, std::size_t start)
{
    check(x, start + n, "minimum");
    const auto blocks = plan_.cut(n);
    const std::size_t first = reserve(blocks.count);
    launch(x.real(), slot::minima, plan_.local, blocks.count,
           {as_uint(n), as_uint(blocks.length), as_uint(first), partials_.data(), x, std::uint64_t{start}});
    return add(first, blocks.count, 1, fold::minimum);
}

void reductions::limit(result r, double fraction, double most, const impl::real_view& out)
{
    const job& j = jobs_[r.first];
    const auto number = [&](double x) { return impl::argument(x).as(impl::spelling(partials_.data().type())); };
    launch(out.real(), slot::limit, 1, 1,
           {as_uint(j.first), as_uint(j.groups), partials_.data(), number(fraction), number(most), out});
}

reductions::result reductions::dots(std::span<const impl::real_view> left, std::span<const impl::real_view> right,
                                    std::size_t n)
{
    const auto& some = left.empty() ? right : left;
    for (const auto& vectors : {left, right})
        for (const auto& x : vectors)
        {
            check(x, n, "dot");
            if (x.real() != some[0].real()) throw parameter_error("dot", "float and double do not mix");
        }
    begin_round();
    const result all = {jobs_.size(), left.size() * right.size()};
    const auto blocks = plan_.cut(n);
    const std::size_t local = std::min<std::size_t>(plan_.local, 128); // as the kernel has it
    jobs_.resize(all.first + all.count);
    for (std::size_t l = 0; l < left.size(); l += 4)
    {
        const std::size_t nl = std::min<std::size_t>(4, left.size() - l);
        for (std::size_t r = 0; r < right.size(); r += 4)
        {
            const std::size_t nr = std::min<std::size_t>(4, right.size() - r);
            const auto a = [&](std::size_t k) { return left[l + std::min(k, nl - 1)]; };
            const auto b = [&](std::size_t k) { return right[r + std::min(k, nr - 1)]; };
            const std::size_t first = reserve(nl * nr * blocks.count);
            launch(a(0).real(), slot::dots, local, blocks.count,
                   {as_uint(n), as_uint(blocks.length), as_uint(blocks.count), as_uint(first), as_uint(nl), as_uint(nr),
                    partials_.data(), a(0), a(1), a(2), a(3), b(0), b(1), b(2), b(3)});
            for (std::size_t i = 0; i < nl; ++i)
                for (std::size_t j = 0; j < nr; ++j)
                    jobs_[all.first + (l + i) * right.size() + r + j] = {first + (i * nr + j) * blocks.count,
                                                                         blocks.count, fold::sum};
        }
    }
    return all;
}

void reductions::fetch()
{
    fetched_ = true;
    const auto host = partials_.fetch();
    values_.clear();
    for (const job& j : jobs_) values_.push_back(folded(j, host.subspan(j.first, j.groups)));
}

void reductions::begin_round()
{
    if (!fetched_) return;
    fetched_ = false;
    partials_.clear();
    jobs_.clear();
}

std::size_t reductions::reserve(std::size_t count)
{
    begin_round();
    return partials_.reserve(count);
}

reductions::result reductions::add(std::size_t first, std::size_t groups, std::size_t count, fold how)
{
    const result r = {jobs_.size(), count};
    for (std::size_t k = 0; k < count; ++k) jobs_.push_back({first + k * groups, groups, how});
    return r;
}

void reductions::launch(scalar_type real, slot what, std::size_t local, std::size_t groups,
                        std::initializer_list<impl::argument> arguments)
{
    if (groups == 0) return;
    const auto which = static_cast<std::size_t>(what);
    auto& known = kernels_[real == scalar_type::f64][which];
    if (!known)
    {
        static constexpr const char* names[] = {"dots", "sums", "minima", "limit"};
        known = kernel(queue_, impl::vector_program(), names[which], impl::vector_options(real, queue_.device(), plan_),
                       real);
    }
    known({groups * local, local}, std::span(arguments.begin(), arguments.size()));
}

double reductions::folded(const job& j, std::span<const double> part)
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

void reductions::check(const impl::real_view& x, std::size_t end, const char* what) const
{
    if (end > x.size())
        throw parameter_error(what,
                              std::to_string(end) + " elements wanted of a buffer of " + std::to_string(x.size()));
}

std::uint32_t reductions::as_uint(std::size_t n)
{
    if (n > std::numeric_limits<std::int32_t>::max()) throw size_error("reductions", "more than 2^31 elements");
    return static_cast<std::uint32_t>(n);
}

} // namespace taut
