// SPDX-License-Identifier: MIT
// What users say of single triangles, and numbers that change without another kernel.
#include <array>
#include <cmath>
#include <cstddef>
#include <random>
#include <string>
#include <vector>

#include <doctest/doctest.h>

#include <support/meshes.hpp>
#include <support/shared_context.hpp>
#include <support/size.hpp>

#include <taut/energies.hpp>
#include <taut/evaluator.hpp>
#include <taut/impl/core/exact/cell_validity.hpp>
#include <taut/impl/core/measure/distortion.hpp>
#include <taut/impl/core/mesh/ideal.hpp>
#include <taut/parameterize.hpp>
#include <taut/quality.hpp>

namespace
{

using namespace taut;
using namespace taut::impl;

/// Shape, and as much of area as the triangle asks for.
struct mixed
{
    static constexpr bool barrier = true;

    template <class T, int D>
    T operator()(const element<T, D>& e) const
    {
        return energy::shape{}(e) + e.attribute(0) * energy::area{}(e);
    }
};

/// Area as much as a slider says.
struct slid
{
    static constexpr bool barrier = true;

    template <class T, int D>
    T operator()(const element<T, D>& e) const
    {
        return energy::shape{}(e) + e.parameter(0) * energy::area{}(e);
    }
};

/// Stiff along the first axis.
struct cloth
{
    static constexpr bool barrier = true;

    template <class T, int D>
    T operator()(const element<T, D>& e) const
    {
        const T warp = glm::dot(e.S[0], e.S[0]);
        return energy::isometric{}(e) + T(10) * (warp - T(1)) * (warp - T(1));
    }
};

mesh<triangle> rough_hill()
{
    return test::bumpy(test::sized(40, 14), 0.5, 3);
}

/// The mean of the isometric energy over the triangles whose middle has x < 0.5, and over the others.
std::array<double, 2> halves(const mesh<triangle>& m, const std::vector<vec2>& uv)
{
    const ideal_elements<triangle> ideal(m);
    std::array<double, 2> sum{}, weight{};
    for (std::size_t c = 0; c < m.cells().size(); ++c)
    {
        const auto x = m.rest(static_cast<idx>(c));
        const std::size_t side = x[0].x + x[1].x + x[2].x < 1.5 ? 0 : 1;
        const auto e = mapped_element(m, ideal, uv, c);
        sum[side] += e.measure * energy::isometric{}(e);
        weight[side] += e.measure;
    }
    return {sum[0] / weight[0], sum[1] / weight[1]};
}

std::vector<double> painted(const mesh<triangle>& m, double left, double right)
{
    std::vector<double> values;
    for (std::size_t c = 0; c < m.cells().size(); ++c)
    {
        const auto x = m.rest(static_cast<idx>(c));
        values.push_back(x[0].x + x[1].x + x[2].x < 1.5 ? left : right);
    }
    return values;
}

} // namespace

TEST_CASE("data: where weights are painted high, the map is less distorted, with every solver")
{
    const auto m = rough_hill();
    queue q(test::shared_context());
    for (const auto method : {solve::method::automatic, solve::method::lbfgs})
    {
        const solve::params some{.method = method, .max_iterations = 300};
        const auto plain = parameterize(q, m, {.solve = some});
        const auto left = parameterize(q, m, {.data = {.weights = painted(m, 50, 1)}, .solve = some});
        REQUIRE(plain);
        REQUIRE(left);
        const auto before = halves(m, plain.uv), after = halves(m, left.uv);
        CHECK(after[0] < before[0]);
        CHECK(after[1] > before[1]);
    }
    // One weight everywhere is none.
    const auto same = parameterize(q, m, {.data = {.weights = std::vector<double>(m.cells().size(), 7.0)}});
    const auto plain = parameterize(q, m);
    CHECK(same.report.solve.value == doctest::Approx(plain.report.solve.value).epsilon(1e-9));
}

