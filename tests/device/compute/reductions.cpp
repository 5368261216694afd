// SPDX-License-Identifier: MIT
#include <cmath>
#include <limits>

#include <doctest/doctest.h>

#include <taut/impl/core/compute/reductions.hpp>

#include "support/device.hpp"
#include "support/shared_context.hpp"

using taut::buffer;
using taut::real_buffer;
using taut::real_view;
using taut::reductions;
using taut::impl::reduction_plan;
using taut::impl::reductions_by;
using taut::test::random_values;
using taut::test::sized_count;

namespace
{

/// All forms run on every device but the host, which has the one for CPUs: that, the one for GPUs, and that with groups
/// smaller than a tile of dots.
std::vector<reduction_plan> forms()
{
    if (!taut::test::compiles_text()) return {reduction_plan::serial()};
    return {reduction_plan::serial(), reduction_plan::grouped(), {4, 1, 2048, 256}};
}

std::vector<std::size_t> sizes()
{
    return {0, 1, 7, 255, 257, sized_count(5000, 2100), sized_count(300001, 4999)};
}

template <class T>
long double host_dot(const std::vector<T>& x, const std::vector<T>& y, std::size_t begin, std::size_t n)
{
    long double s = 0;
    for (std::size_t i = begin; i < begin + n; ++i)
        s += static_cast<long double>(x[i]) * static_cast<long double>(y[i]);
    return s;
}

} // namespace

TEST_CASE("reductions: a plan cuts n into whole blocks that cover it, at most as many as it allows")
{
    for (const auto& plan : forms())
        for (const std::size_t n : {0ul, 1ul, 4095ul, 4097ul, 100000ul, 123456789ul})
        {
            const auto [length, count] = plan.cut(n);
            CHECK(count >= 1);
            CHECK(count <= plan.most_groups);
            CHECK(length % plan.width == 0);
            CHECK(length * count >= n);
            CHECK((count == 1 || length * (count - 1) < n));
        }
}

TEST_CASE_TEMPLATE("reductions: sums, dots and minima agree with the host at every size and form", T, float, double)
{
    taut::queue q(taut::test::shared_context());
    for (const auto& plan : forms())
    {
        reductions r = reductions_by(q, plan);
        for (const std::size_t n : sizes())
        {
            CAPTURE(n);
            CAPTURE(plan.local);
            const auto hx = random_values<T>(n, 1), hy = random_values<T>(n, 2);
            const buffer<T> x(q, hx), y(q, hy);
            const auto sum = r.sum(x);
            const auto dot = r.dot(x, y, n);
            const auto least = r.minimum(x, n);
            const auto tail = r.minimum(x, n / 2, n - n / 2);
            r.fetch();

            const std::vector<T> ones(n, T(1));
            const double scale = std::sqrt(static_cast<double>(n)) + 1;
            CHECK(std::abs(r.value(sum) - static_cast<double>(host_dot(hx, ones, 0, n))) < 1e-13 * scale);
            CHECK(std::abs(r.value(dot) - static_cast<double>(host_dot(hx, hy, 0, n))) < 1e-13 * scale);
            const double none = std::numeric_limits<double>::infinity();
            CHECK(r.value(least) == (n ? static_cast<double>(*std::min_element(hx.begin(), hx.end())) : none));
            const auto middle = hx.begin() + static_cast<std::ptrdiff_t>(n - n / 2);
            CHECK(r.value(tail) == (n > 1 ? static_cast<double>(*std::min_element(middle, hx.end())) : none));
        }
    }
}

TEST_CASE_TEMPLATE("reductions: segments are summed apart", T, float, double)
{
    taut::queue q(taut::test::shared_context());
    const std::size_t length = sized_count(9001, 1500), stride = length + 5, count = 5, start = 3;
    const auto host = random_values<T>(start + count * stride, 3);
    const buffer<T> x(q, host);
    const std::vector<T> ones(host.size(), T(1));
    for (const auto& plan : forms())
    {
        reductions r = reductions_by(q, plan);
        const auto sums = r.sum(x, {.count = count, .length = length, .stride = stride, .start = start});
        r.fetch();
        REQUIRE(r.values(sums).size() == count);
        for (std::size_t k = 0; k < count; ++k)
            CHECK(
                r.value(sums, k) ==
                doctest::Approx(static_cast<double>(host_dot(host, ones, start + k * stride, length))).epsilon(1e-12));
    }
}

