// SPDX-License-Identifier: MIT
#include <array>
#include <cmath>
#include <random>

#include <doctest/doctest.h>

#include <support/meshes.hpp>
#include <taut/impl/core/sparse/block_assembly.hpp>
#include <taut/impl/core/sparse/block_transfer.hpp>

#include "support/device.hpp"
#include "support/lane_forms.hpp"
#include <support/shared_context.hpp>

using namespace taut;
using namespace taut::impl;
using taut::test::random_reals;

namespace
{

/// A mesh whose pole meets many cells, so that rows differ much in length.
mesh<triangle> test_mesh()
{
    auto m = test::flat_disk(test::sized(17, 6));
    return m;
}

/// A plain host product of values by place of the pattern.
std::vector<double> host_product(const block_pattern& p, std::size_t D, std::size_t stride,
                                 const std::vector<double>& A, const std::vector<double>& x)
{
    std::vector<double> y(D * stride, 0.0);
    for (std::size_t r = 0; r < p.rows(); ++r)
        for (std::size_t j = 0; j < p.length(r); ++j)
            for (std::size_t a = 0; a < D; ++a)
                for (std::size_t b = 0; b < D; ++b)
                    y[a * stride + r] +=
                        A[p.place(r, j) * D * D + a * D + b] * x[b * stride + std::size_t(p.column(r, j))];
    return y;
}

/// Random values on the rows of a vector, zero padding.
device_vector random_vector(const block_matrix& A, unsigned seed, std::vector<double>& host)
{
    const auto values = random_reals(A.type(), std::size_t(A.block_size()) * A.rows(), seed);
    host.assign(std::size_t(A.block_size()) * A.stride(), 0.0);
    for (std::size_t c = 0, k = 0; c < std::size_t(A.block_size()); ++c)
        for (std::size_t r = 0; r < A.rows(); ++r) host[c * A.stride() + r] = values[k++];
    auto v = A.vector();
    v.upload(host);
    return v;
}

double difference(const std::vector<double>& a, const std::vector<double>& b)
{
    REQUIRE(a.size() == b.size());
    double most = 0;
    for (std::size_t i = 0; i < a.size(); ++i)
    {
        const double d = std::abs(a[i] - b[i]);
        most = d <= most ? most : d; // NaN wins
    }
    return most;
}

template <class T>
constexpr double tolerance = std::is_same_v<T, double> ? 1e-12 : 2e-4;

/// Random blocks of the nonzeros, and 0 where there is none.
std::vector<double> random_blocks(scalar_type type, const block_pattern& p, std::size_t d, unsigned seed)
{
    auto values = random_reals(type, p.columns.size() * d * d, seed);
    std::vector<char> used(p.columns.size(), 0);
    for (std::size_t r = 0; r < p.rows(); ++r)
        for (std::size_t j = 0; j < p.length(r); ++j) used[p.place(r, j)] = 1;
    for (std::size_t k = 0; k < values.size(); ++k)
        if (!used[k / (d * d)]) values[k] = 0;
    return values;
}

/// Interpolation from every third vertex: rows of one to K weights, which sum to 1, at random places near by.
template <std::size_t K>
struct some_weights
{
    explicit some_weights(std::size_t rows)
    {
        coarse = (rows + 2) / 3;
        std::mt19937 rng(K);
        for (std::size_t i = 0; i < rows; ++i)
        {
            std::array<taut::idx, K> c;
            for (std::size_t k = 0, next = i / 3; k < K; ++k, next += 1 + rng() % 3) c[k] = taut::idx(next % coarse);
            std::array<double, K> w{};
            double sum = 0;
            for (std::size_t k = 0; k <= i % K; ++k) sum += w[k] = 1 + double(rng() % 8);
            for (double& x : w) x /= sum;
            columns.push_back(c);
            weights.push_back(w);
        }
    }
    transfer_weights view(std::span<const char> fixed = {}) const
    {
        return transfer_weights::of_rows(columns, weights, coarse, fixed);
    }

