// SPDX-License-Identifier: MIT
#include <doctest/doctest.h>

#include <taut/impl/core/solve/host_space.hpp>
#include <taut/solve.hpp>

#include <array>
#include <limits>

using taut::solve::impl::basic_host_space;

TEST_CASE_TEMPLATE("host space: its operations are those of linear algebra", T, float, double)
{
    const basic_host_space<T> space(3);
    const std::vector<T> x{1, 2, 3}, y{4, -5, 6};
    CHECK(space.make() == std::vector<T>{0, 0, 0});
    CHECK(space.dot(x, y) == 12);

    std::vector<T> z = y;
    space.axpby(2, x, -1, z);
    CHECK(z == std::vector<T>{-2, 9, 0});
    space.copy(x, z);
    CHECK(z == x);
    space.linear_combination(std::array{2.0, -1.0}, std::array{&x, &y}, z);
    CHECK(z == std::vector<T>{-2, 9, 0});
    z = x;
    space.linear_combination(std::array{2.0, -1.0}, std::array<const std::vector<T>*, 2>{&z, &y}, z);
    CHECK(z == std::vector<T>{-2, 9, 0});

    std::array<double, 4> products{};
    space.multi_dot(std::array{&x, &y}, std::array{&y, &x}, products);
    CHECK(products == std::array{12.0, 14.0, 77.0, 12.0}); // row-major: left by right
}

TEST_CASE("host space: axpby with b = 0 does not read y")
{
    const basic_host_space<double> space(2);
    std::vector<double> y(2, std::numeric_limits<double>::quiet_NaN());
    space.axpby(3, {1, 2}, 0, y);
    CHECK(y == std::vector<double>{3, 6});
}

TEST_CASE("host space: float vectors have double products")
{
    const basic_host_space<float> space(3);
    CHECK(space.dot({1e8f, 1.0f, -1e8f}, {1.0f, 1.0f, 1.0f}) == 1.0); // in float the 1 would be lost
}