TEST_CASE_TEMPLATE("reductions: every left with every right vector, at every shape of tile", T, float, double)
{
    taut::queue q(taut::test::shared_context());
    const std::size_t n = sized_count(10007, 700);
    std::vector<std::vector<T>> host;
    std::vector<buffer<T>> device;
    for (unsigned k = 0; k < 9; ++k)
    {
        host.push_back(random_values<T>(n, k));
        device.emplace_back(q, host.back());
    }
    for (const auto& plan : forms())
    {
        reductions r = reductions_by(q, plan);
        for (const std::size_t nl : {1u, 2u, 3u, 4u, 5u})
            for (const std::size_t nr : {1u, 3u, 4u, 6u})
            {
                if (plan.local > 1 && nl + nr > 8 && sized_count(0, 1) != 0) continue;
                CAPTURE(nl);
                CAPTURE(nr);
                std::vector<real_view> left, right;
                for (std::size_t i = 0; i < nl; ++i) left.emplace_back(device[i]);
                for (std::size_t j = 0; j < nr; ++j) right.emplace_back(device[8 - j]);
                const auto dots = r.dots(left, right, n);
                r.fetch();
                double worst = 0;
                for (std::size_t i = 0; i < nl; ++i)
                    for (std::size_t j = 0; j < nr; ++j)
                        worst = std::max(worst, std::abs(r.value(dots, i * nr + j) -
                                                         static_cast<double>(host_dot(host[i], host[8 - j], 0, n))));
                CHECK(worst < 1e-10);
            }
    }
}

TEST_CASE_TEMPLATE("reductions: a NaN anywhere makes the minimum NaN, an infinity does not", T, float, double)
{
    taut::queue q(taut::test::shared_context());
    const std::size_t n = sized_count(20011, 3001);
    for (const auto& plan : forms())
    {
        reductions r = reductions_by(q, plan);
        for (const std::size_t at : {std::size_t{0}, std::size_t{8}, n / 2, n - 1})
        {
            auto host = random_values<T>(n, 4);
            host[at] = std::numeric_limits<T>::quiet_NaN();
            const buffer<T> bad(q, host);
            host[at] = -std::numeric_limits<T>::infinity();
            const buffer<T> low(q, host);
            const auto nan = r.minimum(bad, n), infinite = r.minimum(low, n);
            r.fetch();
            CHECK(std::isnan(r.value(nan)));
            CHECK(r.value(infinite) == -std::numeric_limits<double>::infinity());
        }
    }
}

TEST_CASE_TEMPLATE("reductions: a limit is a fraction of a minimum, at most what is asked, NaN if that is", T, float,
                   double)
{
    taut::queue q(taut::test::shared_context());
    const std::size_t n = sized_count(20011, 3001);
    auto host = random_values<T>(n, 4);
    for (T& x : host) x = std::abs(x) + T(0.5);
    const T least = host[n / 3] = T(0.25);
    for (const auto& plan : forms())
    {
        reductions r = reductions_by(q, plan);
        buffer<T> out(q, 1);
        const auto limit = [&](double fraction, double most)
        {
            const buffer<T> x(q, host);
            r.limit(r.minimum(x, n), fraction, most, out);
            const T found = out.download()[0];
            r.fetch();
            return found;
        };
        host[n / 3] = least;
        CHECK(limit(0.5, 1) == T(0.125));
        CHECK(limit(8, 1) == T(1));
        host[n / 3] = -std::numeric_limits<T>::infinity();
        CHECK(limit(0.5, 1) == -std::numeric_limits<T>::infinity());
        host[n / 3] = std::numeric_limits<T>::quiet_NaN();
        CHECK(std::isnan(limit(0.5, 1)));
    }
}

TEST_CASE_TEMPLATE("reductions: repeat bit for bit, alone or among others", T, float, double)
{
    taut::queue q(taut::test::shared_context());
    const std::size_t n = sized_count(50021, 5003);
    const buffer<T> x(q, random_values<T>(n, 5)), y(q, random_values<T>(n, 6));
    for (const auto& plan : forms())
    {
        reductions r = reductions_by(q, plan), other = reductions_by(q, plan);
        const auto first = r.dot(x, y, n);
        r.fetch();
        const double once = r.value(first);
        // Enough company that the buffer of partials must grow on the way.
        const auto again = other.dot(x, y, n);
        std::vector<reductions::result> company;
        for (int k = 0; k < 40; ++k) company.push_back(other.sum(x, {.count = 20, .length = n / 20, .stride = n / 20}));
        const auto last = other.dot(x, y, n);
        other.fetch();
        CHECK(other.value(again) == once);
        CHECK(other.value(last) == once);
        CHECK(other.value(company[0], 7) == other.value(company[39], 7));
    }
}

