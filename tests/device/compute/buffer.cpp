// SPDX-License-Identifier: MIT
#include <numeric>

#include <doctest/doctest.h>

#include <taut/queue.hpp>

#include "support/device.hpp"

TEST_CASE_TEMPLATE("buffer: what is uploaded is downloaded", T, float, double, taut::idx, std::uint64_t)
{
    taut::queue q;
    std::vector<T> values(1000);
    std::iota(values.begin(), values.end(), T(1));
    taut::buffer<T> b(q, values);
    CHECK(b.size() == 1000);
    CHECK(b.bytes() == 1000 * sizeof(T));
    CHECK(b.download() == values);

    const std::vector<T> part = {T(7), T(8)};
    b.upload(part, 998);
    std::vector<T> last(3);
    b.download(std::span(last), 997);
    CHECK(last == std::vector<T>{T(998), T(7), T(8)});
}

TEST_CASE("buffer: nothing is a legal size")
{
    taut::queue q;
    taut::buffer<float> b(q, 0), c(q, std::vector<float>{});
    b.fill(1);
    b.upload(std::vector<float>{});
    b.copy_from(c);
    CHECK(b.download().empty());
    CHECK(b.empty());
    CHECK(q.counters().waits == 0);
    const taut::buffer<float> of_no_queue;
    CHECK(of_no_queue.empty());
}

TEST_CASE("buffer: fill and copy, whole and at an offset")
{
    taut::queue q;
    taut::buffer<float> a(q, 4), b(q, 2);
    a.fill(1.5f);
    b.fill(-2);
    a.copy_from(b, 1);
    CHECK(a.download() == std::vector<float>{1.5f, -2, -2, 1.5f});
    a.copy_from(a);
    CHECK(a.download()[3] == 1.5f);
}

TEST_CASE("buffer: transfers outside of it are refused with the numbers")
{
    taut::queue q;
    taut::buffer<float> b(q, 4);
    const taut::buffer<float> larger(q, 5);
    CHECK_THROWS_AS(b.upload(std::vector<float>(3), 2), taut::parameter_error);
    CHECK_THROWS_AS(b.upload(std::vector<float>(1), 5), taut::parameter_error);
    std::vector<float> values(5);
    CHECK_THROWS_WITH_AS(b.download(std::span(values)),
                         "parameter download from a buffer: 5 elements from 0 do not fit a buffer of 4",
                         taut::parameter_error);
    CHECK_THROWS_AS(b.copy_from(larger), taut::parameter_error);
    CHECK_THROWS_AS(b.copy_from(b, 1), taut::parameter_error);
}

TEST_CASE("buffer: moves carry the memory, and its bytes are given back once")
{
    taut::queue q;
    {
        taut::buffer<double> a(q, std::vector<double>{1, 2, 3});
        taut::buffer<double> b = std::move(a);
        CHECK(b.download() == std::vector<double>{1, 2, 3});
        CHECK(q.allocated() == 24);
        b = taut::buffer<double>(q, 10);
        CHECK(b.size() == 10);
        CHECK(q.allocated() == 80);
    }
    CHECK(q.allocated() == 0);
}

TEST_CASE("buffer: memory outlives the queue that made it")
{
    taut::buffer<float> b;
    {
        taut::queue q;
        b = taut::buffer<float>(q, std::vector<float>{4, 5});
    }
    CHECK(b.download() == std::vector<float>{4, 5});
}

TEST_CASE("buffer: sizes beyond the device's limits are refused before the driver sees them")
{
    taut::queue q(taut::find_device().with_memory(1000, 600));
    CHECK_THROWS_AS(taut::buffer<float>(q, 151), taut::device_error); // 604 bytes in one buffer
    taut::buffer<float> first(q, 150);
    CHECK_THROWS_AS(taut::buffer<float>(q, 101), taut::device_error); // 600 + 404 in all
    CHECK(q.allocated() == 600);
    taut::buffer<float> second(q, 100);
    CHECK(q.allocated() == 1000);

    taut::queue real;
    CHECK_THROWS_AS(taut::buffer<double>(real, std::size_t{1} << 50), taut::device_error);
    CHECK_THROWS_AS(taut::buffer<double>(real, ~std::size_t{0} / 4), taut::device_error);
}
