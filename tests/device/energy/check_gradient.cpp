// SPDX-License-Identifier: MIT
#include <cmath>
#include <sstream>
#include <string>
#include <type_traits>

#include <doctest/doctest.h>

#include <taut/any_energy.hpp>
#include <taut/energies.hpp>
#include <taut/impl/core/energy/algebra.hpp>
#include <taut/impl/core/energy/check_gradient.hpp>

namespace
{

using namespace taut;
using namespace taut::impl;

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

/// A barrier of det S beside a smooth term.
template <class Function>
struct barrier_of
{
    static constexpr bool barrier = true;
    template <class T, int D>
    T operator()(const element<T, D>& e) const
    {
        return norm2(e.S) + 0.05 * Function()(e.det);
    }
};

struct log_barrier
{
    template <class T>
    T operator()(const T& det) const
    {
        using std::log;
        return det - 1.0 - log(det);
    }
};

/// Grows a million times and then no more.
struct bounded
{
    template <class T>
    T operator()(const T& det) const
    {
        return 1.0 / (det + 1e-6);
    }
};

/// Counts stretch along the first edge twice.
struct warp
{
    static constexpr bool barrier = false;
    template <class T, int D>
    T operator()(const element<T, D>& e) const
    {
        return norm2(e.S) + dot(e.S[0], e.S[0]);
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

TEST_CASE("check_gradient: a logarithmic barrier is one, a bounded one is not")
{
    CHECK(check_gradient<2>(barrier_of<log_barrier>{}));
    CHECK(check_gradient<3>(barrier_of<log_barrier>{}));
    CHECK_FALSE(check_gradient<2>(barrier_of<bounded>{}).barrier);
    CHECK_FALSE(check_gradient<3>(barrier_of<bounded>{}).barrier);
}

TEST_CASE("check_gradient: an energy that sees the frame of the rest shape fails, and is told from others")
{
    const auto found = check_gradient<2>(warp{});
    CHECK_FALSE(found);
    CHECK_FALSE(found.isotropic());
    CHECK(found.derivative());
    CHECK(found.barrier);
    CHECK_FALSE(check_gradient<3>(warp{}).isotropic());

    const auto text = [](const gradient_check& c) { return (std::ostringstream() << c).str(); };
    CHECK(text(found).find("which corner comes first") != std::string::npos);
    CHECK(text(check_gradient<2>(leaky{})).find("stays bounded") != std::string::npos);
    CHECK(text(check_gradient<2>(two_faced{})).find("finite differences") != std::string::npos);
    CHECK(text(check_gradient<2>(energy::isometric{})) == "no fault in 100 trials");
}

TEST_CASE("any_energy: a dimension that the energy does not have is refused")
{
    CHECK(check_gradient<2>(planar{}));
    CHECK_THROWS_AS(check_gradient<3>(planar{}), parameter_error);
}
