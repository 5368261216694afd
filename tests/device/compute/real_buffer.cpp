// SPDX-License-Identifier: MIT
#include <cmath>
#include <limits>

#include <doctest/doctest.h>

#include <taut/kernel.hpp>
#include <taut/queue.hpp>

#include "support/device.hpp"
#include "support/shared_context.hpp"

using taut::real_buffer;
using taut::scalar_type;
using taut::test::random_reals;

namespace
{

constexpr scalar_type real_types[] = {scalar_type::f32, scalar_type::f64};

} // namespace

TEST_CASE("real_buffer: what is uploaded is downloaded, in the precision of the buffer")
{
    taut::queue q(taut::test::shared_context());
    for (const scalar_type type : real_types)
    {
        CAPTURE(static_cast<int>(type));
        const auto values = random_reals(type, 1000, 1);
        real_buffer b(q, type, values);
        CHECK(b.type() == type);
        CHECK(b.size() == 1000);
        CHECK(!b.empty());
        CHECK(b.bytes() == 1000 * taut::impl::size_of(type));
        CHECK(q.allocated() == b.bytes());
        CHECK(b.download() == values);

        b.upload(std::vector<double>{0.1, 0x1p-60}, 998);
        std::vector<double> last(3);
        b.download(std::span(last), 997);
        CHECK(last == std::vector<double>{values[997], taut::test::as_real(type, 0.1), 0x1p-60});

        real_buffer::numbers numbers(type, 1000);
        const auto before = q.counters().waits;
        b.begin_download(numbers);
        CHECK(q.counters().waits == before);
        q.finish();
        CHECK(numbers.size() == 1000);
        CHECK(numbers[3] == values[3]);
        CHECK(numbers[998] == last[1]);
    }
}

TEST_CASE("real_buffer: numbers that are not finite stay so")
{
    taut::queue q(taut::test::shared_context());
    const double infinity = std::numeric_limits<double>::infinity();
    const std::vector<double> values = {infinity, -infinity, -0.0, std::numeric_limits<double>::quiet_NaN()};
    for (const scalar_type type : real_types)
    {
        const auto got = real_buffer(q, type, values).download();
        CHECK(got[0] == infinity);
        CHECK(got[1] == -infinity);
        CHECK(std::signbit(got[2]));
        CHECK(std::isnan(got[3]));
    }
}

TEST_CASE("real_buffer: fill and copy, whole and at an offset, without a wait")
{
    taut::queue q(taut::test::shared_context());
    for (const scalar_type type : real_types)
    {
        real_buffer a(q, type, 4), b(q, type, 2);
        const auto before = q.counters().waits;
        a.fill(0.1);
        b.fill(-2);
        a.copy_from(b, 1);
        CHECK(q.counters().waits == before);
        const double tenth = taut::test::as_real(type, 0.1);
        CHECK(a.download() == std::vector<double>{tenth, -2, -2, tenth});
        a.copy_from(a);
        CHECK(a.download()[3] == tenth);
    }
}

TEST_CASE("real_buffer: nothing is a legal size")
{
    taut::queue q(taut::test::shared_context());
    for (const scalar_type type : real_types)
    {
        real_buffer b(q, type, 0), c(q, type, std::vector<double>{});
        b.fill(1);
        b.upload(std::vector<double>{});
        b.copy_from(c);
        real_buffer::numbers none(type, 0);
        b.begin_download(none);
        CHECK(b.type() == type);
        CHECK(b.download().empty());
        CHECK(b.empty());
        CHECK(b.bytes() == 0);
        CHECK(none.size() == 0);
        CHECK(q.counters().waits == 0);
    }
    const real_buffer of_no_queue;
    CHECK(of_no_queue.empty());
    CHECK(real_buffer::numbers().size() == 0);
}

TEST_CASE("real_buffer: a copy between float and double is refused, and so are transfers outside of it")
{
    taut::queue q(taut::test::shared_context());
    real_buffer narrow(q, scalar_type::f32, 4), wide(q, scalar_type::f64, 4);
    narrow.fill(1);
    wide.fill(2);
    CHECK_THROWS_WITH_AS(narrow.copy_from(wide), doctest::Contains("float and double do not mix"),
                         taut::parameter_error);
    CHECK_THROWS_AS(wide.copy_from(narrow), taut::parameter_error);
    CHECK(narrow.download() == std::vector<double>(4, 1.0));
    CHECK(wide.download() == std::vector<double>(4, 2.0));

    for (real_buffer* b : {&narrow, &wide})
    {
        const real_buffer larger(q, b->type(), 5);
        CHECK_THROWS_AS(b->upload(std::vector<double>(3), 2), taut::parameter_error);
        std::vector<double> values(5);
        CHECK_THROWS_AS(b->download(std::span(values)), taut::parameter_error);
        CHECK_THROWS_AS(b->copy_from(larger), taut::parameter_error);
        CHECK_THROWS_AS(b->copy_from(*b, 1), taut::parameter_error);
    }
    for (const scalar_type type : {scalar_type::i32, scalar_type::boolean})
    {
        CHECK_THROWS_AS(real_buffer(q, type, 4), taut::parameter_error);
        CHECK_THROWS_AS(real_buffer(q, type, std::vector<double>(4)), taut::parameter_error);
    }
}

TEST_CASE("real_buffer: float works on a device without fp64, double is refused")
{
    taut::queue q(taut::find_device().without_fp64());
    const real_buffer narrow(q, scalar_type::f32, std::vector<double>{1.5, 2});
    CHECK(narrow.download() == std::vector<double>{1.5, 2});
    CHECK_THROWS_AS(real_buffer(q, scalar_type::f64, 2), taut::device_error);
}

TEST_CASE("real_buffer: another takes its place, of another type and size")
{
    taut::queue q(taut::test::shared_context());
    {
        real_buffer a(q, scalar_type::f64, std::vector<double>{1, 2, 3});
        real_buffer b = std::move(a);
        CHECK(b.download() == std::vector<double>{1, 2, 3});
        CHECK(q.allocated() == 24);
        b = real_buffer(q, scalar_type::f32, 10);
        CHECK(b.type() == scalar_type::f32);
        CHECK(b.size() == 10);
        CHECK(q.allocated() == 40);
    }
    CHECK(q.allocated() == 0);
}

TEST_CASE("real_buffer: a command group computes in the precision of its buffers")
{
    taut::queue q(taut::test::shared_context());
    for (const scalar_type type : real_types)
    {
        const auto hx = random_reals(type, 300, 2), hy = random_reals(type, 300, 3);
        const real_buffer bx(q, type, hx);
        real_buffer by(q, type, hy), bz(q, type, 300);
        q.submit(
            [&](taut::handler& h)
            {
                auto x = bx.read(h);
                auto y = by.read_write(h);
                auto z = bz.write(h);
                auto a = h.uniform(type, 0.1);
                h.parallel_for(300,
                               [=](auto i)
                               {
                                   z[i] = y[i] - x[i];
                                   y[i] = a * x[i];
                               });
            });
        const auto y = by.download(), z = bz.download();
        const double a = taut::test::as_real(type, 0.1);
        for (std::size_t i = 0; i < 300; ++i)
        {
            REQUIRE(y[i] == taut::test::as_real(type, a * hx[i]));
            REQUIRE(z[i] == taut::test::as_real(type, hy[i] - hx[i]));
        }
    }
}
