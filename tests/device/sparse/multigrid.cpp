// SPDX-License-Identifier: MIT
#include <algorithm>
#include <array>
#include <cmath>

#include <doctest/doctest.h>

#include <support/dense_matrix.hpp>
#include <support/meshes.hpp>
#include <taut/impl/core/hierarchy/make_hierarchy.hpp>
#include <taut/impl/core/sparse/block_assembly.hpp>
#include <taut/impl/core/sparse/multigrid.hpp>

#include "support/device.hpp"
#include "support/lane_forms.hpp"
#include <support/shared_context.hpp>

using namespace taut;
using namespace taut::impl;

namespace
{

/// A mesh with the interpolations between its levels.
template <class Element>
struct leveled_mesh
{
    static constexpr std::size_t K = Element::corners;

    struct step
    {
        std::vector<std::array<taut::idx, K>> columns;
        std::vector<std::array<double, K>> weights;
        std::vector<char> fixed; ///< of the coarse side
    };

    mesh<Element> finest;
    std::vector<char> fixed;
    std::vector<step> steps;
};

/// With pins, the boundary of the lower side is fixed.
leveled_mesh<triangle> surface(const mesh<triangle>& m, bool pinned)
{
    leveled_mesh<triangle> all{m, std::vector<char>(m.points().size(), 0), {}};
    if (pinned)
        for (std::size_t v = 0; v < all.fixed.size(); ++v) all.fixed[v] = m.points()[v].y == 0;
    const auto h = make_hierarchy(m, all.fixed);
    for (std::size_t l = 0; l < h.steps.size(); ++l)
    {
        const auto& P = h.steps[l].interpolation;
        all.steps.push_back({P.columns, P.weights, {}});
        for (const taut::idx v : h.levels[l + 1].vertices) all.steps[l].fixed.push_back(all.fixed[std::size_t(v)]);
    }
    return all;
}

/// Cubes of n, factor * n, factor * factor * n .. cubes a side, `levels` in all; with pins, the lowest layer of
/// vertices is fixed. By `factor` the interpolation has rows of one to four weights (3) or two at most (2).
leveled_mesh<tetrahedron> cubes(int n, int factor, int levels, bool pinned)
{
    const auto flags = [&](const mesh<tetrahedron>& m)
    {
        std::vector<char> fixed;
        for (const vec3& p : m.points()) fixed.push_back(pinned && p.z == 0);
        return fixed;
    };
    leveled_mesh<tetrahedron> all{test::cube(n), {}, {}};
    all.fixed = flags(all.finest);
    for (int l = 1; l < levels; ++l, n *= factor)
    {
        const auto finer = test::cube(factor * n);
        leveled_mesh<tetrahedron>::step step{{}, {}, all.fixed};
        for (const vec3& p : finer.points())
        {
            // In the tetrahedra of a cube, paths along the axes, the coordinates fall in the order of the path.
            std::array<int, 3> corner, axis{0, 1, 2};
            std::array<double, 3> rest;
            for (std::size_t k = 0; k < 3; ++k)
            {
                const int fine = int(std::lround(p[int(k)] * factor * n));
                corner[k] = std::min(fine / factor, n - 1);
                rest[k] = double(fine - corner[k] * factor) / factor;
            }
            std::sort(axis.begin(), axis.end(),
                      [&](int a, int b) { return rest[std::size_t(a)] > rest[std::size_t(b)]; });
            std::array<taut::idx, 4> columns;
            std::array<double, 4> weights;
            double before = 1;
            for (std::size_t k = 0; k < 4; ++k)
            {
                columns[k] = taut::idx((corner[2] * (n + 1) + corner[1]) * (n + 1) + corner[0]);
                const double next = k < 3 ? rest[std::size_t(axis[k])] : 0;
                weights[k] = before - next;
                before = next;
                if (k < 3) ++corner[std::size_t(axis[k])];
            }
            step.columns.push_back(columns);
            step.weights.push_back(weights);
        }
        all.steps.insert(all.steps.begin(), std::move(step));
        all.finest = finer;
        all.fixed = flags(finer);
    }
    return all;
}

/// Gradients of the linear functions of a simplex that are 1 at one corner, in the plane of z = 0 or in space, and
/// twice the area or six times the volume.
double gradients(const std::array<vec3, 3>& p, std::array<vec3, 3>& gradient)
{
    vec2 x[3];
    for (std::size_t k = 0; k < 3; ++k) x[k] = vec2(p[k]);
    const double twice = (x[1].x - x[0].x) * (x[2].y - x[0].y) - (x[1].y - x[0].y) * (x[2].x - x[0].x);
    for (std::size_t k = 0; k < 3; ++k)
    {
        const vec2 e = x[(k + 2) % 3] - x[(k + 1) % 3];
        gradient[k] = vec3(-e.y, e.x, 0) / twice;
    }
    return twice;
}
double gradients(const std::array<vec3, 4>& p, std::array<vec3, 4>& gradient)
{
    const mat3 edges(p[1] - p[0], p[2] - p[0], p[3] - p[0]);
    const mat3 rows = glm::transpose(glm::inverse(edges));
    gradient = {-rows[0] - rows[1] - rows[2], rows[0], rows[1], rows[2]};
    return glm::determinant(edges);
}

/// A multigrid of the energy of small displacements (sum of squared gradients plus squared divergence) with D
/// components, as element blocks.
template <class Element>
multigrid elastic(queue& q, scalar_type type, const leveled_mesh<Element>& all, int D, lane_form form)
{
    constexpr std::size_t K = Element::corners;
    const auto& m = all.finest;
    const std::size_t n = m.points().size(), d = std::size_t(D), cells = m.cells().size(), stride = padded(cells, 256);
    std::vector<transfer_weights> transfers;
    for (const auto& s : all.steps)
        transfers.push_back(transfer_weights::of_rows(s.columns, s.weights, s.fixed.size(), s.fixed));
    std::vector<double> blocks((K * d * (d + 1) / 2 + K * (K - 1) / 2 * d * d) * stride, 0.0);
    for (std::size_t cell = 0; cell < cells; ++cell)
    {
        std::array<vec3, K> gradient;
        const double size = gradients(m.rest(taut::idx(cell)), gradient);
        for (std::size_t k = 0, slot = 0; k < K; ++k)
            for (std::size_t l = k; l < K; ++l)
                for (std::size_t a = 0; a < d; ++a)
                    for (std::size_t b = k == l ? a : 0; b < d; ++b, ++slot)
                    {
                        const double div = gradient[k][int(a)] * gradient[l][int(b)];
                        const double same = a == b ? glm::dot(gradient[k], gradient[l]) : 0;
                        blocks[slot * stride + cell] = size * (same + div);
                    }
    }
    const auto around = incidence_of_cells(m.cells(), n);
    multigrid_plan plan(pattern_of_cells(m.cells(), around, form.slice), D, transfers, form, {.lambda_max = double(K)});
    const assembly_lists lists(plan.patterns.front(), D, m.cells(), around, stride, all.fixed);
    multigrid mg(q, type, std::move(plan));
    const block_assembly assembly(mg.matrix(), lists);
    assembly(real_buffer(q, type, blocks), mg.matrix());
    q.finish();
    mg.refresh();
    return mg;
}

multigrid elastic(queue& q, scalar_type type, const mesh<triangle>& m, int D, bool pinned, lane_form form)
{
    return elastic(q, type, surface(m, pinned), D, form);
}

/// A matrix of the multigrid as a dense one, row r * D + c for component c of row r.
test::dense_matrix dense(const block_matrix& A)
{
    const auto p = A.pattern();
    const auto values = A.download();
    const auto d = std::size_t(A.block_size());
    test::dense_matrix result(d * A.rows());
    for (std::size_t r = 0; r < A.rows(); ++r)
        for (std::size_t j = 0; j < p.length(r); ++j)
            for (std::size_t e = 0; e < d * d; ++e)
                result(r * d + e / d, std::size_t(p.column(r, j)) * d + e % d) =
                    static_cast<long double>(values[p.place(r, j) * d * d + e]);
    return result;
}

/// A V-cycle of two levels as written in books.
template <class Element>
struct host_cycle
{
    test::dense_matrix A, inverse_diagonal, coarse_inverse;
    typename leveled_mesh<Element>::step P;
    std::size_t d;
    multigrid_params params;

