// SPDX-License-Identifier: MIT
#include <cmath>

#include <doctest/doctest.h>

#include <support/meshes.hpp>
#include <support/shared_context.hpp>
#include <support/size.hpp>

#include <taut/energies.hpp>
#include <taut/impl/core/objective/mesh_levels.hpp>
#include <taut/impl/core/objective/newton_objective.hpp>
#include <taut/impl/core/start/barycentric_map.hpp>
#include <taut/solve.hpp>

namespace
{

using namespace taut;
using namespace taut::impl;

/// A bumpy disk and a start map in the order of level 0, with some vertices held in one coordinate or both.
struct held_setting
{
    mesh<triangle> surface = test::bumpy(test::sized(14, 4), 0.25, 2);
    fixed_marks<2> held{surface.points().size()}; ///< in the user's numbers
    queue q{test::shared_context()};

    held_setting()
    {
        const auto n = held.size();
        held[n / 2] = held[n / 5] = 3;
        held[n / 3] = 1;
        held[n / 4] = 2;
    }

    newton_objective<triangle> objective(const mesh_levels<triangle>& levels) const
    {
        return {q,
                {levels, 0, lane_form::for_device(q.device())},
                energy::isometric{},
                energy::weighting::measure,
                std::make_shared<const newton_kernels<triangle>>(q, energy::isometric{}, real_types{})};
    }

    point_constraints<2> on(const mesh_levels<triangle>& levels) const
    {
        return point_constraints<2>{held, {}}.renumbered(levels.order().vertices);
    }

    static std::vector<vec2> start_of(const mesh_levels<triangle>& levels)
    {
        const auto finest = levels.level(0);
        return barycentric_map(finest, facets(finest), {.stretch_rounds = 3}).uv;
    }
};

TEST_CASE("held: a step towards given places has them for its held part, and for the others the model's gradient there")
{
    const held_setting s;
    const mesh_levels<triangle> levels(s.surface);
    auto f = s.objective(levels), plain = s.objective(levels);
    const auto start = s.start_of(levels);
    auto x = f.make_point();
    f.upload(start, x);
    const auto wanted = s.on(levels);
    f.constrain(wanted);
    auto places = start;
    for (vec2& p : places) p += vec2(0.01, -0.02);
    f.aim([&places](std::size_t v) { return places[v]; });

    auto d = f.space().make(), g = f.space().make(), g0 = f.space().make(), Hd = f.space().make();
    const auto change = f.linearize_towards(x, 0.5, d, g);
    plain.linearize(x, false);
    plain.hessian_product(d, Hd);
    CHECK(change.value == doctest::Approx(plain.value_gradient(x, g0)).epsilon(1e-13));
    CHECK(change.change == doctest::Approx(plain.space().dot(g0, d) + plain.space().dot(d, Hd) / 2).epsilon(1e-10));

    const auto to = d.download(), got = g.download(), before = g0.download(), product = Hd.download();
    const auto& l = f.layout();
    double worst = 0, most = 0;
    for (std::size_t v = 0; v < start.size(); ++v)
        for (int k = 0; k < 2; ++k)
        {
            const std::size_t at = static_cast<std::size_t>(k) * l.vertex_stride + v;
            const double full = (k == 0 ? 0.01 : -0.02) * l.scale;
            if (wanted.held.test(v, k))
            {
                CHECK(to[at] == doctest::Approx(full / 2).epsilon(1e-10));
                CHECK(got[at] == 0);
                continue;
            }
            CHECK(to[at] == 0);
            worst = std::max(worst, std::abs(got[at] - before[at] - product[at]));
            most = std::max(most, std::abs(product[at]));
        }
    CHECK(most > 0);
    CHECK(worst < 1e-10 * most);

    f.put(x);
    const auto end = f.download(x);
    for (std::size_t v = 0; v < start.size(); ++v)
        for (int k = 0; k < 2; ++k) CHECK(end[v][k] == (wanted.held.test(v, k) ? places : start)[v][k]);
}

TEST_CASE("held: products and the V-cycle are symmetric, see nothing of what is held, and leave it")
{
    const held_setting s;
    const mesh_levels<triangle> levels(s.surface);
    auto f = s.objective(levels);
    auto x = f.make_point();
    f.upload(s.start_of(levels), x);
    const auto wanted = s.on(levels);
    f.constrain(wanted);
    auto a = f.space().make(), b = f.space().make(), Ma = f.space().make(), Mb = f.space().make();
    f.value_gradient(x, a);
    f.linearize(x, false);
    f.precondition(a, b); // zero where held, as vectors are
    const auto check = [&](auto&& apply)
    {
        apply(a, Ma);
        apply(b, Mb);
        CHECK(f.space().dot(a, Mb) == doctest::Approx(f.space().dot(Ma, b)).epsilon(1e-9));
        CHECK(f.space().dot(a, Ma) > 0);
        const auto values = Ma.download();
        for (std::size_t v = 0; v < wanted.held.size(); ++v)
            for (int k = 0; k < 2; ++k)
                if (wanted.held.test(v, k))
                    CHECK(values[static_cast<std::size_t>(k) * f.layout().vertex_stride + v] == 0);
    };
    check([&](const auto& v, auto& out) { f.hessian_product(v, out); });
    check([&](const auto& v, auto& out) { f.precondition(v, out); });
}

TEST_CASE("held: Newton's method ends where it does with the same vertices pinned in the layout, as fast")
{
    held_setting s;
    for (auto& bits : {s.held.size() / 3, s.held.size() / 4}) s.held[bits] = 3; // the layout knows whole vertices only
    const mesh_levels<triangle> free(s.surface), pinned(s.surface, s.held.pinned());
    const auto start = free.order().vertices.undo(s.start_of(free));
    const auto minimised = [&](const mesh_levels<triangle>& levels, bool masked)
    {
        auto f = s.objective(levels);
        if (masked) f.constrain(s.on(levels));
        auto x = f.make_point();
        f.upload(levels.order().vertices.apply(start), x);
        solve::params how;
        how.gradient_tolerance = 1e-9;
        auto report = solve::minimize(f, x, how);
        CHECK(report.stop == solve::stop::gradient);
        return std::pair(std::move(report), levels.order().vertices.undo(f.download(x)));
    };
    const auto [as_mask, by_mask] = minimised(free, true);
    const auto [as_layout, by_layout] = minimised(pinned, false);
    CHECK(as_mask.value == doctest::Approx(as_layout.value).epsilon(1e-10));
    CHECK(as_mask.products < 2 * as_layout.products);
    for (std::size_t v = 0; v < start.size(); ++v)
    {
        if (s.held.all(v)) CHECK(by_mask[v] == start[v]);
        CHECK(glm::distance(by_mask[v], by_layout[v]) < 1e-4);
    }
}

} // namespace
