// SPDX-License-Identifier: MIT
#include <doctest/doctest.h>

#include <cmath>
#include <random>

#include <dist/pieces.hpp>
#include <taut/deform.hpp>
#include <taut/impl/dist/shape/shape_body.hpp>

namespace taut::test
{

namespace
{

/// What must be the same bits on any number of processes.
struct bits
{
    double value = 0, square = 0, flip = 0, trials[2] = {}, least_det = 0;
    std::int64_t flipped = 0;
    std::vector<double> gradient; ///< by id, at the first process

    friend bool operator==(const bits& a, const bits& b)
    {
        return a.value == b.value && a.square == b.square && a.flip == b.flip && a.trials[0] == b.trials[0] &&
               a.trials[1] == b.trials[1] && a.least_det == b.least_det && a.flipped == b.flipped &&
               a.gradient == b.gradient;
    }
};

bits measured(MPI_Comm comm, const mesh<tetrahedron>& m, const dealing& how = {})
{
    dist::session<tetrahedron> s(comm, dealt(comm, m, how), {.queue = common_queue()});
    auto& body = s.body();
    auto& f = body.objective();
    const auto& p = body.mesh_part();
    auto x = body.current();
    auto g = f.space().make(), d = g;
    for (std::size_t v = 0; v < p.size(); ++v)
    {
        const double z = x[3 * v + 2], c = std::cos(0.02 * z), t = std::sin(0.02 * z), a = x[3 * v], b = x[3 * v + 1];
        x[3 * v] = c * a - t * b;
        x[3 * v + 1] = t * a + c * b;
        x[3 * v + 2] = 1.1 * z;
    }
    bits r;
    r.value = f.value_gradient(x, g, r.square);
    for (std::size_t i = 0; i < d.size(); ++i)
        d[i] = std::sin(static_cast<double>(3 * p.ids[i / 3] + static_cast<std::int64_t>(i % 3)));
    r.flip = f.max_step(x, d);
    const double steps[] = {0.25 * r.flip, 0.5 * r.flip};
    f.values(x, d, steps, r.trials);
    // Folded: some elements are inverted.
    auto folded = x;
    f.step(x, 1.5 * r.flip, d, folded);
    const auto c = dist::impl::certify_part(p, folded, body.at_rest().measure);
    r.flipped = c.flipped;
    r.least_det = c.min_det;
    struct entry
    {
        std::int64_t id;
        double g[3];
    };
    std::vector<entry> entries;
    for (std::size_t v = 0; v < p.own; ++v) entries.push_back({p.ids[v], {g[3 * v], g[3 * v + 1], g[3 * v + 2]}});
    entries = p.all.gathered(entries);
    std::sort(entries.begin(), entries.end(), [](const entry& a, const entry& b) { return a.id < b.id; });
    for (const auto& e : entries) r.gradient.insert(r.gradient.end(), e.g, e.g + 3);
    return r;
}

} // namespace

TEST_CASE("dist bits: energies, gradients, first flips and certificates do not depend on the number of processes")
{
    const auto m = bar(3);
    std::optional<bits> first;
    for (int size = 1; size <= size_of(); ++size)
    {
        const first_processes some(size);
        if (!some) continue;
        const auto now = measured(some.get(), m);
        CHECK(std::isfinite(now.value));
        CHECK(now.flipped > 0);
        if (first) CHECK(now == *first);
        if (!first) first = now;
    }
}

TEST_CASE("dist bits: they depend neither on who has which cells nor on gaps in the ids")
{
    const auto m = bar(2);
    const auto blocks = measured(MPI_COMM_WORLD, m), in_turn = measured(MPI_COMM_WORLD, m, {.in_turn = true});
    CHECK(blocks == in_turn);
    // Ids decide between vertices at one place of the curve alone, so their order is what counts.
    const auto gaps = dist::deform<tetrahedron>(
        MPI_COMM_WORLD, dealt(MPI_COMM_WORLD, m, {.stride = 1000003, .first = 7}),
        {.constraints = ends(MPI_COMM_WORLD, m, stretched, {.stride = 1000003, .first = 7}), .queue = common_queue()});
    const auto plain =
        dist::deform<tetrahedron>(MPI_COMM_WORLD, dealt(MPI_COMM_WORLD, m),
                                  {.constraints = ends(MPI_COMM_WORLD, m, stretched), .queue = common_queue()});
    CHECK(gaps.report.energy == plain.report.energy);
    CHECK(gaps.x == plain.x);
}

TEST_CASE("dist bits: a value is that of one process with the same energy and weights")
{
    const auto m = bar(2);
    dist::session<tetrahedron> s(MPI_COMM_WORLD, dealt(MPI_COMM_WORLD, m), {.queue = common_queue()});
    auto x = s.body().current();
    for (std::size_t v = 0; v < s.body().mesh_part().size(); ++v) x[3 * v + 2] *= 1.25;
    const double value = s.body().objective().value(x);
    const element<double, 3> e{mat3(1, 0, 0, 0, 1, 0, 0, 0, 1.25), 1.25, 1.0};
    CHECK(value == doctest::Approx(energy::isometric{}(e)).epsilon(1e-13));
}

TEST_CASE("dist fixed sums: exact in any order, over any range of exponents")
{
    std::mt19937 random(5);
    std::uniform_real_distribution<double> mantissa(-1, 1);
    std::uniform_int_distribution<int> exponent(-300, 300);
    std::vector<double> terms;
    for (int k = 0; k < 2000; ++k) terms.push_back(std::ldexp(mantissa(random), exponent(random)));
    const std::vector<double> once = terms;
    for (const double t : once) terms.push_back(-t); // they cancel
    terms.push_back(1e-310);                         // subnormal
    terms.push_back(-0.0);
    const auto sum = [](const std::vector<double>& all)
    {
        dist::impl::fixed_sum s;
        for (const double t : all) s.add(t);
        return dist::impl::fixed_sum::value(s.raw());
    };
    CHECK(sum(terms) == 1e-310);
    std::shuffle(terms.begin(), terms.end(), random);
    CHECK(sum(terms) == 1e-310);
    CHECK(sum({1, 2, -4.5}) == -1.5);
    CHECK(sum({1e308, 1e308, -1e308}) == 1e308);
    CHECK(sum({}) == 0);
    CHECK(std::isinf(sum({1, std::numeric_limits<double>::infinity()})));
    CHECK(std::isinf(sum({1, std::nan("")})));
}

TEST_CASE("dist communicator: what is exchanged arrives in order; sums are the same on all")
{
    const dist::impl::communicator all(MPI_COMM_WORLD);
    dist::impl::parcels<std::int64_t> to(all.ranks());
    for (std::size_t r = 0; r < all.ranks(); ++r)
        for (std::size_t k = 0; k <= r; ++k)
            to[r].push_back(static_cast<std::int64_t>(100 * r + k) + 1000 * all.rank());
    const auto got = all.exchange(to);
    for (std::size_t r = 0; r < all.ranks(); ++r)
    {
        REQUIRE(got.from(r).size() == static_cast<std::size_t>(all.rank()) + 1);
        CHECK(got.from(r)[0] == 100 * all.rank() + 1000 * static_cast<std::int64_t>(r));
    }
    CHECK(all.before(2) == 2 * all.rank());
    CHECK(all.shared(std::string(all.rank() == 0 ? "one text" : "other")) == "one text");
    std::vector<double> x = {1.0 * all.rank(), 0.1};
    all.add(std::span(x));
    CHECK(x[0] == all.size() * (all.size() - 1) / 2.0);
    // What is no number is none on all processes, wherever it comes from.
    const bool last = all.rank() == all.size() - 1;
    CHECK(std::isnan(all.least(last ? std::nan("") : 1.0)));
    CHECK(std::isnan(all.most(last ? std::nan("") : 1.0)));
    CHECK(all.least(1.0 + all.rank()) == 1);
    CHECK(all.most(-1.0 - all.rank()) == -1);
}

TEST_CASE("dist deform: a mesh gathered on process 0 gets the shape that one process finds")
{
    const auto m = bar(2);
    dist::deform_params<tetrahedron> how{.constraints = ends(MPI_COMM_WORLD, m, stretched), .queue = common_queue()};
    const auto p = dealt(MPI_COMM_WORLD, m);
    dist::session<tetrahedron> s(MPI_COMM_WORLD, p, how);
    auto& body = s.body();
    dist::impl::petsc_scope petsc;
    dist::impl::fixed_part<tetrahedron> held(body.mesh_part());
    held.take(body.mesh_part(), how.constraints);
    const double lengths = body.at_rest().lengths;
    const auto found =
        dist::impl::gathered_solve<tetrahedron>::run(body.mesh_part(), held, lengths, how, body.current(), {});
    REQUIRE(found.has_value());
    queue& q = common_queue();
    const auto alone = deform(q, m, deform_params<tetrahedron>{.constraints = serial_ends(m, stretched)});
    for (std::size_t v = 0; v < body.mesh_part().own; ++v)
        for (int k = 0; k < 3; ++k)
            CHECK(found->x[3 * v + static_cast<std::size_t>(k)] / lengths ==
                  doctest::Approx(alone.x[static_cast<std::size_t>(body.mesh_part().ids[v])][k]).epsilon(1e-4));
}

} // namespace taut::test
