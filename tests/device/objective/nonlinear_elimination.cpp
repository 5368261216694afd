// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <functional>
#include <random>
#include <set>

#include <doctest/doctest.h>

#include <support/meshes.hpp>
#include <support/shared_context.hpp>

#include <taut/energies.hpp>
#include <taut/impl/core/objective/mesh_levels.hpp>
#include <taut/impl/core/objective/newton_objective.hpp>
#include <taut/impl/core/start/barycentric_map.hpp>
#include <taut/solve.hpp>

namespace
{

using namespace taut;
using namespace taut::impl;

std::size_t at(taut::idx i)
{
    return static_cast<std::size_t>(i);
}

/// A user's energy that reads a stiffness and a direction.
struct fibres
{
    static constexpr bool barrier = true;

    template <class T>
    T operator()(const element<T, 2>& e) const
    {
        return (T(1) + e.attribute(0) * glm::dot(e.S[0], e.S[0]) + glm::dot(e.S[1], e.S[1])) *
               (T(1) + T(1) / (e.det * e.det));
    }
};

/// A surface, its objective and the minimum of that with a spot in the middle disturbed.
struct disturbed
{
    mesh<triangle> surface;
    mesh_levels<triangle> levels;
    any_energy energy;
    queue q{test::shared_context()};
    newton_objective<triangle> f;
    newton_objective<triangle>::point x;
    double least;

    explicit disturbed(const real_types& types = {}, const any_energy& of = energy::isometric{},
                       const cell_data& data = {}, const std::vector<bool>& pinned = {})
        : surface(test::bumpy(40, 0.3, 5)),
          levels(surface, pinned, {}, data),
          energy(of),
          f(q, {levels, 0, lane_form::for_device(q.device())}, energy, energy::weighting::measure,
            std::make_shared<const newton_kernels<triangle>>(q, energy, types)),
          x(f.make_point())
    {
        f.upload(levels.order().vertices.apply(barycentric_map(surface).uv), x);
        least = solve::minimize(f, x, {.tuning = {.newton = {.eliminate_below = 0}}}).value;
        jitter();
    }

    /// As far as nothing flips.
    void jitter()
    {
        auto there = x.download();
        const auto& l = f.layout();
        std::mt19937 random(3);
        std::uniform_real_distribution<double> shift(-0.15, 0.15);
        for (taut::idx v = 0; v < l.free_count; ++v)
        {
            const vec3& p = surface.points()[at(levels.order().vertices.new_to_old[at(v)])];
            if (glm::length(p - middle()) > 0.08 * glm::length(surface.points().front() - surface.points().back()))
                continue;
            there[at(v)] += shift(random);
            there[l.vertex_stride + at(v)] += shift(random);
            spot.insert(v);
        }
        x.upload(there);
    }

    vec3 middle() const
    {
        vec3 sum(0.0);
        for (const vec3& p : surface.points()) sum += p;
        return sum / double(surface.points().size());
    }

    std::set<taut::idx> spot; ///< in the order of the layout
};

const std::function<bool()> always = [] { return true; };

double length_at(const std::vector<double>& g, const std::set<taut::idx>& vertices, std::size_t stride)
{
    double sum = 0;
    for (const taut::idx v : vertices) sum += g[at(v)] * g[at(v)] + g[stride + at(v)] * g[stride + at(v)];
    return std::sqrt(sum);
}

/// One attribute and one direction a cell.
cell_data warp(const mesh<triangle>& m)
{
    cell_data data;
    data.attribute_count = 1;
    for (std::size_t c = 0; c < m.cells().size(); ++c)
    {
        data.attributes.push_back(1 + double(c % 7));
        data.directions.emplace_back(std::cos(double(c)), std::sin(double(c)), 0.1);
        data.weights.push_back(1 + double(c % 3));
    }
    return data;
}

} // namespace

TEST_CASE("nonlinear elimination: a disturbed spot is minimised, and what is around it stays")
{
    for (const precision how : {precision::fp64, precision::mixed})
    {
        disturbed s(types_of(how));
        REQUIRE(s.spot.size() > 5);
        auto g = s.f.space().make();
        const double before = s.f.value_gradient(s.x, g);
        REQUIRE(std::isfinite(before));
        REQUIRE(before > s.least * 1.0005);
        const auto places = s.x.download();

        REQUIRE(s.f.eliminate(s.x, g, always));

        CHECK(s.f.value(s.x) - s.least < 0.05 * (before - s.least));
        const auto now = s.x.download();
        const auto& l = s.f.layout();
        std::size_t moved = 0;
        for (std::size_t v = 0; v < at(l.vertex_count); ++v) moved += now[v] != places[v];
        CHECK(moved >= s.spot.size());
        CHECK(moved <= at(l.vertex_count) / 4);
        auto zero = s.f.space().make();
        CHECK(s.f.max_step(s.x, zero) > 1); // no flip
    }
}

