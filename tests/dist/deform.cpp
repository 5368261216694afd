// SPDX-License-Identifier: MIT
#include <doctest/doctest.h>

#include <numbers>

#include <dist/pieces.hpp>
#include <taut/deform.hpp>

namespace taut::test
{

TEST_CASE("dist deform: a stretched bar has the energy and the steps of one process")
{
    const auto m = bar(4);
    const auto p = dealt(MPI_COMM_WORLD, m);
    const auto [x, report] = dist::deform<tetrahedron>(
        MPI_COMM_WORLD, p, {.constraints = ends(MPI_COMM_WORLD, m, stretched)});
    CHECK(report.outcome == outcome::valid);
    CHECK(report.converged);
    CHECK(report.pins_held);
    CHECK(report.flips.elements == m.cell_count());
    CHECK(report.fallbacks == 0);

    queue q;
    const auto serial = deform(q, m, deform_params<tetrahedron>{.constraints = serial_ends(m, stretched),
                                                                .precision = precision::fp64});
    MESSAGE("energies ", report.energy, ' ', serial.report.energy, " steps ", report.steps, ' ', serial.report.steps,
            " products ", report.products);
    CHECK(report.energy == doctest::Approx(serial.report.energy).epsilon(1e-10));
    CHECK(std::abs(report.steps - serial.report.steps) <= 1);
}

} // namespace taut::test
