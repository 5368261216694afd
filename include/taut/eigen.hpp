// SPDX-License-Identifier: MIT
#include <taut/impl/enter.inl>
#ifndef TAUT_EIGEN_HPP
#define TAUT_EIGEN_HPP

#include <array>
#include <cstddef>
#include <limits>
#include <string>
#include <vector>

#include <Eigen/Core>
#include <Eigen/SparseCore>

#include <taut/arrays.hpp>
#include <taut/constraints.hpp>
#include <taut/impl/core/mesh/arrays.hpp>

/// Meshes, maps, constraints and Hessians as Eigen matrices, in the conventions of libigl. A row of V is a vertex (2 or
/// 3 columns, float or double), a row of F a triangle, a row of T a tetrahedron (any integer type); row- or
/// column-major. Matrices, Map, Ref and blocks are read without a copy. Needs Eigen, so taut.hpp does not include it.
namespace taut::impl
{

/// View of the rows of a matrix; name: of the matrix in messages.
template <int K, class Matrix>
array_view<const typename Matrix::Scalar, K> rows_of(const Eigen::DenseBase<Matrix>& matrix, const char* name)
{
    static_assert((int(Matrix::Flags) & int(Eigen::DirectAccessBit)) != 0,
                  "taut: an expression of Eigen has no memory to read; evaluate it into a matrix first");
    using scalar = typename Matrix::Scalar;
    const Matrix& m = matrix.derived();
    if (m.cols() != K)
        throw parameter_error(name, "has " + std::to_string(m.cols()) + " columns, not " + std::to_string(K));
    return {m.data(), static_cast<std::size_t>(m.rows()), static_cast<std::size_t>(m.rowStride()) * sizeof(scalar),
            static_cast<std::size_t>(m.colStride()) * sizeof(scalar)};
}

template <class Element, class Points, class Cells>
mesh<Element> mesh_of_matrices(const Points& V, const Cells& cells, const char* name)
{
    const auto c = rows_of<Element::corners>(cells, name);
    if (V.cols() == 2) return mesh<Element>(rows_of<2>(V, "V"), c);
    return mesh<Element>(rows_of<3>(V, "V"), c);
}

/// Calls add(constraints, vertex, point) with each entry of b and its row of bc.
template <class Element, class Vertices, class Points, class Add>
constraints<Element> constraints_of_rows(const mesh<Element>& m, const Vertices& b, const Points& bc, const Add& add)
{
    const auto vertices = rows_of<1>(b, "b");
    const auto points = rows_of<Element::dimension>(bc, "bc").points();
    if (points.size() != vertices.rows())
        throw parameter_error("bc", "has " + std::to_string(points.size()) + " rows for " +
                                        std::to_string(vertices.rows()) + " vertices in b");
    constraints<Element> wanted(m);
    for (std::size_t i = 0; i < points.size(); ++i) add(wanted, to_idx(vertices[i][0]), points[i]);
    return wanted;
}

template <class T, int K>
using packed_rows = Eigen::Matrix<T, Eigen::Dynamic, K, Eigen::RowMajor>;

} // namespace taut::impl