    using numbers = std::vector<double>;

    /// a x + b y + c D^-1 (right - A x)
    numbers step(double a, const numbers& x, double b, const numbers& y, double c, const numbers& right) const
    {
        auto r = A * x;
        for (std::size_t i = 0; i < r.size(); ++i) r[i] = right[i] - r[i];
        auto out = inverse_diagonal * r;
        for (std::size_t i = 0; i < r.size(); ++i) out[i] = a * x[i] + b * y[i] + c * out[i];
        return out;
    }

    numbers operator()(const numbers& b) const
    {
        const double low = params.lambda_max / params.lambda_ratio, middle = (params.lambda_max + low) / 2,
                     half = (params.lambda_max - low) / 2, sigma = middle / half, rho = 1 / (2 * sigma - 1 / sigma);
        const double momentum = rho / sigma, second = 2 * rho / half;
        const numbers zero(b.size(), 0.0);
        auto y = step(1, zero, 0, zero, 1 / middle, b);
        auto x = step(1 + momentum, y, 0, zero, second, b);
        const auto Ax = A * x;
        numbers coarse(coarse_inverse.size(), 0.0);
        const auto each_weight = [&](auto&& body)
        {
            for (std::size_t i = 0; i < P.columns.size(); ++i)
                for (std::size_t k = 0; k < P.columns[i].size(); ++k)
                    for (std::size_t c = 0; c < d; ++c)
                        body(i * d + c, std::size_t(P.columns[i][k]) * d + c, P.weights[i][k]);
        };
        each_weight([&](std::size_t i, std::size_t J, double w) { coarse[J] += w * (b[i] - Ax[i]); });
        coarse = coarse_inverse * coarse;
        each_weight([&](std::size_t i, std::size_t J, double w) { x[i] += w * coarse[J]; });
        y = step(1, x, 0, zero, 1 / middle, b);
        return step(1 + momentum, y, -momentum, x, second, b);
    }
};

/// A right side that the matrix reaches.
device_vector image(const multigrid& mg, unsigned seed)
{
    const auto& A = mg.matrix();
    auto x = A.vector(), b = A.vector();
    const auto values = test::random_reals(A.type(), A.rows(), seed);
    std::vector<double> host(std::size_t(A.block_size()) * A.stride(), 0.0);
    for (std::size_t c = 0; c < std::size_t(A.block_size()); ++c)
        for (std::size_t r = 0; r < A.rows(); ++r) host[c * A.stride() + r] = values[(r * (c + 1)) % A.rows()];
    x.upload(host);
    A.multiply(x, b);
    return b;
}

/// Iterations of preconditioned conjugate gradients until the residual has fallen by `tolerance`.
int solve(queue& q, multigrid& mg, double tolerance)
{
    const auto& A = mg.matrix();
    auto r = image(mg, 3), x = A.vector(), z = A.vector(), p = A.vector(), Ap = A.vector();
    const device_vectors space(q, A.type(), x.size());
    const double start = std::sqrt(space.dot(r, r));
    mg.apply(r, z);
    space.copy(z, p);
    double rz = space.dot(r, z);
    for (int k = 1; k <= 60; ++k)
    {
        A.multiply(p, Ap);
        const double a = rz / space.dot(p, Ap);
        space.axpby(a, p, 1, x);
        space.axpby(-a, Ap, 1, r);
        if (std::sqrt(space.dot(r, r)) <= tolerance * start) return k;
        mg.apply(r, z);
        const double next = space.dot(r, z);
        REQUIRE(next > 0);
        space.axpby(1, z, next / rz, p);
        rz = next;
    }
    return 1000;
}

/// The cycle of two levels against that of a host.
template <class T, class Element>
void check_cycle(const leveled_mesh<Element>& all, int D, lane_form form)
{
    queue q(test::shared_context());
    CAPTURE(D);
    CAPTURE(form.lanes);
    const auto d = std::size_t(D);
    auto mg = elastic(q, scalar_type_of<T>, all, D, form);
    REQUIRE(mg.levels() == 2);
    REQUIRE(mg.solves_coarsest());
    CHECK(mg.launches() == (form.lanes > 1 ? 1 : 8));
    const auto A = dense(mg.matrix());
    test::dense_matrix diagonal(A.size());
    for (std::size_t i = 0; i < A.size(); ++i)
        for (std::size_t j = i / d * d; j < i / d * d + d; ++j) diagonal(i, j) = A(i, j);
    const auto coarse = test::shifted_inverse(dense(mg.matrix(1)), std::is_same_v<T, double> ? 1e-8 : 1e-4, d);
    const host_cycle<Element> cycle{
        A, diagonal.inverse(), coarse, all.steps[0], d, {.lambda_max = double(Element::corners)}};

    auto x = mg.matrix().vector();
    const auto b = image(mg, 1);
    mg.apply(b, x);
    const auto right = b.download(), got = x.download();
    const std::size_t stride = mg.matrix().stride();
    std::vector<double> packed(A.size());
    for (std::size_t i = 0; i < A.size(); ++i) packed[i] = right[i % d * stride + i / d];
    const auto expected = cycle(packed);
    double worst = 0, size = 0;
    for (std::size_t i = 0; i < A.size(); ++i)
    {
        worst = std::max(worst, std::abs(got[i % d * stride + i / d] - expected[i]));
        size = std::max(size, std::abs(expected[i]));
    }
    const double least = Element::dimension == 2 ? 1e-3 : 4e-3;
    CHECK(worst < (std::is_same_v<T, double> ? 1e-7 : least) * size);
}

} // namespace