TEST_CASE("nonlinear elimination: patches have the data of their cells")
{
    const auto surface = test::bumpy(40, 0.3, 5);
    disturbed s({}, any_energy(fibres{}).with_data({1.0}, true), warp(surface));
    REQUIRE(s.spot.size() > 5);
    auto g = s.f.space().make();
    const double before = s.f.value_gradient(s.x, g);
    const std::size_t stride = s.f.layout().vertex_stride;
    const double steep = length_at(g.download(), s.spot, stride);
    REQUIRE(s.f.eliminate(s.x, g, always));
    CHECK(s.f.value_gradient(s.x, g) - s.least < 0.05 * (before - s.least));
    CHECK(length_at(g.download(), s.spot, stride) < 0.1 * steep);
}

TEST_CASE("nonlinear elimination: pinned and otherwise bound vertices stay bit for bit")
{
    std::vector<bool> pinned(test::bumpy(40, 0.3, 5).points().size(), false);
    for (std::size_t v = 0; v < pinned.size(); v += 9) pinned[v] = true;
    disturbed s({}, energy::isometric{}, {}, pinned);
    // One of the spot has a spring.
    const taut::idx bound = *s.spot.begin();
    s.f.constrain({.held = {}, .springs = {{bound, vec2(0), vec2(1)}}});
    auto g = s.f.space().make();
    s.f.value_gradient(s.x, g);
    const auto places = s.x.download();
    REQUIRE(s.f.eliminate(s.x, g, always));
    const auto now = s.x.download();
    const auto& l = s.f.layout();
    for (taut::idx v = l.free_count; v < l.vertex_count; ++v) CHECK(now[at(v)] == places[at(v)]);
    CHECK(now[at(bound)] == places[at(bound)]);
    CHECK(now[l.vertex_stride + at(bound)] == places[l.vertex_stride + at(bound)]);
    CHECK(now != places);
}

TEST_CASE("nonlinear elimination: whoever may not go on changes nothing")
{
    disturbed s;
    auto g = s.f.space().make();
    s.f.value_gradient(s.x, g);
    const auto places = s.x.download();
    CHECK_FALSE(s.f.eliminate(s.x, g, [] { return false; }));
    CHECK(s.x.download() == places);
}

TEST_CASE("patches: are disjoint, hang together, and are no more than they may be")
{
    const auto surface = test::grid(60, 60);
    const layout<triangle> l(surface);
    std::vector<char> barred(at(l.vertex_count), 0);
    std::vector<double> weights(at(l.free_count), 0.0);
    for (const std::size_t v : {std::size_t(100), std::size_t(1800), std::size_t(3500)}) weights[v] = 1;
    barred[101] = 1;

    const impl::patch_params few{.rings = 3};
    const auto patches = impl::patch_finder<triangle>(l, weights, barred, few).patches();
    REQUIRE(!patches.empty());
    REQUIRE(patches.size() <= 3);
    std::set<taut::idx> moving, cells;
    for (const auto& p : patches)
    {
        REQUIRE(p.cells.size() == p.cell_ids.size());
        for (std::size_t v = 0; v < p.vertices.size(); ++v)
            if (!p.fixed[v]) CHECK(moving.insert(p.vertices[v]).second);
        for (std::size_t c = 0; c < p.cells.size(); ++c)
        {
            CHECK(cells.insert(p.cell_ids[c]).second);
            for (std::size_t k = 0; k < 3; ++k)
                CHECK(p.vertices[at(p.cells[c][k])] == l.corners[k * l.cell_stride + at(p.cell_ids[c])]);
        }
    }
    CHECK(moving.count(100) == 1);
    CHECK(moving.count(101) == 0);
    // All cells of what moves are there.
    for (const taut::idx v : moving)
        for (const taut::idx c : l.vertex_corners.row(v)) CHECK(cells.count(c / 3) == 1);

    const auto size = [&](const impl::patch_params& p)
    {
        std::size_t n = 0;
        for (const auto& one : impl::patch_finder<triangle>(l, weights, barred, p).patches())
            n += at(static_cast<taut::idx>(std::count(one.fixed.begin(), one.fixed.end(), 0)));
        return n;
    };
    CHECK(size(few) == moving.size());
    CHECK(size({.rings = 3, .most_vertices = 50}) <= 50);
    CHECK(size({.rings = 3, .most_vertices = 50}) > 0);
    CHECK(size({.rings = 8, .most_vertices = 20}) == 0);
    CHECK(impl::patch_finder<triangle>(l, std::vector<double>(weights.size(), 0.0), barred).patches().empty());
}