namespace taut
{

template <int D>
struct block_rows;

/// Surface mesh of V (#V by 2 or 3 points) and F (#F by 3 vertex indices). Throws parameter_error for another number of
/// columns, mesh_error as the constructor of mesh.
template <class Points, class Cells>
mesh<triangle> mesh_from(const Eigen::DenseBase<Points>& V, const Eigen::DenseBase<Cells>& F)
{
    return impl::mesh_of_matrices<triangle>(V, F, "F");
}

/// Tetrahedral mesh of V (#V by 3 points) and T (#T by 4 vertex indices).
template <class Points, class Cells>
mesh<tetrahedron> volume_from(const Eigen::DenseBase<Points>& V, const Eigen::DenseBase<Cells>& T)
{
    return impl::mesh_of_matrices<tetrahedron>(V, T, "T");
}

/// Points from the rows of a matrix with D columns.
template <int D, class Points>
std::vector<vec<D>> points_from(const Eigen::DenseBase<Points>& X)
{
    return impl::rows_of<D>(X, "X").points();
}

/// Points as a matrix with one row per point. It maps the memory of x without a copy: assign it to your own
/// matrix,
///
///     Eigen::MatrixXd uv = taut::matrix_of(result.uv);
///     mine.leftCols(2) = taut::matrix_of(result.uv).cast<float>();
///
/// or write to it.
template <int D>
Eigen::Map<const impl::packed_rows<double, D>> matrix_of(const std::vector<vec<D>>& x)
{
    return {impl::numbers_of<D>(x).data(), static_cast<Eigen::Index>(x.size()), D};
}
template <int D>
Eigen::Map<impl::packed_rows<double, D>> matrix_of(std::vector<vec<D>>& x)
{
    return {x.empty() ? nullptr : &x[0].x, static_cast<Eigen::Index>(x.size()), D};
}
template <int D>
void matrix_of(const std::vector<vec<D>>&&) = delete; // a temporary would be gone

/// Cells of a mesh as F or T.
template <std::size_t K>
Eigen::Map<const impl::packed_rows<idx, static_cast<int>(K)>> matrix_of(const std::vector<std::array<idx, K>>& cells)
{
    return {cells.empty() ? nullptr : cells[0].data(), static_cast<Eigen::Index>(cells.size()), static_cast<int>(K)};
}
template <std::size_t K>
void matrix_of(const std::vector<std::array<idx, K>>&&) = delete;

/// Numbering of the coordinates of n points in D dimensions as unknowns.
enum class unknown_order
{
    by_point,     ///< coordinate k of point v is D v + k: a row-major matrix, read as one vector
    by_coordinate ///< it is n k + v: a column-major matrix
};

/// A symmetric block matrix, such as map_evaluator::hessian, for Eigen's solvers. Throws size_error if its
/// entries exceed 32-bit numbering.
template <int D>
Eigen::SparseMatrix<double> matrix_of(const block_rows<D>& H, unknown_order order = unknown_order::by_point)
{
    constexpr auto limit = static_cast<std::size_t>(std::numeric_limits<int>::max());
    if (H.blocks.size() > limit / (D * D)) throw size_error("H", "more entries than 32-bit numbers count");
    const auto n = static_cast<int>(H.offsets.size()) - 1;
    const bool by_point = order == unknown_order::by_point;
    Eigen::SparseMatrix<double> matrix(D * n, D * n);
    matrix.resizeNonZeros(static_cast<Eigen::Index>(H.blocks.size()) * D * D);
    int* const begins = matrix.outerIndexPtr();
    int* const rows = matrix.innerIndexPtr();
    double* const values = matrix.valuePtr();
    int used = 0;
    for (int column = 0; column < D * n; ++column)
    {
        // Column (v, k) is row (v, k), for the matrix is symmetric.
        const int v = by_point ? column / D : column % n, k = by_point ? column % D : column / n;
        const auto at = static_cast<std::size_t>(v);
        const int first = H.offsets[at], length = H.offsets[at + 1] - first;
        for (int e = 0; e < D * length; ++e)
        {
            const int block = first + (by_point ? e / D : e % length), i = by_point ? e % D : e / length;
            const auto b = static_cast<std::size_t>(block);
            rows[used] = by_point ? D * H.columns[b] + i : n * i + H.columns[b];
            values[used++] = H.blocks[b][i][k];
        }
        begins[column + 1] = used;
    }
    return matrix;
}

/// Pins of the vertices b at the rows of bc, fixed exactly (as in libigl). Throws parameter_error for another number of
/// rows, constraint_error as constraints::pin does.
template <class Element, class Vertices, class Points>
constraints<Element> constraints_from(const mesh<Element>& m, const Eigen::DenseBase<Vertices>& b,
                                      const Eigen::DenseBase<Points>& bc)
{
    return impl::constraints_of_rows(m, b, bc, [](auto& wanted, idx v, const auto& x) { wanted.pin(v, x); });
}

/// Springs of one weight instead, as libigl's soft_p.
template <class Element, class Vertices, class Points>
constraints<Element> constraints_from(const mesh<Element>& m, const Eigen::DenseBase<Vertices>& b,
                                      const Eigen::DenseBase<Points>& bc, double weight)
{
    return impl::constraints_of_rows(m, b, bc,
                                     [weight](auto& wanted, idx v, const auto& x) { wanted.spring(v, x, weight); });
}
template <class Element, class... Rows>
void constraints_from(mesh<Element>&&, const Rows&...) = delete; // constraints refer to their mesh

} // namespace taut

#endif
#include <taut/impl/leave.inl>