TEST_CASE_TEMPLATE("multigrid: the cycle is symmetric and positive", T, float, double)
{
    queue q(test::shared_context());
    const auto m = test::grid(test::sized(40, 10), test::sized(30, 9));
    struct shape
    {
        lane_form form;
        bool pinned;
        int D;
    };
    constexpr lane_form narrow{16, 16}, wide{32, 1};
    // The first two have each value of each of the three.
    std::vector<shape> shapes{{narrow, true, 2}, {wide, false, 3}, {narrow, false, 3}, {wide, true, 2},
                              {narrow, true, 3}, {wide, true, 3},  {narrow, false, 2}, {wide, false, 2}};
    shapes.resize(static_cast<std::size_t>(test::sized(8, 2)));
    if (q.device().is_host()) std::erase_if(shapes, [](const shape& s) { return s.form.lanes == 1; });
    for (const shape& s : shapes)
    {
        const lane_form form = s.form;
        if (form.lanes > 1 && !q.device().is_cpu()) continue; // see lane_forms()
        const bool pinned = s.pinned;
        const int D = s.D;
        CAPTURE(D);
        CAPTURE(pinned);
        auto mg = elastic(q, scalar_type_of<T>, m, D, pinned, form);
        CHECK(mg.levels() >= 2);
        CHECK(mg.solves_coarsest());
        const auto u = image(mg, 1), v = image(mg, 2);
        auto Mu = mg.matrix().vector(), Mv = mg.matrix().vector();
        const auto before = q.counters();
        mg.refresh();
        CHECK(q.counters().waits == before.waits);
        const auto refreshed = q.counters().launches;
        mg.apply(u, Mu);
        CHECK(q.counters().launches - refreshed == mg.launches());
        CHECK(q.counters().waits == before.waits);
        mg.apply(v, Mv);
        const device_vectors space(q, scalar_type_of<T>, u.size());
        const double uMv = space.dot(u, Mv), vMu = space.dot(v, Mu), uMu = space.dot(u, Mu), vMv = space.dot(v, Mv);
        CHECK(uMu > 0);
        CHECK(vMv > 0);
        const double eps = std::is_same_v<T, double> ? 1e-9 : 2e-3;
        CHECK(std::abs(uMv - vMu) <= eps * std::sqrt(uMu * vMv));
        if (!pinned) continue;
        const auto host = Mu.download();
        for (std::size_t w = 0; w < m.points().size(); ++w)
            if (m.points()[w].y == 0) REQUIRE(host[w] == 0);
    }
}

