// SPDX-License-Identifier: MIT
#include <cmath>

#include <doctest/doctest.h>

#include <support/meshes.hpp>
#include <support/shared_context.hpp>
#include <support/size.hpp>

#include <taut/energies.hpp>
#include <taut/impl/core/objective/mesh_levels.hpp>
#include <taut/impl/core/objective/volume_objective.hpp>
#include <taut/rigid_motion.hpp>
#include <taut/solve.hpp>

namespace
{

using namespace taut;
using namespace taut::impl;

/// A cube of which the boundary slides in itself: as coordinates that are held, or, turned, as slides.
struct sliding_cube
{
    mesh<tetrahedron> flat = test::jittered_cube(test::sized(6, 4), 7);
    rigid_motion<3> turn{.from = vec3(0), .to = vec3(1, 2, 3), .axis = glm::normalize(vec3(1, 2, -1)), .angle = 0.8};
    fixed_marks<3> held{flat.points().size()};
    std::vector<vec3> turned;
    point_constraints<3> slides{fixed_marks<3>(flat.points().size()), {}, {}};

    sliding_cube()
    {
        const vec3 axes[3] = {turn.turned({1, 0, 0}, turn.angle), turn.turned({0, 1, 0}, turn.angle),
                              turn.turned({0, 0, 1}, turn.angle)};
        for (std::size_t v = 0; v < held.size(); ++v)
        {
            const vec3& p = flat.points()[v];
            turned.push_back(turn(p));
            int on = 0, across = 0, along = 0;
            for (int k = 0; k < 3; ++k)
            {
                const bool side = p[k] == 0 || p[k] == 1;
                if (side) held[v] = static_cast<std::uint8_t>(held[v] | 1u << k);
                on += side;
                (side ? across : along) = k;
            }
            const auto id = static_cast<taut::idx>(v);
            if (on == 3) slides.held[v] = slides.held.every;
            if (on == 2) slides.slides.push_back(slide<3>::along(id, 2.0 * axes[along]));
            if (on == 1) slides.slides.push_back(slide<3>::across(id, -3.0 * axes[across]));
        }
    }

    /// Minimises the shape energy; regular elements have none.
    std::pair<std::vector<vec3>, solve::report> solved(const std::vector<vec3>& points,
                                                       const point_constraints<3>& constraints) const
    {
        queue q(test::shared_context());
        const mesh<tetrahedron> m(points, flat.cells());
        const mesh_levels<tetrahedron> levels(m);
        const auto ideal = regular_elements<tetrahedron>(flat.cells().size(), 1.0);
        const auto local = levels.make_layout(ideal);
        newton_objective<tetrahedron> f(
            q, {local, levels.cells(0), levels.transfers(0), levels.fixed(0), lane_form::for_device(q.device())},
            energy::shape{}, energy::weighting::uniform,
            std::make_shared<const newton_kernels<tetrahedron>>(q, energy::shape{}, real_types{}));
        const auto& numbers = levels.order().vertices;
        f.constrain(constraints.renumbered(numbers));
        auto x = f.make_point();
        f.upload(numbers.apply(points), x);
        solve::params how;
        how.gradient_tolerance = 1e-9;
        how.method = solve::method::newton;
        const auto report = solve::minimize(f, x, how);
        return {numbers.undo(f.download(x)), report};
    }
};

} // namespace

TEST_CASE("sliding: a turned cube whose boundary slides comes to the turned minimum of the cube with held coordinates")
{
    const sliding_cube s;
    const auto [straight, one] = s.solved(s.flat.points(), {s.held, {}, {}});
    const auto [turned, other] = s.solved(s.turned, s.slides);
    CHECK(one.gradient_norm < 1e-9);
    CHECK(other.gradient_norm < 1e-9);
    CHECK(one.value < one.value_start);
    CHECK(other.value == doctest::Approx(one.value).epsilon(1e-9));
    CHECK(other.iterations <= one.iterations + 2);
    double apart = 0, off = 0;
    for (std::size_t v = 0; v < turned.size(); ++v)
        apart = std::max(apart, glm::distance(turned[v], s.turn(straight[v])));
    CHECK(apart < 1e-6);
    for (const auto& slide : s.slides.slides)
    {
        const auto v = static_cast<std::size_t>(slide.vertex);
        const vec3 moved = turned[v] - s.turned[v];
        off = std::max(off, glm::distance(slide.projection * moved, moved));
    }
    CHECK(off < 1e-13);
}
