// SPDX-License-Identifier: MIT
#include <cmath>
#include <limits>
#include <set>

#include <doctest/doctest.h>

#include <support/meshes.hpp>
#include <support/objective_cases.hpp>
#include <support/reference_problem.hpp>
#include <support/shared_context.hpp>
#include <support/size.hpp>

#include <taut/energies.hpp>
#include <taut/impl/core/energy/algebra.hpp>
#include <taut/impl/core/objective/vertex_relaxation.hpp>
#include <taut/impl/core/objective/volume_objective.hpp>

namespace
{

using namespace taut;
using namespace taut::impl;
using test::arithmetic;

/// A user's energy that sees directions: stretch along the first axis of the ideal element costs more.
struct stiff_along_first
{
    static constexpr bool barrier = true;

    template <class T, int D>
    T operator()(const element<T, D>& e) const
    {
        return (T(2) * glm::dot(e.S[0], e.S[0]) + glm::dot(e.S[1], e.S[1])) * (T(1) + T(1) / (e.det * e.det));
    }
};

/// Points of a flat mesh as its map: the identity, with every triangle at rest.
std::vector<vec2> flat(const mesh<triangle>& m)
{
    std::vector<vec2> uv;
    for (const vec3& p : m.points()) uv.emplace_back(p.x, p.y);
    return uv;
}

double det(const mesh<triangle>& m, const std::vector<vec2>& uv, taut::idx c)
{
    const auto& t = m.cells()[std::size_t(c)];
    const vec2 a = uv[std::size_t(t[1])] - uv[std::size_t(t[0])], b = uv[std::size_t(t[2])] - uv[std::size_t(t[0])];
    return a.x * b.y - a.y * b.x;
}

/// Moves a vertex towards the edge opposite to it in one of its triangles, up to a share h of its height, if no
/// triangle flips.
bool squash(const mesh<triangle>& m, const csr& cells, std::vector<vec2>& uv, taut::idx v, double h)
{
    const vec2 before = uv[std::size_t(v)];
    for (const taut::idx c : cells.row(v))
    {
        vec2 middle(0.0);
        for (const taut::idx w : m.cells()[std::size_t(c)])
            if (w != v) middle += 0.5 * uv[std::size_t(w)];
        uv[std::size_t(v)] = middle + h * (before - middle);
        bool valid = true;
        for (const taut::idx d : cells.row(v)) valid = valid && det(m, uv, d) > 0;
        if (valid) return true;
    }
    uv[std::size_t(v)] = before;
    return false;
}

/// A flat mesh in place but for slivers at every `spacing`th vertex that can become one, `most` at most; every fifth
/// vertex is pinned.
struct relaxation_fixture
{
    mesh<triangle> surface;
    std::vector<vec2> start;
    std::vector<bool> pinned;
    std::size_t slivers = 0;
    std::shared_ptr<const layout<triangle>> local;

    relaxation_fixture(int n, taut::idx spacing, double h, std::size_t most = 1000)
        : surface(test::bumpy(n, 0.0, 3)), start(flat(surface))
    {
        const auto cells = vertex_cells(surface);
        for (taut::idx v = 0; v < surface.vertex_count(); ++v) pinned.push_back(v % 5 == 0);
        for (taut::idx v = n + 2; v < surface.vertex_count() && slivers < most; v += spacing)
            if (!pinned[std::size_t(v)]) slivers += squash(surface, cells, start, v, h);
        local = std::make_shared<const layout<triangle>>(surface, pinned);
    }

    device_vector point(queue& q, const real_types& types = {}) const
    {
        return {q, types.position, local->to_local(start)};
    }

    /// The energy of device positions, by the host.
    double value(const device_vector& x, const any_energy& energy) const
    {
        return test::reference_problem<triangle>(local, energy, energy::weighting::measure)(x.download(), {});
    }
};

vertex_relaxation<triangle> make(queue& q, const relaxation_fixture& s, const any_energy& energy,
                                 const real_types& types = {})
{
    return {q, s.local, energy, energy::weighting::measure, types};
}

} // namespace

