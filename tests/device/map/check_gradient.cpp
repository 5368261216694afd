// SPDX-License-Identifier: MIT
#include <type_traits>

#include <doctest/doctest.h>

#include <taut/energy/algebra.hpp>
#include <taut/energy/isometric.hpp>
#include <taut/map/check_gradient.hpp>

namespace
{

using namespace taut;

/// Says one thing to numbers and another to the tape.
struct two_faced
{
    static constexpr bool barrier = false;
    template <class T, int D>
    T operator()(const element<T, D>& e) const
    {
        return std::is_same_v<T, double> ? norm2(e.S) : T(2.0) * norm2(e.S);
    }
};

/// Claims to be a barrier and is finite everywhere.
struct leaky
{
    static constexpr bool barrier = true;
    template <class T, int D>
    T operator()(const element<T, D>& e) const
    {
        return norm2(e.S);
    }
};

/// Exists for triangles only.
struct planar
{
    static constexpr bool barrier = false;
    template <class T>
    T operator()(const element<T, 2>& e) const
    {
        return norm2(e.S);
    }
};

} // namespace

TEST_CASE("check_gradient: the library's energies pass in both dimensions")
{
    using namespace taut::energy;
    for (const any_energy& e : {any_energy(isometric{}), any_energy(shape{}), any_energy(area{}),
                                any_energy(0.3 * isometric{} + shape{} * area{})})
    {
        CHECK(check_gradient<2>(e));
        CHECK(check_gradient<3>(e));
    }
}

TEST_CASE("check_gradient: an energy that differs between numbers and traces fails")
{
    CHECK_FALSE(check_gradient<2>(two_faced{}));
    CHECK_FALSE(check_gradient<3>(two_faced{}));
}

TEST_CASE("check_gradient: a barrier that is none fails")
{
    const auto found = check_gradient<2>(leaky{});
    CHECK_FALSE(found);
    CHECK_FALSE(found.barrier);
    CHECK(found.worst < 1e-6);
}

TEST_CASE("any_energy: a dimension that the energy does not have is refused")
{
    CHECK(check_gradient<2>(planar{}));
    CHECK_THROWS_AS(check_gradient<3>(planar{}), parameter_error);
}
