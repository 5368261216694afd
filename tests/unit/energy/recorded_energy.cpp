// SPDX-License-Identifier: MIT
#include <memory>

#include <doctest/doctest.h>

#include <taut/any_energy.hpp>
#include <taut/energies.hpp>

namespace
{

using namespace taut;
using namespace taut::impl;

/// A recording of what f makes of an element.
template <int D, class F>
std::shared_ptr<const energy_recording<D>> recorded(const F& f)
{
    auto r = std::make_shared<energy_recording<D>>();
    const tape_scope scope(r->recorded());
    r->finish(f(*r));
    return r;
}

template <int D>
element<double, D> some_element(std::span<const double> attributes = {}, std::span<const double> parameters = {})
{
    mat<D> S(1.25);
    S[1][0] = 0.5;
    S[0][1] = -0.25;
    return {S, glm::determinant(S), 2.0, attributes, parameters};
}

/// Node by node what f writes to a fresh tape for an element of variables.
template <int D>
std::vector<node> nodes_of(const any_energy& e, scalar_type real)
{
    tape t;
    t.constants_in(real);
    const tape_scope scope(t);
    const auto variable = [&] { return sym<double>::of(t.variable(real)); };
    element<sym<double>, D> x{};
    for (int c = 0; c < D; ++c)
        for (int r = 0; r < D; ++r) x.S[c][r] = variable();
    x.det = variable();
    x.measure = variable();
    e(x);
    std::vector<node> nodes;
    for (node_id id = 0; id < static_cast<node_id>(t.size()); ++id) nodes.push_back(t[id]);
    return nodes;
}

} // namespace

TEST_CASE("recorded energy: a recording of an energy has its values, bit for bit, and writes its operations")
{
    const auto isometric = [](auto& r)
    { return norm2(r.S()) * (sym<double>(1) + sym<double>(1) / (r.det() * r.det())); };
    const any_energy mine = recorded_energy(recorded<2>(isometric)), theirs = energy::isometric{};
    CHECK(mine(some_element<2>()) == theirs(some_element<2>()));
    CHECK(mine.barrier());
    for (const scalar_type real : {scalar_type::f64, scalar_type::f32})
        CHECK(nodes_of<2>(mine, real) == nodes_of<2>(theirs, real));
    CHECK(check_gradient<2>(mine));
}

TEST_CASE("recorded energy: an energy of the library can be recorded, in both dimensions")
{
    const auto whole = [](auto& r)
    {
        constexpr int D = std::decay_t<decltype(r.S())>::length();
        return any_energy(energy::isometric{})(element<sym<double>, D>{r.S(), r.det(), r.measure()});
    };
    const any_energy mine = recorded_energy(recorded<2>(whole), recorded<3>(whole));
    CHECK(mine(some_element<2>()) == any_energy(energy::isometric{})(some_element<2>()));
    CHECK(mine(some_element<3>()) == any_energy(energy::isometric{})(some_element<3>()));
}

TEST_CASE("recorded energy: it reads attributes and parameters, and says which are missing")
{
    const any_energy e = recorded_energy(
        recorded<2>([](auto& r)
                    { return r.attribute(1) * r.measure() + r.parameter(0) * select(r.det() < 0, -1.0, 1.0); }),
        false);
    const double attributes[] = {5, 7}, parameters[] = {3};
    CHECK(e(some_element<2>(attributes, parameters)) == 17);
    CHECK_FALSE(e.barrier());
    CHECK_THROWS_AS(e(some_element<2>(attributes)), parameter_error);
    CHECK_THROWS_AS(e(some_element<3>(attributes, parameters)), parameter_error);
}

TEST_CASE("recorded energy: constants are energies")
{
    const any_energy e = recorded_energy(recorded<2>([](auto&) { return sym<double>(0.5); }), false);
    CHECK(e(some_element<2>()) == 0.5);
    CHECK(check_gradient<2>(e));
}
