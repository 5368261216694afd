// SPDX-License-Identifier: MIT
#include <numeric>

#include <doctest/doctest.h>

#include <taut/impl/core/compute/gather.hpp>

#include "support/device.hpp"
#include "support/shared_context.hpp"

using taut::real_buffer;
using taut::scalar_type;
using taut::test::random_reals;
using taut::test::sized_count;

namespace
{

/// A random incidence: `rows` vertices, of which some meet no cell and one meets very many.
struct incidence
{
    std::vector<taut::idx> offsets{0}, cells, corners;

    incidence(std::size_t rows, taut::idx cell_count, taut::idx corner_count)
    {
        std::mt19937 random(7);
        for (std::size_t v = 0; v < rows; ++v)
        {
            const std::size_t valence = v == rows / 2 ? 75 : random() % 8;
            for (std::size_t k = 0; k < valence; ++k)
            {
                cells.push_back(static_cast<taut::idx>(random() % static_cast<unsigned>(cell_count)));
                corners.push_back(static_cast<taut::idx>(random() % static_cast<unsigned>(corner_count)));
            }
            offsets.push_back(static_cast<taut::idx>(cells.size()));
        }
    }
};

} // namespace

TEST_CASE_TEMPLATE("gather: sums the contributions of a vertex's corners, in order, at every valence", T, float, double)
{
    taut::queue q(taut::test::shared_context());
    constexpr scalar_type type = taut::impl::scalar_type_of<T>;
    for (const int D : {2, 3})
    {
        CAPTURE(D);
        const std::size_t rows = sized_count(1000, 150), vertices = taut::impl::padded(rows + 3, 64), cells = 192;
        const auto corners = static_cast<std::size_t>(D) + 1;
        const incidence meet(rows, 190, static_cast<taut::idx>(corners));
        const taut::impl::gather sum(q, meet.offsets, meet.cells, meet.corners, {D, cells, vertices}, type, type);

        const auto d = static_cast<std::size_t>(D);
        const auto host = random_reals(type, corners * d * cells, 3);
        const real_buffer contributions(q, type, host);
        real_buffer out(q, type, d * vertices);
        out.fill(9);
        sum(contributions, out);

        // Sums in T and in the order of the rows: equal to the last bit.
        std::vector<T> expected(d * vertices, T(0));
        for (std::size_t v = 0; v < rows; ++v)
            for (std::size_t c = 0; c < d; ++c)
                for (auto k = static_cast<std::size_t>(meet.offsets[v]);
                     k < static_cast<std::size_t>(meet.offsets[v + 1]); ++k)
                    expected[c * vertices + v] +=
                        static_cast<T>(host[(static_cast<std::size_t>(meet.corners[k]) * d + c) * cells +
                                            static_cast<std::size_t>(meet.cells[k])]);
        CHECK(out.download() == std::vector<double>(expected.begin(), expected.end()));
    }
}

TEST_CASE("gather: agrees with the host at every width that its kernels have")
{
    taut::queue q(taut::test::shared_context());
    const std::size_t rows = 60, cells = 128;
    std::mt19937 random(11);
    const auto host = random_reals(scalar_type::f64, 4 * 3 * cells, 3);
    const real_buffer contributions(q, scalar_type::f64, host);
    for (const std::size_t valence : {1u, 4u, 5u, 7u, 10u, 11u, 16u, 20u, 30u, 40u, 48u, 60u})
    {
        CAPTURE(valence);
        std::vector<taut::idx> offsets{0}, cell, corner;
        std::vector<double> expected(3 * 64, 0.0);
        for (std::size_t v = 0; v < rows; ++v)
        {
            for (std::size_t k = 0; k < valence; ++k)
            {
                cell.push_back(static_cast<taut::idx>(random() % cells));
                corner.push_back(static_cast<taut::idx>(random() % 4));
                for (std::size_t c = 0; c < 3; ++c)
                    expected[c * 64 + v] += host[(static_cast<std::size_t>(corner.back()) * 3 + c) * cells +
                                                 static_cast<std::size_t>(cell.back())];
            }
            offsets.push_back(static_cast<taut::idx>(cell.size()));
        }
        const taut::impl::gather sum(q, offsets, cell, corner, {3, cells, 64}, scalar_type::f64, scalar_type::f64);
        real_buffer out(q, scalar_type::f64, 3 * 64);
        sum(contributions, out);
        CHECK(out.download() == expected);
    }
    CHECK(taut::test::has_built(q, 1));
}