    std::size_t coarse;
    std::vector<std::array<taut::idx, K>> columns;
    std::vector<std::array<double, K>> weights;
};

/// Cells of K vertices that lie within a few dozen of each other.
template <std::size_t K>
std::vector<std::array<taut::idx, K>> random_cells(std::size_t rows)
{
    std::mt19937 rng(1);
    std::vector<std::array<taut::idx, K>> cells(rows);
    for (std::size_t c = 0; c < rows; ++c)
        for (std::size_t k = 0, next = c; k < K; ++k, next += 1 + rng() % 9) cells[c][k] = taut::idx(next % rows);
    return cells;
}

/// Restriction, prolongation and the coarse matrix against loops on the host.
template <class T, std::size_t K>
void check_transfers(const std::vector<std::array<taut::idx, K>>& cells, std::size_t n, int D)
{
    queue q(test::shared_context());
    const some_weights<K> P(n);
    std::vector<char> fixed(P.coarse, 0);
    fixed[2] = 1;
    const auto d = std::size_t(D);
    for (const lane_form form : test::lane_forms())
    {
        CAPTURE(D);
        CAPTURE(K);
        CAPTURE(form.lanes);
        const auto view = P.view(fixed);
        block_matrix A(q, scalar_type_of<T>, pattern_of_cells(cells, n, form.slice), D, form);
        block_matrix B(q, scalar_type_of<T>, pattern_of_product(A.pattern(), view), D, form);
        const auto values = random_blocks(A.type(), A.pattern(), d, 4);
        A.upload(values);
        const block_transfer transfer(A, view, B);
        transfer.refresh(A, B);
        std::vector<double> expected(B.pattern().columns.size() * d * d, 0.0);
        for (std::size_t i = 0; i < n; ++i)
            for (std::size_t j = 0; j < A.pattern().length(i); ++j)
                for (std::size_t k = 0; k < K; ++k)
                    for (std::size_t l = 0; l < K; ++l)
                    {
                        const auto c = std::size_t(A.pattern().column(i, j));
                        const double w = view.weight(i, k) * view.weight(c, l);
                        if (w == 0) continue;
                        const auto I = std::size_t(P.columns[i][k]);
                        const std::size_t at = B.pattern().find(I, P.columns[c][l]);
                        REQUIRE(at < B.pattern().length(I));
                        for (std::size_t e = 0; e < d * d; ++e)
                            expected[B.pattern().place(I, at) * d * d + e] +=
                                w * values[A.pattern().place(i, j) * d * d + e];
                    }
        CHECK(difference(B.download(), expected) < tolerance<T>);

        // Restriction with its first smoothing step, then prolongation.
        B.invert_diagonal();
        std::vector<double> hr, hx, hc;
        const auto r = random_vector(A, 1, hr), coarse = random_vector(B, 2, hc);
        auto b = B.vector(), y = B.vector(), y2 = B.vector(), x = random_vector(A, 3, hx);
        transfer.restrict_residual(r, B, 0.5, b, y);
        std::vector<double> hb(d * B.stride(), 0.0), hp = hx;
        for (std::size_t i = 0; i < n; ++i)
            for (std::size_t k = 0; k < K; ++k)
                for (std::size_t c = 0; c < d; ++c)
                {
                    const auto I = std::size_t(P.columns[i][k]);
                    hb[c * B.stride() + I] += view.weight(i, k) * hr[c * A.stride() + i];
                    hp[c * A.stride() + i] += view.weight(i, k) * hc[c * B.stride() + I];
                }
        CHECK(difference(b.download(), hb) < tolerance<T>);
        B.jacobi(b, 0.5, y2);
        CHECK(difference(y.download(), y2.download()) == 0);
        transfer.prolong(coarse, x);
        CHECK(difference(x.download(), hp) < tolerance<T>);
    }
}

/// P' A P for P = 1. A has a fan about a vertex, whose row is as long, for each of `rims`, and a strip apart from them.
template <class T, std::size_t K>
void check_identity(const std::vector<taut::idx>& rims, const std::vector<int>& sizes)
{
    constexpr taut::idx strip = 220;
    std::vector<std::array<taut::idx, K>> cells;
    taut::idx n = 0;
    const auto add = [&](taut::idx first, taut::idx next)
    {
        std::array<taut::idx, K> cell{first};
        for (std::size_t k = 1; k < K; ++k) cell[k] = next++;
        cells.push_back(cell);
    };
    for (const taut::idx rim : rims)
    {
        const taut::idx hub = n;
        for (taut::idx v = 1; v + taut::idx(K) - 2 <= rim; ++v) add(hub, hub + v);
        n += rim + 1;
    }
    for (taut::idx v = 0; v + taut::idx(K) <= strip; ++v) add(n + v, n + v + 1);
    n += strip;
    std::vector<std::array<taut::idx, K>> columns;
    for (taut::idx v = 0; v < n; ++v) columns.emplace_back().fill(v);
    const std::vector<std::array<double, K>> weights(columns.size(), {1});
    const auto identity = transfer_weights::of_rows(columns, weights, columns.size());
    queue q(test::shared_context());
    for (const lane_form form : test::lane_forms())
        for (const int D : sizes)
        {
            block_matrix A(q, scalar_type_of<T>, pattern_of_cells(cells, columns.size(), form.slice), D, form);
            block_matrix B(q, scalar_type_of<T>, pattern_of_product(A.pattern(), identity), D, form);
            const auto values = random_blocks(A.type(), A.pattern(), std::size_t(D), 7);
            A.upload(values);
            block_transfer(A, identity, B).refresh(A, B);
            const auto product = B.download();
            double most = 0;
            const auto d = std::size_t(D * D);
            for (std::size_t r = 0; r < columns.size(); ++r)
                for (std::size_t j = 0; j < A.pattern().length(r); ++j)
                {
                    const std::size_t at = B.pattern().find(r, A.pattern().column(r, j));
                    REQUIRE(at < B.pattern().length(r));
                    for (std::size_t e = 0; e < d; ++e)
                        most = std::max(most, std::abs(product[B.pattern().place(r, at) * d + e] -
                                                       values[A.pattern().place(r, j) * d + e]));
                }
            CHECK(most < tolerance<T>);
        }
}

} // namespace