TEST_CASE("vertex relaxation: a schedule has the free vertices of the cells, neighbours in different colours")
{
    for (const int n : {4, 15})
    {
        const relaxation_fixture s(n, 9, 0.1);
        const auto& l = *s.local;
        relaxation_scheduler<triangle> scheduler(l);
        std::vector<taut::idx> cells;
        for (taut::idx c = 0; c < l.cell_count; c += 3) cells.push_back(c);
        const auto corner = [&](taut::idx c, int k)
        { return l.corners[std::size_t(k) * l.cell_stride + std::size_t(c)]; };
        std::set<taut::idx> expected;
        for (const taut::idx c : cells)
            for (int k = 0; k < 3; ++k)
                if (corner(c, k) < l.free_count) expected.insert(corner(c, k));

        // The second time, nothing of the first is left.
        CHECK(scheduler(l, {}).rows == 0);
        for (int round = 0; round < 2; ++round)
        {
            const auto r = scheduler(l, cells);
            const auto list = [&](int which, taut::idx i) { return r.lists[std::size_t(which * r.stride + i)]; };
            std::set<taut::idx> vertices;
            taut::idx row = 0, entry = 0;
            for (const auto& c : r.colours)
            {
                REQUIRE(c.first_row == row);
                REQUIRE(c.first_entry == entry);
                CHECK(c.entries <= r.widest);
                std::set<taut::idx> touched;
                for (; row < c.first_row + c.rows; ++row)
                {
                    vertices.insert(list(0, row));
                    REQUIRE(list(1, row) == entry);
                    for (const taut::idx i : l.vertex_corners.row(list(0, row)))
                    {
                        CHECK(list(2, entry) == i / 3);
                        CHECK(list(3, entry++) == row);
                        CHECK(touched.insert(i / 3).second);
                    }
                }
            }
            CHECK(list(1, r.rows) == entry);
            CHECK(row == r.rows);
            CHECK(vertices == expected);
        }
    }
}

TEST_CASE_TEMPLATE("vertex relaxation: a sliver recovers, and nothing but its vertices moves", A,
                   arithmetic<precision::fp64>, arithmetic<precision::mixed>, arithmetic<precision::fp32>)
{
    queue q(test::shared_context());
    for (const int n : {6, test::sized(20, 9)})
    {
        relaxation_fixture s(n, 1, 1e-3, 1);
        REQUIRE(s.slivers == 1);
        auto x = s.point(q, A::types());
        const auto before = x.download();
        auto relax = make(q, s, energy::isometric{}, A::types());
        const auto r = relax(x, {.sweeps = 6});
        const auto after = x.download();

        CHECK(r.elements >= 1);
        CHECK(r.vertices >= 1);
        CHECK(r.vertices <= 3 * r.elements);
        CHECK(r.worst > 1e4);
        std::size_t moved = 0;
        const auto stride = s.local->vertex_stride;
        for (std::size_t v = 0; v < stride; ++v)
        {
            const bool still = before[v] == after[v] && before[stride + v] == after[stride + v];
            if (v >= std::size_t(s.local->free_count)) CHECK(still);
            moved += !still;
        }
        CHECK(moved >= 1);
        CHECK(moved <= r.vertices);
        CHECK(s.value(x, energy::isometric{}) < 8);
        CHECK(relax(x, {.sweeps = 0}).worst < 30);
    }
}

