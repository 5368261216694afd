// SPDX-License-Identifier: MIT
// What one process does wrong, all are told: it throws its own error, the others a remote_error of the same text.
#include <doctest/doctest.h>

#include <cmath>
#include <new>
#include <string>

#include <dist/pieces.hpp>
#include <taut/errors.hpp>
#include <taut/impl/dist/processes/communicator.hpp>

namespace taut::test
{

namespace
{

enum class thrown
{
    nothing,
    own,
    remote
};

struct caught
{
    thrown kind = thrown::nothing;
    std::string what;
};

/// Error: of the process that fails.
template <class Error, class F>
caught attempt(const F& f)
{
    try
    {
        f();
    }
    catch (const dist::remote_error& e)
    {
        return {thrown::remote, e.what()};
    }
    catch (const Error& e)
    {
        return {thrown::own, e.what()};
    }
    return {};
}

int last_rank()
{
    return size_of() - 1;
}

/// The last process fails, with a text that says `word`.
template <class Error, class F>
void expect(const F& f, const std::string& word, int failing = last_rank())
{
    const auto c = attempt<Error>(f);
    CHECK(c.kind == (rank_of() == failing ? thrown::own : thrown::remote));
    if constexpr (!std::is_same_v<Error, std::bad_alloc>) CHECK_MESSAGE(c.what.find(word) != std::string::npos, c.what);
}

void deform(const piece& p, dist::deform_params<tetrahedron> how = {}, const run_limits& limits = {})
{
    how.queue = common_queue();
    dist::deform<tetrahedron>(MPI_COMM_WORLD, p, how, limits);
}

} // namespace

TEST_CASE("dist faults: a coordinate that is no number")
{
    auto p = dealt(MPI_COMM_WORLD, bar(2));
    if (rank_of() == last_rank()) p.points[3].y = std::nan("");
    expect<mesh_error>([&] { deform(p); }, "not a finite number");
}

TEST_CASE("dist faults: cells that name no vertex, or one twice")
{
    auto p = dealt(MPI_COMM_WORLD, bar(2));
    if (rank_of() == last_rank()) p.cells[0][1] = 123456;
    expect<mesh_error>([&] { deform(p); }, "names vertex 123456");
    p = dealt(MPI_COMM_WORLD, bar(2));
    if (rank_of() == last_rank()) p.cells[1][1] = p.cells[1][0];
    expect<mesh_error>([&] { deform(p); }, "twice");
}

TEST_CASE("dist faults: a flat element at rest, and inverted ones, by their numbers among the cells")
{
    const auto m = bar(2);
    auto p = dealt(MPI_COMM_WORLD, m);
    if (rank_of() == last_rank()) std::swap(p.cells.back()[0], p.cells.back()[1]);
    const auto c = attempt<mesh_error>([&] { deform(p); });
    CHECK(c.kind != thrown::nothing);
    CHECK_MESSAGE(c.what.find("(" + std::to_string(m.cell_count() - 1) + ")") != std::string::npos, c.what);
}

TEST_CASE("dist faults: a cell in two pieces")
{
    auto p = dealt(MPI_COMM_WORLD, bar(2));
    const auto m = bar(2);
    if (rank_of() == last_rank())
    {
        std::array<std::int64_t, 4> again;
        std::copy(m.cells()[0].begin(), m.cells()[0].end(), again.begin());
        p.cells.push_back(again);
    }
    const auto c = attempt<mesh_error>([&] { deform(p); });
    CHECK(c.kind != thrown::nothing);
    CHECK_MESSAGE(c.what.find("same corners") != std::string::npos, c.what);
}

TEST_CASE("dist faults: a vertex at two positions")
{
    auto p = dealt(MPI_COMM_WORLD, bar(2));
    if (rank_of() == last_rank())
    {
        p.ids.push_back(p.ids[0]);
        p.points.push_back(p.points[0] + vec3(1e-3));
    }
    const auto c = attempt<mesh_error>([&] { deform(p); });
    CHECK(c.kind != thrown::nothing);
    CHECK(c.what.find("two positions") != std::string::npos);
}

TEST_CASE("dist faults: pins of vertices that are not there, without numbers, or contradictory")
{
    const auto p = dealt(MPI_COMM_WORLD, bar(2));
    const auto pinned = [&](std::int64_t id, const vec3& x)
    {
        dist::deform_params<tetrahedron> how;
        if (rank_of() == last_rank()) how.constraints.pin(id, x);
        return how;
    };
    expect<constraint_error>([&] { deform(p, pinned(99999, vec3(0))); }, "99999");
    expect<constraint_error>([&] { deform(p, pinned(-1, vec3(0))); }, "-1");
    expect<constraint_error>([&] { deform(p, pinned(3, vec3(0, std::nan(""), 0))); }, "not finite");
    dist::deform_params<tetrahedron> how;
    how.constraints.pin(3, vec3(rank_of(), 0, 0)); // a place of each
    const auto c = attempt<constraint_error>([&] { deform(p, how); });
    CHECK(c.kind != thrown::nothing);
    CHECK(c.what.find("two different positions") != std::string::npos);
    how = {};
    if (rank_of() == last_rank()) how.constraints.spring(3, vec3(0), -1);
    expect<constraint_error>([&] { deform(p, how); }, "weight");
    how = {};
    if (rank_of() == last_rank()) how.constraints.pin(3, 7, 0.5);
    expect<constraint_error>([&] { deform(p, how); }, "coordinate");
}

TEST_CASE("dist faults: what an observer of one process throws in the middle of a run")
{
    const auto m = bar(2);
    dist::deform_params<tetrahedron> how{.constraints = ends(MPI_COMM_WORLD, m, stretched)};
    run_limits limits;
    if (rank_of() == last_rank())
        limits.observer = [](const progress& p)
        {
            if (p.iteration >= 1) throw error("enough of it");
            return true;
        };
    expect<error>([&] { deform(dealt(MPI_COMM_WORLD, m), how, limits); }, "enough of it");
    if (rank_of() == last_rank()) limits.observer = [](const progress&) -> bool { throw std::bad_alloc(); };
    const auto c = attempt<std::bad_alloc>([&] { deform(dealt(MPI_COMM_WORLD, m), how, limits); });
    if (rank_of() != last_rank()) CHECK(c.what.find("not enough memory on process") != std::string::npos);
}

TEST_CASE("dist faults: parameters")
{
    const auto p = dealt(MPI_COMM_WORLD, bar(2));
    dist::deform_params<tetrahedron> how;
    if (rank_of() == last_rank()) how.initial.resize(2);
    const auto c = attempt<parameter_error>([&] { deform(p, how); });
    CHECK(c.kind != thrown::nothing);
    how = {.constraints = ends(MPI_COMM_WORLD, bar(2), stretched)};
    how.solver.options = "-pc_type nonsense";
    CHECK_THROWS_AS(deform(p, how), parameter_error);
    // The next run is as if nothing had happened.
    CHECK_NOTHROW(deform(p));
}

TEST_CASE("dist faults: no mesh at all")
{
    const auto c = attempt<mesh_error>([] { deform({}); });
    CHECK(c.kind == (rank_of() == 0 ? thrown::own : c.kind));
    CHECK(c.kind != thrown::nothing);
}

} // namespace taut::test
