// SPDX-License-Identifier: MIT
#include <random>

#include <doctest/doctest.h>

#include <taut/energies.hpp>
#include <taut/shell.hpp>
#include <taut/symbolic.hpp>
#include <taut/traced_vectors.hpp>

#include "host_memory.hpp"

namespace
{

/// Records value, gradient and second derivatives of an energy by the entries of S, in the precision of T, and runs
/// them at matrices around the identity, some of them folded.
template <int D, class Energy>
bool energy_runs(const Energy& energy, taut::scalar_type real, double contracted)
{
    constexpr taut::idx n = 200, entries = D * D;
    using traced = taut::sym<double>;
    taut::recording r(real);
    const auto S = r.in<double>("S", real), attributes = r.in<double>("attributes", real);
    const auto value = r.out<double>("value", real), first = r.out<double>("first", real),
               second = r.out<double>("second", real);
    const auto h = r.scalar<double>("h", real);
    const auto i = r.global_id();
    std::vector<traced> x, more;
    for (taut::idx k = 0; k < entries; ++k) x.push_back(S[i + k * n]);
    constexpr auto count = static_cast<taut::idx>(taut::impl::shell_attributes::count);
    for (taut::idx k = 0; k < count; ++k) more.push_back(attributes[i + k * n]);
    taut::element<traced, D> e{};
    for (int c = 0; c < D; ++c)
        for (int k = 0; k < D; ++k) e.S[c][k] = x[static_cast<std::size_t>(c * D + k)];
    e.det = glm::determinant(e.S);
    e.measure = traced(1);
    e.attributes = more;
    e.parameters = {&h, 1};
    const traced f = energy(e);
    value[i] = f;
    const auto gradient = taut::differentiate(f, x);
    for (taut::idx k = 0; k < entries; ++k)
    {
        const traced g = gradient[static_cast<std::size_t>(k)];
        first[i + k * n] = g;
        const auto column = taut::differentiate(g, x);
        for (taut::idx l = 0; l < entries; ++l) second[i + (k * entries + l) * n] = column[static_cast<std::size_t>(l)];
    }
    std::mt19937 random(1);
    std::uniform_real_distribution<double> noise(-0.4, 0.4);
    std::vector<double> matrices(entries * n), numbers(count * n);
    for (taut::idx k = 0; k < entries; ++k)
        for (taut::idx c = 0; c < n; ++c)
            matrices[static_cast<std::size_t>(k * n + c)] =
                noise(random) + (k % (D + 1) == 0) * (c % 10 == 0 && k == 0 ? -1 : 1);
    for (double& a : numbers) a = 1 + noise(random);
    host_memory memory;
    const auto put = [&](const char* name, const std::vector<double>& v) {
        real == taut::scalar_type::f64 ? memory.put(name, v) : memory.put(name, std::vector<float>(v.begin(), v.end()));
    };
    put("S", matrices);
    put("attributes", numbers);
    put("value", std::vector<double>(n));
    put("first", std::vector<double>(entries * n));
    put("second", std::vector<double>(entries * entries * n));
    memory.numbers["h"] = real == taut::scalar_type::f64 ? taut::impl::to_bits(0.1) : taut::impl::to_bits(0.1f);
    return runs_as_recorded(r, memory, 0, n, 1, real == taut::scalar_type::f64 ? 1e-14 : 1e-6, contracted);
}

} // namespace

TEST_CASE("rows: energies of triangles, tetrahedra and hinges, with their derivatives")
{
    CHECK(energy_runs<2>(taut::energy::isometric{}, taut::scalar_type::f64, 1e-10));
    CHECK(energy_runs<3>(taut::energy::isometric{}, taut::scalar_type::f64, 1e-10));
    CHECK(energy_runs<3>(taut::energy::shell{}, taut::scalar_type::f64, 1e-8));
    CHECK(energy_runs<2>(taut::energy::isometric{}, taut::scalar_type::f32, 1e-2));
}
