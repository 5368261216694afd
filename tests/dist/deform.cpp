// SPDX-License-Identifier: MIT
#include <doctest/doctest.h>

#include <chrono>
#include <cmath>
#include <numbers>
#include <random>
#include <span>

#include <dist/pieces.hpp>
#include <support/mips_power.hpp>
#include <taut/certify.hpp>
#include <taut/deform.hpp>
#include <taut/energy.hpp>

namespace taut::test
{

namespace
{

constexpr double pi = std::numbers::pi;

template <class Where>
session_result<tetrahedron> serial(const mesh<tetrahedron>& m, const Where& where,
                                   const any_energy& e = energy::isometric{})
{
    queue& q = common_queue();
    return deform(
        q, m,
        deform_params<tetrahedron>{.energy = e, .constraints = serial_ends(m, where), .precision = precision::fp64});
}

template <class Where>
dist::result<tetrahedron> over_all(const mesh<tetrahedron>& m, const Where& where,
                                   dist::deform_params<tetrahedron> how = {}, const run_limits& limits = {})
{
    how.constraints = ends(MPI_COMM_WORLD, m, where);
    how.queue = common_queue();
    return dist::deform(MPI_COMM_WORLD, dealt(MPI_COMM_WORLD, m), how, limits);
}

/// Whether all pins of a piece are where they should be, bit for bit.
template <class Where>
bool at_their_places(const mesh<tetrahedron>& m, const std::vector<vec3>& x, const Where& where)
{
    const auto p = dealt(MPI_COMM_WORLD, m);
    bool all = p.ids.size() == x.size();
    for (std::size_t v = 0; v < x.size(); ++v)
        if (p.points[v].z == 0 || p.points[v].z == 4)
            all = all && x[v] == (p.points[v].z == 0 ? p.points[v] : where(p.points[v]));
    return all;
}

} // namespace

TEST_CASE("dist deform: a stretched bar has the energy and the steps of one process")
{
    const auto m = bar(4);
    const auto [x, report] = over_all(m, stretched);
    CHECK(report.outcome == outcome::valid);
    CHECK(report.converged);
    CHECK(report.pins_held);
    CHECK(report.flips.elements == m.cell_count());
    CHECK(report.flips.min_det > 0);
    CHECK(report.fallbacks == 0);
    CHECK(at_their_places(m, x, stretched));
    const auto one = serial(m, stretched);
    CHECK(report.energy == doctest::Approx(one.report.energy).epsilon(1e-10));
    CHECK(std::abs(report.steps - one.report.steps) <= 1);
    // Shapes agree to fewer digits than energies.
    const auto p = dealt(MPI_COMM_WORLD, m);
    for (std::size_t v = 0; v < x.size(); ++v)
        CHECK(glm::distance(x[v], one.x[static_cast<std::size_t>(p.ids[v])]) < 1e-4);
}

TEST_CASE("dist deform: a quarter turn begins with a guess and takes few steps")
{
    const auto m = bar(4);
    const auto where = twisted(pi / 2);
    const auto [x, report] = over_all(m, where);
    CHECK(report.converged);
    CHECK(report.steps <= 5);
    CHECK(report.seconds.start > 0);
    CHECK(at_their_places(m, x, where));
    CHECK(report.energy == doctest::Approx(serial(m, where).report.energy).epsilon(1e-9));
}

TEST_CASE("dist deform: half a turn goes round one way or the other")
{
    const auto m = bar(3);
    const auto [x, report] = over_all(m, twisted(pi));
    CHECK(report.converged);
    CHECK(at_their_places(m, x, twisted(pi)));
}

TEST_CASE("dist deform: where there is no guess, bodies turn in parts")
{
    const auto m = bar(3);
    const auto where = twisted(pi / 2);
    auto c = ends(MPI_COMM_WORLD, m, where);
    // A coordinate alone is fixed, which the guess does not know.
    if (rank_of() == 0)
        for (std::size_t v = 0; v < m.points().size(); ++v)
            if (glm::distance(m.points()[v], vec3(0.5, 0.5, 2)) < 0.3)
            {
                c.pin(static_cast<std::int64_t>(v), 2, m.points()[v].z);
                break;
            }
    const auto [x, report] = dist::deform<tetrahedron>(MPI_COMM_WORLD, dealt(MPI_COMM_WORLD, m),
                                                       {.constraints = c, .queue = common_queue()});
    CHECK(report.converged);
    CHECK(report.steps > 5);
    CHECK(at_their_places(m, x, where));
}

TEST_CASE("dist deform: an energy of one's own, and sums of energies")
{
    const auto m = bar(3);
    using namespace energy;
    const any_energy own = 0.5 * isometric{} + 0.5 * mips_power{};
    const auto [x, report] = over_all(m, stretched, {.energy = own});
    CHECK(report.converged);
    CHECK(report.energy == doctest::Approx(serial(m, stretched, own).report.energy).epsilon(1e-9));
}

TEST_CASE("dist deform: preconditioners lead to the same minimum")
{
    const auto m = bar(3);
    const double energy = over_all(m, stretched).report.energy;
    for (const auto p : {dist::preconditioner::gamg, dist::preconditioner::block_jacobi})
    {
        const auto r = over_all(m, stretched, {.solver = {.preconditioner = p}});
        CHECK(r.report.converged);
        CHECK(r.report.energy == doctest::Approx(energy).epsilon(1e-8));
    }
    const auto r = over_all(m, stretched, {.solver = {.options = "-pc_type gamg -pc_gamg_threshold 0.01"}});
    CHECK(r.report.converged);
}

TEST_CASE("dist deform: parts by PTScotch lead to the same minimum, with no more between them")
{
    const auto m = bar(4);
    const auto where = twisted(pi / 2);
    const auto halo = [](const dist::report& r)
    {
        std::int64_t sum = 0;
        MPI_Allreduce(&r.halo_vertices, &sum, 1, MPI_INT64_T, MPI_SUM, MPI_COMM_WORLD);
        return sum;
    };
    const auto along = over_all(m, where),
               cut = over_all(m, where, {.solver = {.partition = dist::partition::ptscotch}});
    CHECK(cut.report.converged);
    CHECK(cut.report.flips.elements == m.cell_count());
    CHECK(at_their_places(m, cut.x, where));
    CHECK(cut.report.energy == doctest::Approx(along.report.energy).epsilon(1e-10));
    CHECK(halo(cut.report) <= halo(along.report));
}

TEST_CASE("dist deform: a preconditioner that fails is replaced by a safer one")
{
    const auto m = bar(2);
    // Richardson's iteration with a negative factor is no positive preconditioner.
    const auto r = over_all(m, stretched,
                            {.solver = {.options = "-pc_type ksp -ksp_ksp_type richardson -ksp_ksp_richardson_scale "
                                                   "-1 -ksp_ksp_max_it 1 -ksp_pc_type jacobi"}});
    CHECK(r.report.fallbacks == 1);
    CHECK(r.report.converged);
}

TEST_CASE("dist deform: springs pull, and single coordinates are fixed")
{
    const auto m = bar(3);
    dist::constraints<tetrahedron> c;
    taut::constraints<tetrahedron> one(m);
    for (idx v = 0; v < m.vertex_count(); ++v)
    {
        const vec3 p = m.points()[static_cast<std::size_t>(v)];
        if (p.z == 0) one.pin(v, p);
        if (p.z == 4) one.spring(v, p + vec3(0.5, 0, 0.5), 0.1);
        if (p.z == 2) one.pin(v, 1, p.y);
        if (rank_of() != size_of() - 1) continue; // whoever gives them
        if (p.z == 0) c.pin(v, p);
        if (p.z == 4) c.spring(v, p + vec3(0.5, 0, 0.5), 0.1);
        if (p.z == 2) c.pin(v, 1, p.y);
    }
    const auto [x, report] = dist::deform<tetrahedron>(MPI_COMM_WORLD, dealt(MPI_COMM_WORLD, m),
                                                       {.constraints = c, .queue = common_queue()});
    CHECK(report.converged);
    queue& q = common_queue();
    const auto alone = deform(q, m, deform_params<tetrahedron>{.constraints = one, .precision = precision::fp64});
    CHECK(report.energy == doctest::Approx(alone.report.energy).epsilon(1e-8));
    const auto p = dealt(MPI_COMM_WORLD, m);
    for (std::size_t v = 0; v < x.size(); ++v)
        if (p.points[v].z == 2) CHECK(x[v].y == p.points[v].y);
}

TEST_CASE("dist deform: single precision is enough where it is asked for")
{
    const auto m = bar(3);
    const auto r = over_all(m, stretched, {.precision = precision::mixed});
    CHECK(r.report.outcome == outcome::valid);
    CHECK(r.report.energy == doctest::Approx(over_all(m, stretched).report.energy).epsilon(1e-5));
}

TEST_CASE("dist deform: more processes than work")
{
    const auto m = single_tetrahedron();
    dist::constraints<tetrahedron> c;
    if (rank_of() == 0)
        for (int v = 0; v < 3; ++v) c.pin(v, m.points()[static_cast<std::size_t>(v)]);
    if (rank_of() == 0) c.pin(3, 0, 0.5);
    const auto [x, report] = dist::deform<tetrahedron>(MPI_COMM_WORLD, dealt(MPI_COMM_WORLD, m),
                                                       {.constraints = c, .queue = common_queue()});
    CHECK(report.outcome == outcome::valid);
    CHECK(report.pins_held);
    CHECK(report.unknowns == 1);
}

TEST_CASE("dist deform: everything pinned, and nothing")
{
    const auto m = cube(2);
    dist::constraints<tetrahedron> all;
    for (std::size_t v = 0; v < m.points().size(); ++v) all.pin(static_cast<std::int64_t>(v), 1.5 * m.points()[v]);
    // Every process gives the same pins.
    const auto pinned = dist::deform<tetrahedron>(MPI_COMM_WORLD, dealt(MPI_COMM_WORLD, m),
                                                  {.constraints = all, .queue = common_queue()});
    CHECK(pinned.report.outcome == outcome::valid);
    CHECK(pinned.report.pins_held);
    CHECK(pinned.report.unknowns == 0);
    const auto free = dist::deform<tetrahedron>(MPI_COMM_WORLD, dealt(MPI_COMM_WORLD, m), {});
    CHECK(free.report.converged);
    CHECK(free.report.energy == doctest::Approx(2));
}

TEST_CASE("dist deform: vertices without cells stay where they are")
{
    const auto m = bar(2);
    auto p = dealt(MPI_COMM_WORLD, m);
    p.ids.push_back(m.vertex_count() + rank_of());
    p.points.emplace_back(9, 9, rank_of());
    const auto [x, report] =
        dist::deform<tetrahedron>(MPI_COMM_WORLD, p, {.constraints = ends(MPI_COMM_WORLD, m, stretched)});
    CHECK(report.converged);
    CHECK(x.back() == p.points.back());
}

TEST_CASE("dist deform: meshes of any size and place")
{
    const auto m = bar(2);
    const double energy = over_all(m, stretched).report.energy;
    for (const double scale : {1e-60, 1e60})
    {
        auto points = m.points();
        for (vec3& p : points) p = scale * (p + vec3(3, 0, 0));
        const mesh<tetrahedron> other(points, m.cells());
        dist::constraints<tetrahedron> c;
        if (rank_of() == 0)
            for (std::size_t v = 0; v < points.size(); ++v)
            {
                if (m.points()[v].z == 0) c.pin(static_cast<std::int64_t>(v), points[v]);
                if (m.points()[v].z == 4) c.pin(static_cast<std::int64_t>(v), points[v] + scale * vec3(0, 0, 2));
            }
        const auto r = dist::deform<tetrahedron>(MPI_COMM_WORLD, dealt(MPI_COMM_WORLD, other),
                                                 {.constraints = c, .queue = common_queue()});
        CHECK(r.report.converged);
        CHECK(r.report.energy == doctest::Approx(energy).epsilon(1e-8));
    }
}

TEST_CASE("dist deform: a limit of one process ends the run of all, with a certified shape")
{
    using namespace std::chrono_literals;
    const auto m = bar(3);
    run_limits limits;
    if (rank_of() == size_of() - 1) limits.time_limit = 0s;
    const auto none = over_all(m, stretched, {}, limits);
    CHECK(none.report.outcome == outcome::stopped);
    CHECK(none.report.stopped);
    CHECK(none.report.flips);
    CHECK(!none.x.empty());

    limits = {};
    if (rank_of() == size_of() - 1) limits.observer = [](const progress& p) { return p.iteration < 2; };
    const auto some = over_all(m, stretched, {}, limits);
    CHECK(some.report.stopped);
    CHECK(some.report.flips);
    CHECK(some.report.steps <= 3);
}

TEST_CASE("dist deform: an initial shape; one with inverted elements is refused")
{
    const auto m = bar(2);
    dist::deform_params<tetrahedron> how;
    const auto p = dealt(MPI_COMM_WORLD, m);
    for (const vec3& x : p.points) how.initial.push_back(stretched(x));
    const auto good = over_all(m, stretched, how);
    CHECK(good.report.converged);
    CHECK(good.report.energy == doctest::Approx(over_all(m, stretched).report.energy).epsilon(1e-8));

    for (vec3& x : how.initial) x.z = -x.z;
    const auto bad = over_all(m, stretched, how);
    CHECK(bad.report.outcome == outcome::gave_up);
    CHECK(bad.report.flips.flipped == m.cell_count());
    CHECK(bad.report.reason.find("untangle") != std::string::npos);
    CHECK(bad.x.empty());
}

TEST_CASE("dist deform: elements with all vertices pinned and inverted are a proof")
{
    const auto m = bar(2);
    dist::constraints<tetrahedron> c;
    if (rank_of() == 0)
        for (const idx v : m.cells().back())
            c.pin(v, m.points()[static_cast<std::size_t>(v)] * vec3(-1, 1, 1)); // mirrored
    const auto [x, report] = dist::deform<tetrahedron>(MPI_COMM_WORLD, dealt(MPI_COMM_WORLD, m),
                                                       {.constraints = c, .queue = common_queue()});
    CHECK(report.outcome == outcome::infeasible);
    CHECK(report.ids == std::vector<std::int64_t>{m.cell_count() - 1});
    CHECK(report.reason.find("all vertices pinned") != std::string::npos);
}

TEST_CASE("dist deform: where steps stick for slivers, systems are solved by factorisation")
{
    // Vertices inside are pushed into the planes of faces, so that some tetrahedra are next to flat.
    const auto straight = bar(4);
    auto points = straight.points();
    std::mt19937 random(9);
    std::uniform_int_distribution<std::size_t> any(0, straight.cells().size() - 1);
    for (int k = 0; k < 60; ++k)
    {
        const auto& cell = straight.cells()[any(random)];
        const auto at = [&](std::size_t c) -> vec3& { return points[static_cast<std::size_t>(cell[c])]; };
        const vec3 before = at(3);
        if (before.x <= 0 || before.x >= 1 || before.y <= 0 || before.y >= 1 || before.z <= 0 || before.z >= 4)
            continue;
        at(3) = 0.002 * before + 0.998 * (at(0) + at(1) + at(2)) / 3.0;
        if (!certify<3>(std::span(straight.cells()), std::span<const vec3>(points))) at(3) = before;
    }
    const mesh<tetrahedron> m(points, straight.cells());
    const auto where = twisted(pi / 2);
    const auto [x, report] = over_all(m, where);
    CHECK(report.outcome == outcome::valid);
    CHECK(report.pins_held);
    CHECK(report.flips);
    CHECK(at_their_places(m, x, where));
}

} // namespace taut::test