TEST_CASE_TEMPLATE("vertex relaxation: the energy falls call by call, for any energy, and repeats bit for bit", A,
                   arithmetic<precision::fp64>, arithmetic<precision::mixed>, arithmetic<precision::fp32>)
{
    queue q(test::shared_context());
    const relaxation_fixture s(test::sized(18, 8), 7, 1e-2);
    REQUIRE(s.slivers > 3);
    using namespace taut::energy;
    std::vector<any_energy> energies = {isometric{}, stiff_along_first{}};
    if (A::types().vector == scalar_type::f64)
        energies.insert(energies.end(), {0.5 * isometric{} + 0.5 * shape{}, shape{} * area{}});
    for (const any_energy& energy : energies)
    {
        auto relax = make(q, s, energy, A::types());
        auto x = s.point(q, A::types()), y = s.point(q, A::types());
        double value = s.value(x, energy);
        const double first = value;
        for (int call = 0; call < 3; ++call)
        {
            const auto r = relax(x, {.threshold = 2, .above_mean = 0, .sweeps = 2});
            relax(y, {.threshold = 2, .above_mean = 0, .sweeps = 2});
            const double next = s.value(x, energy);
            if (call == 0) CHECK(r.elements >= s.slivers);
            CHECK(next <= value * (1 + 1e-6));
            value = next;
        }
        CHECK(value < 0.1 * first);
        CHECK(x.download() == y.download());
    }
}

TEST_CASE("vertex relaxation: one sweep is the best multiple of the damped Newton step of the star")
{
    queue q(test::shared_context());
    for (const int n : {5, 9})
        for (const any_energy& energy : {any_energy(energy::isometric{}), any_energy(stiff_along_first{})})
        {
            // Only the hub of a wheel is free.
            const auto wheel = test::fan(n, true);
            std::vector<bool> pinned(std::size_t(n) + 1, true);
            pinned[0] = false;
            const auto l = std::make_shared<const layout<triangle>>(wheel, pinned);
            auto start = flat(wheel);
            start[0] = {0.3, 0.55};
            const auto local = l->to_local(start);
            device_vector x(q, scalar_type::f64, local);
            vertex_relaxation<triangle> relax(q, l, energy, energy::weighting::uniform);
            CHECK(relax(x, {.threshold = 1.01, .above_mean = 0, .sweeps = 1}).vertices == 1);
            const auto moved = x.download();

            // The host: gradients of the reference, their differences, and the absolute value by sqrt(H H).
            const test::reference_problem<triangle> host(l, energy, energy::weighting::uniform);
            const auto at = [&](vec2 p, std::vector<double>* g)
            {
                auto y = local;
                y[0] = p.x;
                y[l->vertex_stride] = p.y;
                return host(y, g ? std::span<double>(*g) : std::span<double>());
            };
            const auto gradient = [&](vec2 p)
            {
                std::vector<double> g(host.size());
                at(p, &g);
                return vec2(g[0], g[l->vertex_stride]);
            };
            const vec2 p(local[0], local[l->vertex_stride]);
            const double h = 1e-6;
            const mat2 H((gradient(p + vec2(h, 0)) - gradient(p - vec2(h, 0))) / (2 * h),
                         (gradient(p + vec2(0, h)) - gradient(p - vec2(0, h))) / (2 * h));
            const double root = std::abs(glm::determinant(H));
            const double trace = H[0][0] + H[1][1], square = norm2(H);
            const double spread = std::sqrt(square + 2 * root); // the trace of |H|
            mat2 absolute = (H * H + mat2(root)) * (1 / spread);
            CHECK(spread >= std::abs(trace) * (1 - 1e-9));
            const double m = std::max(absolute[0][0], absolute[1][1]);
            using kernels = relaxation_kernels<triangle>;
            absolute += mat2(kernels::damping * m);
            const vec2 d = -(glm::inverse(absolute) * gradient(p));
            double least = at(p, nullptr);
            vec2 best = p;
            for (const double a : kernels::step_lengths)
                if (const double e = at(p + a * d, nullptr); e < least) least = e, best = p + a * d;
            CHECK(best != p);
            CHECK(moved[0] == doctest::Approx(best.x).epsilon(1e-6));
            CHECK(moved[l->vertex_stride] == doctest::Approx(best.y).epsilon(1e-6));
        }
}