TEST_CASE_TEMPLATE("block sparse: products, residuals and smoothing steps are those of a host loop", T, float, double)
{
    queue q(test::shared_context());
    const auto m = test_mesh();
    for (const lane_form form : test::lane_forms())
        for (const int D : {2, 3})
        {
            CAPTURE(D);
            CAPTURE(form.lanes);
            const auto d = std::size_t(D);
            block_matrix A(q, scalar_type_of<T>, pattern_of_cells(m.cells(), m.points().size(), form.slice), D, form);
            const auto p = A.pattern();
            std::size_t nonzeros = 0;
            for (std::size_t r = 0; r < p.rows(); ++r) nonzeros += p.length(r);
            CHECK(nonzeros == std::size_t(m.points().size()) + 2 * (m.points().size() + m.cells().size() - 1));
            auto values = random_blocks(A.type(), p, d, 5);
            // Diagonal blocks: symmetric and positive, one of them of rank one, one zero.
            for (std::size_t r = 0; r < p.rows(); ++r)
                for (std::size_t a = 0; a < d; ++a)
                    for (std::size_t b = 0; b < d; ++b)
                        values[p.place(r, 0) * d * d + a * d + b] = r == 3   ? 0
                                                                    : r == 2 ? 1
                                                                    : a == b ? 3 + double(r % 3)
                                                                             : 0.5;
            A.upload(values);
            CHECK(difference(A.download(), values) == 0);
            A.forget_pattern();
            CHECK(A.pattern().columns == p.columns);
            std::vector<double> hx, hb, hz;
            const auto x = random_vector(A, 1, hx), b = random_vector(A, 2, hb), z = random_vector(A, 3, hz);
            auto y = A.vector();
            A.multiply(x, y);
            const auto Ax = host_product(p, d, A.stride(), values, hx);
            CHECK(difference(y.download(), Ax) < 20 * tolerance<T>);
            A.residual(x, b, y);
            auto r = Ax;
            for (std::size_t i = 0; i < r.size(); ++i) r[i] = hb[i] - Ax[i];
            CHECK(difference(y.download(), r) < 20 * tolerance<T>);

            A.invert_diagonal();
            A.jacobi(b, 1, y);
            const auto solved = y.download();
            for (const double v : solved) REQUIRE(std::isfinite(v));
            for (std::size_t row = 4; row < p.rows(); ++row)
                for (std::size_t a = 0; a < d; ++a)
                {
                    double back = 0;
                    for (std::size_t c = 0; c < d; ++c)
                        back += values[p.place(row, 0) * d * d + a * d + c] * solved[c * A.stride() + row];
                    REQUIRE(back == doctest::Approx(hb[a * A.stride() + row])
                                        .scale(1)
                                        .epsilon(std::is_same_v<T, double> ? 1e-9 : 1e-4));
                }
            for (std::size_t c = 0; c < d; ++c) CHECK(solved[c * A.stride() + 3] == 0);

            // smooth() against its parts.
            auto rest = A.vector(), correction = A.vector(), out = A.vector();
            A.residual(x, b, rest);
            A.jacobi(rest, 0.7, correction);
            out.data().copy_from(z.data());
            A.smooth(b, x, out, 1.25, -0.25, 0.7, out);
            auto expected = correction.download();
            for (std::size_t i = 0; i < expected.size(); ++i)
                if (i % A.stride() != 2) expected[i] += 1.25 * hx[i] - 0.25 * hz[i];
            auto got = out.download();
            // Row 2 is singular: its inverse magnifies rounding.
            for (std::size_t c = 0; c < d; ++c) got[c * A.stride() + 2] = expected[c * A.stride() + 2];
            CHECK(difference(got, expected) < tolerance<T>);
        }
}

