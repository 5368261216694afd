// SPDX-License-Identifier: MIT
#include <cmath>
#include <limits>

#include <doctest/doctest.h>

#include <support/dense_matrix.hpp>
#include <support/meshes.hpp>
#include <taut/impl/core/sparse/cell_pattern.hpp>
#include <taut/impl/core/sparse/dense_inverse.hpp>

#include "support/device.hpp"
#include "support/lane_forms.hpp"
#include <support/shared_context.hpp>

using namespace taut;
using namespace taut::impl;

namespace
{

/// Values of a symmetric, diagonally dominant matrix of random blocks.
std::vector<double> dominant_blocks(scalar_type type, const block_pattern& p, std::size_t d)
{
    std::vector<double> values(p.columns.size() * d * d, 0.0);
    const auto random = test::random_values<double>(values.size(), 11);
    for (std::size_t r = 0; r < p.rows(); ++r)
        for (std::size_t j = 0; j < p.length(r); ++j)
        {
            const auto c = static_cast<std::size_t>(p.column(r, j));
            if (c < r) continue;
            const std::size_t here = p.place(r, j), there = p.place(c, p.find(c, static_cast<taut::idx>(r)));
            for (std::size_t a = 0; a < d; ++a)
                for (std::size_t b = r == c ? a : 0; b < d; ++b)
                {
                    const double value = r == c && a == b ? 9 + double(r % 4)
                                                          : test::as_real(type, 0.3 * random[here * d * d + a * d + b]);
                    values[here * d * d + a * d + b] = values[there * d * d + b * d + a] = value;
                }
        }
    return values;
}

/// The rows of a block matrix that are in the list, as a dense one.
test::dense_matrix dense(const block_pattern& p, std::size_t d, const std::vector<double>& values,
                         const std::vector<taut::idx>& rows)
{
    test::dense_matrix A(rows.size() * d);
    for (std::size_t r = 0; r < rows.size(); ++r)
        for (std::size_t c = 0; c < rows.size(); ++c)
        {
            const auto row = static_cast<std::size_t>(rows[r]);
            const std::size_t j = p.find(row, rows[c]);
            if (j >= p.length(row)) continue;
            for (std::size_t e = 0; e < d * d; ++e)
                A(r * d + e / d, c * d + e % d) = static_cast<long double>(values[p.place(row, j) * d * d + e]);
        }
    return A;
}

} // namespace

TEST_CASE_TEMPLATE("dense inverse: that of the host, in the form for CPUs and in that for GPUs", T, float, double)
{
    queue q(test::shared_context());
    const auto m = test::flat_disk(test::sized(6, 2));
    const auto n = static_cast<taut::idx>(m.points().size());
    std::vector<taut::idx> rows;
    for (taut::idx v = 0; v < n; ++v)
        if (v % 5 != 3) rows.push_back(v);
    for (const lane_form form : test::lane_forms())
        for (const int D : {2, 3})
        {
            CAPTURE(D);
            CAPTURE(form.lanes);
            const auto d = static_cast<std::size_t>(D);
            block_matrix A(q, scalar_type_of<T>, pattern_of_cells(m.cells(), m.points().size(), form.slice), D, form);
            const auto p = A.pattern();
            auto values = dominant_blocks(A.type(), p, d);
            // An unknown that the matrix does not see.
            for (std::size_t j = 0; j < p.length(2); ++j)
            {
                const auto c = static_cast<std::size_t>(p.column(2, j));
                for (std::size_t e = 0; e < d; ++e)
                    values[p.place(2, j) * d * d + e] = values[p.place(c, p.find(c, 2)) * d * d + e * d] = 0;
            }
            A.upload(values);
            impl::dense_inverse inverse(A, rows);
            CHECK(static_cast<std::size_t>(inverse.size()) == rows.size() * d);
            inverse.refresh(A);

            const double shift = std::is_same_v<T, double> ? 1e-8 : 1e-4;
            const auto X = test::shifted_inverse(dense(p, d, values, rows), shift);
            const auto random = test::random_reals(A.type(), d * A.rows(), 5);
            std::vector<double> b(d * A.stride(), 0.0);
            for (std::size_t c = 0, k = 0; c < d; ++c)
                for (std::size_t r = 0; r < A.rows(); ++r) b[c * A.stride() + r] = random[k++];
            auto right = A.vector(), x = A.vector();
            right.upload(b);
            x.data().fill(7);
            inverse.apply(right, x);

            std::vector<double> packed;
            for (const taut::idx r : rows)
                for (std::size_t c = 0; c < d; ++c) packed.push_back(b[c * A.stride() + static_cast<std::size_t>(r)]);
            const auto solution = X * packed;
            std::vector<double> expected(d * A.stride(), 7.0); // other places stay as they are
            for (std::size_t k = 0; k < rows.size(); ++k)
                for (std::size_t c = 0; c < d; ++c)
                    expected[c * A.stride() + static_cast<std::size_t>(rows[k])] = solution[k * d + c];
            const auto got = x.download();
            double worst = 0;
            for (std::size_t i = 0; i < got.size(); ++i) worst = std::max(worst, std::abs(got[i] - expected[i]));
            CHECK(worst < (std::is_same_v<T, double> ? 1e-13 : 1e-5));
            CHECK(got[2] == 0);
        }
}