TEST_CASE_TEMPLATE("multigrid: the cycle of two levels is that of a host, fused in the form for CPUs, single for GPUs",
                   T, float, double)
{
    for (const lane_form form : test::lane_forms())
    {
        for (const int D : {2, 3}) check_cycle<T>(surface(test::grid(test::sized(10, 9), 9), false), D, form);
        check_cycle<T>(cubes(1, 4, 2, false), 3, form);
    }
}

TEST_CASE("multigrid: conjugate gradients need as many cycles on fine meshes as on coarse ones")
{
    queue q(test::shared_context());
    const auto form = lane_form::for_device(q.device());
    for (const bool pinned : {false, true})
        for (const int D : {2, 3})
            for (const int n : {test::sized(45, 10), test::sized(100, 14), test::sized(224, 18)})
            {
                auto mg = elastic(q, scalar_type::f64, test::grid(n, n), D, pinned, form);
                const int its = solve(q, mg, 1e-8);
                MESSAGE("n ", n, " D ", D, " pinned ", pinned, ": ", its, " iterations, ", mg.levels(), " levels");
                CHECK(its <= 22);
            }
    auto mg = elastic(q, scalar_type::f32, test::grid(test::sized(100, 14), test::sized(100, 14)), 2, true, form);
    CHECK(solve(q, mg, 1e-4) <= 14);
}

TEST_CASE("multigrid: in space, too, fine meshes need as many cycles as coarse ones")
{
    queue q(test::shared_context());
    const auto form = lane_form::for_device(q.device());
    const auto iterations = [&](const leveled_mesh<tetrahedron>& all, bool pinned)
    {
        auto mg = elastic(q, scalar_type::f64, all, 3, form);
        REQUIRE(mg.levels() == all.steps.size() + 1);
        const int n = solve(q, mg, 1e-8);
        MESSAGE("pinned ", pinned, ", ", all.finest.points().size(), " vertices: ", n, " iterations, ", mg.levels(),
                " levels");
        return n;
    };
    for (const bool pinned : {false, true})
    {
        CHECK(iterations(cubes(4, 2, 2, pinned), pinned) <= 16);
        CHECK(iterations(cubes(4, 2, test::sized(3, 2), pinned), pinned) <= 16);
        CHECK(iterations(cubes(2, 3, 2, pinned), pinned) <= 20);
        CHECK(iterations(cubes(2, 3, test::sized(3, 2), pinned), pinned) <= 20);
    }
    auto mg = elastic(q, scalar_type::f32, cubes(2, 3, 2, true), 3, form);
    CHECK(solve(q, mg, 1e-4) <= 16);
}
