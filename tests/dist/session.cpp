// SPDX-License-Identifier: MIT
#include <doctest/doctest.h>

#include <numbers>

#include <dist/pieces.hpp>
#include <taut/errors.hpp>
#include <taut/impl/dist/shape/shape_body.hpp>

namespace taut::test
{

TEST_CASE("dist session: steps in time, with the tables of the first call")
{
    const auto m = bar(3);
    const auto p = dealt(MPI_COMM_WORLD, m);
    dist::session<tetrahedron> s(MPI_COMM_WORLD, p,
                                 {.constraints = ends(MPI_COMM_WORLD, m, twisted(0.2)), .queue = common_queue()});
    const auto first = s.solve();
    CHECK(first.report.converged);
    const double planned = first.report.seconds.plan;
    for (int k = 2; k <= 3; ++k)
    {
        s.constrain(ends(MPI_COMM_WORLD, m, twisted(0.2 * k)));
        const auto next = s.solve();
        CHECK(next.report.converged);
        CHECK(next.report.seconds.plan == planned); // the same coordinates are fixed
        CHECK(next.report.energy > first.report.energy);
    }
    const auto at_once = dist::deform<tetrahedron>(
        MPI_COMM_WORLD, p, {.constraints = ends(MPI_COMM_WORLD, m, twisted(0.6)), .queue = common_queue()});
    CHECK(s.solve().report.energy == doctest::Approx(at_once.report.energy).epsilon(1e-8));

    // Released, it goes back to rest.
    s.constrain({});
    const auto free = s.solve();
    CHECK(free.report.seconds.plan > planned);
    CHECK(free.report.energy == doctest::Approx(2).epsilon(1e-6));
}

TEST_CASE("dist session: constraints that are refused change nothing")
{
    const auto m = bar(2);
    dist::session<tetrahedron> s(MPI_COMM_WORLD, dealt(MPI_COMM_WORLD, m),
                                 {.constraints = ends(MPI_COMM_WORLD, m, stretched)});
    dist::constraints<tetrahedron> bad;
    if (rank_of() == 0) bad.pin(m.vertex_count(), vec3(0));
    CHECK_THROWS_AS(s.constrain(bad), error);
    const auto r = s.solve();
    CHECK(r.report.converged);
    CHECK(r.report.energy > 2.1);
}

TEST_CASE("dist session: two at a time, of different processes")
{
    const auto m = bar(2);
    dist::session<tetrahedron> all(MPI_COMM_WORLD, dealt(MPI_COMM_WORLD, m),
                                   {.constraints = ends(MPI_COMM_WORLD, m, stretched)});
    const first_processes one(1);
    double alone = 0;
    if (one)
        alone =
            dist::deform<tetrahedron>(one.get(), dealt(one.get(), m), {.constraints = ends(one.get(), m, stretched)})
                .report.energy;
    MPI_Bcast(&alone, 1, MPI_DOUBLE, 0, MPI_COMM_WORLD);
    CHECK(all.solve().report.energy == doctest::Approx(alone).epsilon(1e-9));
}

} // namespace taut::test