TEST_CASE("gather: sums are formed in the type of the terms, and stored in another")
{
    taut::queue q(taut::test::shared_context());
    const std::size_t cells = 128;
    // A vertex of the first launch, and one whose rest is summed in the second: 1 is lost in float beside 2^24.
    std::vector<taut::idx> offsets{0, 3}, cell{0, 1, 2}, corner{0, 0, 0};
    for (int v = 0; v < 59; ++v) offsets.push_back(3);
    for (taut::idx k = 0; k < 60; ++k) cell.push_back(k), corner.push_back(1);
    offsets.push_back(63);
    std::vector<double> host(2 * 2 * cells, 0.0);
    host[0] = host[2 * cells] = 0x1p24;
    host[1] = host[2] = 1;
    for (std::size_t k = 1; k < 60; ++k) host[2 * cells + k] = 1;
    for (const scalar_type term : {scalar_type::f32, scalar_type::f64})
        for (const scalar_type sum : {scalar_type::f32, scalar_type::f64})
        {
            const taut::impl::gather add(q, offsets, cell, corner, {2, cells, 64}, term, sum);
            const real_buffer contributions(q, term, host);
            real_buffer out(q, sum, 128);
            add(contributions, out);
            const auto result = out.download();
            const bool narrow = term == scalar_type::f32;
            CHECK(result[0] == 0x1p24 + (narrow ? 0 : 2));
            CHECK(result[60] >= 0x1p24);
            CHECK(result[60] <= 0x1p24 + (narrow ? 0 : 60));
            if (!narrow && sum == scalar_type::f64) CHECK(result[60] == 0x1p24 + 59);
            CHECK(result[64] == 0);
        }
}

TEST_CASE("gather: an absent slot reads nothing into the sum, not even a NaN")
{
    taut::queue q(taut::test::shared_context());
    // One vertex, in corner 1 of cell 1; the place that fillers read, cell 0, holds NaN.
    const std::vector<taut::idx> offsets = {0, 1}, cells = {1}, corners = {1};
    const taut::impl::gather sum(q, offsets, cells, corners, {2, 64, 64}, scalar_type::f64, scalar_type::f64);
    std::vector<double> host(3 * 2 * 64, std::numeric_limits<double>::quiet_NaN());
    host[2 * 64 + 1] = 5;
    host[3 * 64 + 1] = 6;
    const real_buffer contributions(q, scalar_type::f64, host);
    real_buffer out(q, scalar_type::f64, 128);
    sum(contributions, out);
    const auto result = out.download();
    CHECK(result[0] == 5);
    CHECK(result[64] == 6);
    CHECK(std::accumulate(result.begin(), result.end(), 0.0) == 11);
    CHECK(q.counters().launches == 1);
}

TEST_CASE("gather: layouts that do not hold the mesh are refused")
{
    taut::queue q(taut::test::shared_context());
    const std::vector<taut::idx> offsets = {0, 1}, cells = {70}, corners = {0};
    const auto make = [&](const taut::impl::gather_layout& layout)
    { return taut::impl::gather(q, offsets, cells, corners, layout, scalar_type::f64, scalar_type::f64); };
    CHECK_THROWS_AS(make({2, 64, 64}), taut::parameter_error);
    CHECK_THROWS_AS(make({2, 128, 100}), taut::parameter_error);
    CHECK_THROWS_AS(make({2, 128, 0}), taut::parameter_error);

    const std::vector<taut::idx> first = {0};
    const taut::impl::gather one(q, offsets, first, first, {2, 64, 64}, scalar_type::f64, scalar_type::f64);
    real_buffer enough(q, scalar_type::f64, 128), few(q, scalar_type::f64, 64), narrow(q, scalar_type::f32, 128);
    CHECK_THROWS_AS(one(few, enough), taut::parameter_error);
    CHECK_THROWS_AS(one(enough, few), taut::parameter_error);
    CHECK_THROWS_AS(one(narrow, enough), taut::parameter_error);
    CHECK_THROWS_AS(one(enough, narrow), taut::parameter_error);
}

TEST_CASE("gather: without any cell all sums are zero")
{
    taut::queue q(taut::test::shared_context());
    const taut::impl::gather nothing(q, {}, {}, {}, {3, 0, 64}, scalar_type::f32, scalar_type::f32);
    real_buffer none(q, scalar_type::f32, 0), out(q, scalar_type::f32, 192);
    nothing(none, out);
    CHECK(out.download() == std::vector<double>(192, 0.0));
}
