// SPDX-License-Identifier: MIT
// Cells of other kinds, by the simplices at their corners, over many processes: as one process has them.
#include <doctest/doctest.h>

#include <cstddef>
#include <cstdint>
#include <vector>

#include <dist/pieces.hpp>
#include <taut/deform.hpp>
#include <taut/impl/dist/processes/communicator.hpp>
#include <taut/impl/dist/ranges/deal.hpp>
#include <taut/impl/dist/shape/shape_body.hpp>
#include <taut/impl/files/volume/volume_file.hpp>
#include <taut/queue.hpp>
#include <taut/smooth.hpp>
#include <taut/volume_file.hpp>

namespace taut::test
{

namespace
{

/// A bar of n x n x 4 n hexahedra, every other layer of wedges; jittered inside: 1 x 1 x 4.
io::volume_file cells_of_bar(int n)
{
    const auto of_tetrahedra = bar(n); // for its points
    io::volume_file file;
    file.points = of_tetrahedra.points();
    const auto at = [=](int i, int j, int k) { return static_cast<idx>((k * (n + 1) + j) * (n + 1) + i); };
    for (int k = 0; k < 4 * n; ++k)
    {
        const auto kind = k % 2 == 0 ? io::cell_kind::hexahedron : io::cell_kind::wedge;
        auto& corners = file.cells.emplace_back(io::cell_block{kind, {}}).corners;
        for (int j = 0; j < n; ++j)
            for (int i = 0; i < n; ++i)
            {
                const idx a = at(i, j, k), b = at(i + 1, j, k), c = at(i + 1, j + 1, k), d = at(i, j + 1, k);
                const idx up = at(0, 0, 1);
                if (kind == io::cell_kind::hexahedron)
                    corners.insert(corners.end(), {a, b, c, d, a + up, b + up, c + up, d + up});
                else
                    corners.insert(corners.end(), {a, c, b, a + up, c + up, b + up, a, d, c, a + up, d + up, c + up});
            }
    }
    return file;
}

} // namespace

TEST_CASE("dist cells: hexahedra and wedges find the energy of one process, to ten digits")
{
    const dist::impl::communicator all(MPI_COMM_WORLD);
    const auto parts = cells_of_bar(2).corner_simplices<tetrahedron>();
    const bool first = rank_of() == 0;
    const auto part = dist::impl::dealt<tetrahedron>(all, first ? &parts.simplices : nullptr, first ? &parts : nullptr);
    const auto& m = parts.simplices;
    queue& q = common_queue();
    deform_params<tetrahedron> serial{.constraints = serial_ends(m, twisted(1.0)), .precision = precision::fp64};
    serial.owners = parts.cells;
    serial.data.weights = parts.weights;
    serial.solve.gradient_tolerance = 1e-8;
    const auto one = deform(q, m, serial);
    REQUIRE(one.report.converged);
    dist::deform_params<tetrahedron> how{.constraints = ends(MPI_COMM_WORLD, m, twisted(1.0)), .queue = common_queue()};
    how.solve.gradient_tolerance = 1e-8;
    const auto found = dist::deform(MPI_COMM_WORLD, part, how);
    CHECK(found.report.converged);
    CHECK(found.report.pins_held);
    CHECK(found.report.energy == doctest::Approx(one.report.energy).epsilon(1e-10));
    CHECK(dist::check(MPI_COMM_WORLD, part).elements == m.cell_count());
    // Smoothing has the shapes of regular cells as targets, and counts corners alike.
    smooth_params<tetrahedron> by_one{.targets = parts.regular, .owners = parts.cells, .precision = precision::fp64};
    by_one.solve.gradient_tolerance = 1e-8;
    const auto smoothed = smooth(q, m, by_one);
    dist::smooth_params by_all{.queue = common_queue()};
    by_all.solve.gradient_tolerance = 1e-8;
    const auto better = dist::smooth(MPI_COMM_WORLD, part, by_all);
    CHECK(better.report.converged);
    CHECK(better.report.energy == doctest::Approx(smoothed.report.energy).epsilon(1e-10));
}

TEST_CASE("dist cells: energies have the same bits on any number of processes")
{
    const auto parts = cells_of_bar(2).corner_simplices<tetrahedron>();
    std::vector<double> energies;
    for (int size = 1; size <= size_of(); ++size)
    {
        const first_processes some(size);
        double energy = 0;
        if (some)
        {
            const dist::impl::communicator all(some.get());
            const bool first = rank_of(some.get()) == 0;
            const auto part =
                dist::impl::dealt<tetrahedron>(all, first ? &parts.simplices : nullptr, first ? &parts : nullptr);
            dist::deform_params<tetrahedron> how{.constraints = ends(some.get(), parts.simplices, twisted(0.3)),
                                                 .queue = common_queue()};
            how.solve.max_iterations = 0;
            dist::session<tetrahedron> s(some.get(), part, how);
            auto x = s.body().current();
            for (std::size_t i = 0; i < x.size(); i += 3) x[i] *= 1.25; // strained
            energy = s.body().objective().value(x);
        }
        energies.push_back(energy);
    }
    if (rank_of() == 0)
        for (const double e : energies) CHECK(e == energies[0]);
}

TEST_CASE("dist cells: what is said of cells is of all of them")
{
    const dist::impl::communicator all(MPI_COMM_WORLD);
    const auto parts = cells_of_bar(1).corner_simplices<tetrahedron>();
    const bool first = rank_of() == 0;
    auto part = dist::impl::dealt<tetrahedron>(all, first ? &parts.simplices : nullptr, first ? &parts : nullptr);
    if (rank_of() == size_of() - 1) part.weights.push_back(1);
    CHECK_THROWS_AS(dist::check(MPI_COMM_WORLD, part), error);
}

} // namespace taut::test