TEST_CASE("data: an energy reads attributes of its triangle, on the device as on the host")
{
    const auto m = rough_hill();
    queue q(test::shared_context());
    const cell_data data{.attribute_count = 1, .attributes = painted(m, 0.1, 5)};
    const auto map = parameterize(q, m, {.energy = mixed{}, .data = data});
    REQUIRE(map);
    CHECK(map.report.solve.stop == solve::stop::gradient);

    const ideal_elements<triangle> ideal(m);
    double sum = 0, total = 0;
    for (std::size_t c = 0; c < m.cells().size(); ++c)
    {
        auto e = mapped_element(m, ideal, map.uv, c);
        e.attributes = std::span(data.attributes).subspan(c, 1);
        sum += e.measure * mixed{}(e);
        total += e.measure;
    }
    CHECK(map.report.solve.value == doctest::Approx(sum / total).epsilon(1e-6));
    map_evaluator<triangle> f(q, m, mixed{}, energy::weighting::measure, precision::fp64, data);
    CHECK(f.value(map.uv) == doctest::Approx(sum / total).epsilon(1e-9));

    // An even attribute is a constant of the energy.
    const cell_data even{.attribute_count = 1, .attributes = std::vector<double>(m.cells().size(), 1.0)};
    const auto one = parameterize(q, m, {.energy = mixed{}, .data = even});
    const auto sum_of_both = parameterize(q, m, {.energy = {slid{}, {1.0}}});
    CHECK(one.report.solve.value == doctest::Approx(sum_of_both.report.solve.value).epsilon(1e-9));
}

TEST_CASE("data: another parameter takes no other kernel")
{
    const auto m = rough_hill();
    queue q(test::shared_context());
    const auto first = parameterize(q, m, {.energy = {slid{}, {0.5}}});
    REQUIRE(first);
    const auto builds = q.counters().builds;
    double before = first.report.solve.value;
    for (const double p : {1.0, 2.0, 4.0})
    {
        const auto next = parameterize(q, m, {.energy = {slid{}, {p}}});
        REQUIRE(next);
        CHECK(next.report.solve.value > before); // area costs more
        before = next.report.solve.value;
    }
    CHECK(q.counters().builds == builds);
}

TEST_CASE("data: with directions an anisotropic energy does not depend on which corner comes first")
{
    const auto m = rough_hill();
    auto cells = m.cells();
    std::mt19937 rng(2);
    for (auto& t : cells)
        for (auto turns = rng() % 3; turns > 0; --turns) t = {t[1], t[2], t[0]};
    const mesh<triangle> turned(m.points(), cells);
    const cell_data data{.directions = std::vector<vec3>(cells.size(), vec3(2, 1, 0))};
    queue q(test::shared_context());
    const auto one = parameterize(q, m, {.energy = cloth{}, .data = data});
    const auto two = parameterize(q, turned, {.energy = cloth{}, .data = data});
    REQUIRE(one);
    REQUIRE(two);
    CHECK(one.report.solve.value == doctest::Approx(two.report.solve.value).epsilon(1e-6));
    // The direction matters: across it the cloth gives way.
    const auto across = parameterize(
        q, m, {.energy = cloth{}, .data = {.directions = std::vector<vec3>(cells.size(), vec3(-1, 2, 0))}});
    REQUIRE(across);
    CHECK(across.report.solve.value != doctest::Approx(one.report.solve.value).epsilon(1e-4));
}

TEST_CASE("data: what does not fit is refused by name")
{
    const auto m = rough_hill();
    queue q(test::shared_context());
    const auto field = [&](const parameterize_params& p)
    {
        try
        {
            parameterize(q, m, p);
        }
        catch (const parameter_error& e)
        {
            return std::string(e.field());
        }
        return std::string("none");
    };
    const std::size_t n = m.cells().size();
    CHECK(field({.data = {.weights = {1, 2}}}) == "data.weights");
    CHECK(field({.data = {.weights = std::vector<double>(n, 0.0)}}) == "data.weights");
    CHECK(field({.data = {.attribute_count = 2, .attributes = std::vector<double>(n)}}) == "data.attributes");
    CHECK(field({.data = {.attribute_count = 1}}) == "data.attributes");
    CHECK(field({.data = {.directions = std::vector<vec3>(n, vec3(0))}}) == "data.directions");
    CHECK(field({.energy = mixed{}}) == "attributes");
    CHECK(field({.energy = slid{}}) == "parameters");
}