TEST_CASE_TEMPLATE("block sparse: element blocks are summed into place, transposed below, fixed rows left out", T,
                   float, double)
{
    queue q(test::shared_context());
    const auto m = test_mesh();
    const std::size_t n = m.points().size(), cells = m.cells().size(), stride = padded(cells, 256);
    std::vector<char> fixed(n, 0);
    fixed[1] = fixed[n - 1] = 1;
    for (const lane_form form : test::lane_forms())
        for (const int D : {2, 3})
        {
            const auto d = std::size_t(D);
            block_matrix A(q, scalar_type_of<T>, pattern_of_cells(m.cells(), n, form.slice), D, form);
            const auto host = random_reals(A.type(), (3 * d * (d + 1) / 2 + 3 * d * d) * stride, 9);
            const real_buffer blocks(q, A.type(), host);
            const block_assembly assembly(A, {A.pattern(), D, m.cells(), stride, fixed});
            assembly(blocks, A);
            std::vector<double> expected(A.pattern().columns.size() * d * d, 0.0);
            for (std::size_t cell = 0; cell < cells; ++cell)
                for (std::size_t k = 0, slot = 0; k < 3; ++k)
                    for (std::size_t l = k; l < 3; ++l)
                        for (std::size_t a = 0; a < d; ++a)
                            for (std::size_t b = k == l ? a : 0; b < d; ++b, ++slot)
                            {
                                const auto v = std::size_t(m.cells()[cell][k]), w = std::size_t(m.cells()[cell][l]);
                                if (fixed[v] || fixed[w]) continue;
                                const auto& p = A.pattern();
                                const std::size_t vw = p.place(v, p.find(v, taut::idx(w))),
                                                  wv = p.place(w, p.find(w, taut::idx(v)));
                                const double value = host[slot * stride + cell];
                                expected[vw * d * d + a * d + b] += value;
                                if (k != l || a != b) expected[wv * d * d + b * d + a] += value;
                            }
            CHECK(difference(A.download(), expected) < tolerance<T>);
            CHECK_THROWS_AS(assembly(real_buffer(q, A.type(), 10), A), parameter_error);

            // A second matrix shares the lists, not the values.
            auto B = A.like();
            CHECK(difference(B.download(), std::vector<double>(expected.size())) == 0);
            assembly(blocks, B);
            A.values().fill(0);
            CHECK(difference(B.download(), expected) < tolerance<T>);
            CHECK_THROWS_AS(B.inverse(), parameter_error);
            B.invert_diagonal();
            CHECK(B.inverse().size() == A.inverse().size());
        }
}

TEST_CASE_TEMPLATE("block sparse: transfers and the coarse matrix are those of a host loop", T, float, double)
{
    const auto m = test_mesh();
    check_transfers<T>(m.cells(), m.points().size(), 2);
    check_transfers<T>(m.cells(), m.points().size(), 3);
    const auto n = std::size_t(test::sized(500, 100));
    check_transfers<T>(random_cells<3>(n), n, 2);
    check_transfers<T>(random_cells<4>(n), n, 3);
}

TEST_CASE_TEMPLATE("block sparse: the product with the identity is the matrix, rows of many nonzeros included", T,
                   float, double)
{
    // Rows of at most 64 or 256 nonzeros, for three and four corners, have colours for all of them.
    check_identity<T, 3>({50, 80}, {2, 3});
    check_identity<T, 4>({50, 200, 300}, {3});
}