TEST_CASE("vertex relaxation: without bad elements, or outside of the domain, nothing changes")
{
    queue q(test::shared_context());
    relaxation_fixture s(test::sized(12, 6), 10, 1e-2);
    auto relax = make(q, s, energy::isometric{});
    auto x = s.point(q);
    const auto before = x.download();
    relax.warm_up(x);

    const auto waits = q.counters().waits;
    const auto none = relax(x, {.threshold = 1e9});
    CHECK(q.counters().waits == waits + 1);
    CHECK(none.elements == 0);
    CHECK(none.vertices == 0);
    CHECK(none.sweeps == 0);
    CHECK(none.worst > 100);
    CHECK(relax(x, {.above_mean = 1e9}).elements == 0);
    CHECK(x.download() == before);

    auto folded = before;
    for (std::size_t v = 0; v < s.local->vertex_stride; ++v) folded[v] = -folded[v];
    x.upload(folded);
    CHECK(relax(x).elements == 0);
    CHECK(std::isinf(relax(x).worst));
    CHECK(x.download() == folded);
}

TEST_CASE("vertex relaxation: all pinned is legal, and meshes share kernels")
{
    queue q(test::shared_context());
    using kernels = relaxation_kernels<triangle>;
    const auto types = types_of(precision::mixed);
    const auto shared = std::make_shared<const kernels>(q, energy::isometric{}, types);
    for (const int n : {5, 11})
    {
        const relaxation_fixture s(n, 6, 1e-2);
        const auto arrays = std::make_shared<const element_arrays<triangle>>(
            q, types.vector, *s.local, energy::weighting::measure, energy::isometric{});
        auto x = s.point(q);
        const double before = s.value(x, energy::isometric{});
        vertex_relaxation<triangle> relax(q, s.local, shared, arrays);
        CHECK(relax(x).vertices > 0);
        CHECK(s.value(x, energy::isometric{}) < before);

        const auto still = std::make_shared<const layout<triangle>>(
            s.surface, std::vector<bool>(std::size_t(s.surface.vertex_count()), true));
        device_vector y(q, scalar_type::f64, still->to_local(s.start));
        const auto unmoved = y.download();
        vertex_relaxation<triangle> none(q, still, shared,
                                         std::make_shared<const element_arrays<triangle>>(
                                             q, types.vector, *still, energy::weighting::measure, energy::isometric{}));
        none.warm_up(y);
        const auto r = none(y);
        CHECK(r.elements > 0);
        CHECK(r.vertices == 0);
        CHECK(y.download() == unmoved);
    }
}

TEST_CASE("vertex relaxation: a flat tetrahedron recovers")
{
    queue q(test::shared_context());
    const auto rest = test::cube(3);
    const auto local = std::make_shared<const layout<tetrahedron>>(rest);
    auto start = rest.points();
    const auto cells = vertex_cells(rest);
    // An inner vertex, close to the opposite side of one of its tetrahedra: the star of a grid is convex.
    const taut::idx v = 21;
    const auto& t = rest.cells()[std::size_t(cells.row(v)[0])];
    vec3 middle(0.0);
    for (const taut::idx w : t)
        if (w != v) middle += start[std::size_t(w)] / 3.0;
    start[std::size_t(v)] = middle + 1e-2 * (start[std::size_t(v)] - middle);
    const test::reference_problem<tetrahedron> host(local, energy::isometric{}, energy::weighting::measure);
    const double before = host(local->to_local(start), {});
    REQUIRE(std::isfinite(before));

    device_vector x(q, scalar_type::f64, local->to_local(start));
    vertex_relaxation<tetrahedron> relax(q, local, energy::isometric{}, energy::weighting::measure);
    CHECK(relax(x).elements >= 1);
    CHECK(host(x.download(), {}) < std::min(before, 4.0));
}