TEST_CASE("reductions: a number is there after its fetch(), and until the next")
{
    taut::queue q(taut::test::shared_context());
    buffer<double> x(q, 10);
    x.fill(1);
    reductions r(q);
    const auto before = r.sum(x);
    CHECK_THROWS_WITH_AS(r.value(before), doctest::Contains("call fetch() first"), taut::parameter_error);
    for (int again = 0; again < 2; ++again)
    {
        r.fetch();
        CHECK(r.value(before) == 10);
    }
    const auto after = r.sum(x);
    CHECK(r.value(before) == 10);
    CHECK_THROWS_AS(r.value(after), taut::parameter_error);
    r.fetch();
    CHECK(r.value(after) == 10);
    CHECK_THROWS_WITH_AS(r.value(before), doctest::Contains("last fetch()"), taut::parameter_error);
}

TEST_CASE("reductions: many share one wait, and a new round begins after it")
{
    taut::queue q(taut::test::shared_context());
    buffer<double> x(q, 100);
    x.fill(0.25);
    reductions r(q);
    for (int round = 1; round <= 3; ++round)
    {
        const auto before = q.counters();
        const auto a = r.sum(x);
        const auto b = r.minimum(x, 100);
        const auto c = r.dot(x, x, 100);
        CHECK(q.counters().waits == before.waits);
        r.fetch();
        CHECK(q.counters().waits == before.waits + 1);
        CHECK(q.counters().launches == before.launches + 3);
        CHECK(r.value(a) == 25);
        CHECK(r.value(b) == 0.25);
        CHECK(r.value(c) == 6.25);
    }
}

TEST_CASE("reductions: float sums keep double accuracy")
{
    taut::queue q(taut::test::shared_context());
    const std::size_t n = sized_count(1000000, 20000);
    buffer<float> x(q, n);
    x.fill(0.1f);
    reductions r(q);
    const auto sum = r.sum(x);
    r.fetch();
    CHECK(r.value(sum) == doctest::Approx(static_cast<double>(n) * static_cast<double>(0.1f)).epsilon(1e-13));
}

TEST_CASE("reductions: float works on a device without fp64, to float accuracy")
{
    taut::queue q(taut::find_device().without_fp64());
    const std::size_t n = sized_count(100000, 5000);
    const auto host = random_values<float>(n, 8);
    const buffer<float> x(q, host);
    for (const auto& plan : forms())
    {
        reductions r = reductions_by(q, plan);
        const auto square = r.dot(x, x, n);
        const auto least = r.minimum(x, n);
        r.fetch();
        CHECK(r.value(square) == doctest::Approx(static_cast<double>(host_dot(host, host, 0, n))).epsilon(1e-5));
        CHECK(r.value(least) == static_cast<double>(*std::min_element(host.begin(), host.end())));
    }
}

TEST_CASE_TEMPLATE("reductions: a buffer whose precision is data has the same results bit for bit", T, float, double)
{
    taut::queue q(taut::test::shared_context());
    constexpr auto type = taut::impl::scalar_type_of<T>;
    const std::size_t n = sized_count(9001, 1500);
    const auto hx = random_values<T>(n, 9), hy = random_values<T>(n, 10);
    const buffer<T> x(q, hx), y(q, hy);
    const real_buffer rx(q, type, std::vector<double>(hx.begin(), hx.end())),
        ry(q, type, std::vector<double>(hy.begin(), hy.end()));
    for (const auto& plan : forms())
    {
        reductions r = reductions_by(q, plan);
        const auto sum = r.sum(x), sum_again = r.sum(rx);
        const auto dot = r.dot(x, y, n), dot_again = r.dot(rx, ry, n), dot_mixed = r.dot(x, ry, n);
        const auto least = r.minimum(x, n), least_again = r.minimum(rx, n);
        buffer<T> limit(q, 1);
        real_buffer limit_again(q, type, 1);
        r.limit(least, 0.5, 1, limit);
        r.limit(least_again, 0.5, 1, limit_again);
        r.fetch();
        CHECK(r.value(sum_again) == r.value(sum));
        CHECK(r.value(dot_again) == r.value(dot));
        CHECK(r.value(dot_mixed) == r.value(dot));
        CHECK(r.value(least_again) == r.value(least));
        CHECK(limit_again.download()[0] == static_cast<double>(limit.download()[0]));
        CHECK(limit_again.download()[0] == 0.5 * r.value(least));
    }
}

TEST_CASE("reductions: ranges outside of a buffer are refused")
{
    taut::queue q(taut::test::shared_context());
    const buffer<double> x(q, std::vector<double>(10, 1.0)), y(q, std::vector<double>(9, 1.0));
    reductions r(q);
    CHECK_THROWS_AS(r.dot(x, y, 10), taut::parameter_error);
    CHECK_THROWS_AS(r.minimum(x, 5, 6), taut::parameter_error);
    CHECK_THROWS_AS(r.sum(x, {.count = 3, .length = 4, .stride = 4}), taut::parameter_error);
}