TEST_CASE_TEMPLATE("dense inverse: a translation that the matrix does not see has little part in the answer", T, float,
                   double)
{
    queue q(test::shared_context());
    const auto m = test::flat_disk(test::sized(4, 2));
    const std::size_t n = m.points().size();
    std::vector<taut::idx> rows(n);
    for (std::size_t v = 0; v < n; ++v) rows[v] = static_cast<taut::idx>(v);
    for (const lane_form form : test::lane_forms())
        for (const int D : {2, 3})
        {
            CAPTURE(D);
            CAPTURE(form.lanes);
            const auto d = static_cast<std::size_t>(D);
            block_matrix A(q, scalar_type_of<T>, pattern_of_cells(m.cells(), n, form.slice), D, form);
            const auto p = A.pattern();
            // Springs along edges; component 0 is held by nothing, the others at vertex 7.
            std::vector<double> values(p.columns.size() * d * d, 0.0);
            const auto entry = [&](std::size_t r, std::size_t c, std::size_t k) -> double&
            { return values[p.place(r, p.find(r, static_cast<taut::idx>(c))) * d * d + k * d + k]; };
            for (std::size_t r = 0; r < n; ++r)
                for (std::size_t j = 0; j < p.length(r); ++j)
                    for (std::size_t k = 0; k < d; ++k)
                    {
                        const auto c = static_cast<std::size_t>(p.column(r, j));
                        if (c == r) continue;
                        const double stiffness = 1 + double((r + c + k) % 3);
                        entry(r, c, k) = -stiffness;
                        entry(r, r, k) += stiffness;
                    }
            for (std::size_t k = 1; k < d; ++k) entry(7, 7, k) += 4;
            A.upload(values);
            impl::dense_inverse inverse(A, rows);
            inverse.refresh(A);

            const double shift = std::is_same_v<T, double> ? 1e-8 : 1e-4;
            const auto X = test::shifted_inverse(dense(p, d, values, rows), shift, d);
            auto packed = test::random_reals(A.type(), d * n, 5);
            std::vector<double> b(d * A.stride(), 0.0);
            for (std::size_t r = 0; r < n; ++r)
                for (std::size_t c = 0; c < d; ++c) b[c * A.stride() + r] = packed[r * d + c];
            auto right = A.vector(), x = A.vector();
            right.upload(b);
            inverse.apply(right, x);

            const auto expected = X * packed;
            const auto got = x.download();
            double worst = 0, size = 0;
            for (std::size_t r = 0; r < n; ++r)
                for (std::size_t c = 0; c < d; ++c)
                {
                    worst = std::max(worst, std::abs(got[c * A.stride() + r] - expected[r * d + c]));
                    size = std::max(size, std::abs(expected[r * d + c]));
                }
            CHECK(size < 1 / shift); // what the shift alone would answer
            CHECK(worst < (std::is_same_v<T, double> ? 1e-7 : 1e-2) * size);
        }
}

TEST_CASE_TEMPLATE("dense inverse: what is not finite or not positive is taken out, and the rest is finite", T, float,
                   double)
{
    queue q(test::shared_context());
    const auto m = test::grid(3, 3);
    std::vector<taut::idx> rows(m.points().size());
    for (std::size_t v = 0; v < rows.size(); ++v) rows[v] = static_cast<taut::idx>(v);
    for (const lane_form form : test::lane_forms())
        for (const double bad :
             {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity(), -1.0, 0.0})
        {
            CAPTURE(form.lanes);
            CAPTURE(bad);
            block_matrix A(q, scalar_type_of<T>, pattern_of_cells(m.cells(), m.points().size(), form.slice), 2, form);
            auto values = dominant_blocks(A.type(), A.pattern(), 2);
            values[A.pattern().place(5, 0) * 4] = bad; // of the first unknown of row 5 with itself
            A.upload(values);
            impl::dense_inverse inverse(A, rows);
            inverse.refresh(A);
            auto b = A.vector(), x = A.vector();
            b.data().fill(1);
            inverse.apply(b, x);
            const auto got = x.download();
            for (std::size_t r = 0; r < A.rows(); ++r)
            {
                CHECK(std::isfinite(got[r]));
                CHECK(std::isfinite(got[A.stride() + r]));
                if (r != 5) CHECK(got[r] != 0);
            }
            CHECK(got[5] == 0);
        }
}
