// SPDX-License-Identifier: MIT
#include <doctest/doctest.h>

#include <taut/kernel.hpp>
#include <taut/symbolic.hpp>

#include "support/device.hpp"
#include "support/shared_context.hpp"

using taut::buffer;
using taut::handler;

TEST_CASE_TEMPLATE("handler: a command group reads, writes and updates buffers, with a uniform", T, float, double)
{
    taut::queue q(taut::test::shared_context());
    const std::size_t n = 300;
    const buffer<T> bx(q, std::vector<T>(n, T(2)));
    buffer<T> by(q, std::vector<T>(n, T(1))), bz(q, n);
    for (const T alpha : {T(3), T(-1)})
    {
        const taut::event done = q.submit(
            [&](handler& h)
            {
                auto x = bx.read(h);
                auto y = by.read_write(h);
                auto z = bz.write(h);
                auto a = h.uniform(alpha);
                h.parallel_for(n,
                               [=](auto i)
                               {
                                   y[i] = a * x[i] + y[i];
                                   z[i] = y[i] * y[i];
                               });
            });
        done.wait();
        CHECK(done.complete());
    }
    CHECK(by.download() == std::vector<T>(n, T(5)));
    CHECK(bz.download() == std::vector<T>(n, T(25)));
    // The uniform changed, the text did not.
    CHECK(taut::test::has_built(q, 1));
    CHECK(q.counters().launches == 2);
}

TEST_CASE("handler: a captured host value is a literal, so another value is another kernel")
{
    taut::queue q(taut::test::shared_context());
    buffer<float> b(q, std::vector<float>(5, 1.0f));
    for (const float factor : {2.0f, 4.0f, 2.0f})
        q.submit(
            [&](handler& h)
            {
                auto x = b.read_write(h);
                h.parallel_for("scaled", 5, [=](auto i) { x[i] = factor * x[i]; });
            });
    CHECK(b.download() == std::vector<float>(5, 16.0f));
    CHECK(taut::test::has_built(q, 2));
}

TEST_CASE("handler: rows of a graph are loops of the kernel, over more elements than there are indices")
{
    taut::queue q(taut::test::shared_context());
    const buffer<taut::idx> starts(q, std::vector<taut::idx>{0, 2, 2, 5});
    const buffer<taut::idx> columns(q, std::vector<taut::idx>{1, 3, 0, 1, 2});
    const buffer<float> x(q, std::vector<float>{1, 10, 100, 1000});
    buffer<float> sums(q, 3);
    q.submit(
        [&](handler& h)
        {
            auto row = starts.read(h);
            auto column = columns.read(h);
            auto from = x.read(h);
            auto to = sums.write(h);
            h.parallel_for(3,
                           [=](auto i)
                           {
                               const auto sum =
                                   taut::sum_over(row[i], row[i + 1], [&](auto k) { return from[column[k]]; });
                               to[i] = select(sum > 500.0f, 500.0f, sum);
                           });
        });
    CHECK(sums.download() == std::vector<float>{500, 0, 111});
}

TEST_CASE("handler: misuse is refused in words")
{
    taut::queue q(taut::test::shared_context());
    buffer<float> b(q, std::vector<float>(5, 1.0f));
    const auto twice = [&](handler& h)
    {
        auto x = b.read_write(h);
        h.parallel_for(5, [=](auto i) { x[i] += 1; });
        h.parallel_for(5, [=](auto i) { x[i] += 1; });
    };
    CHECK_THROWS_AS(q.submit(twice), taut::device_error);
    const auto overlapping = [&](handler& h)
    {
        auto x = b.read(h);
        auto y = b.write(h);
        h.parallel_for(5, [=](auto i) { y[i] = x[i]; });
    };
    CHECK_THROWS_AS(q.submit(overlapping), taut::device_error);
    const auto before = b.download();
    const auto beyond = [&](handler& h)
    {
        auto x = b.read_write(h);
        h.parallel_for("doubled", 50, [=](auto i) { x[i] += x[i]; });
    };
    CHECK_THROWS_WITH_AS(
        q.submit(beyond),
        doctest::Contains("launching doubled: argument 0 is used at [i] for 50 indices, and the buffer "
                          "has 5 elements"),
        taut::device_error);
    CHECK(b.download() == before);
    const auto nothing = [](handler&) {};
    CHECK(q.submit(nothing).complete());
}
