// SPDX-License-Identifier: MIT
#include <cstdint>
#include <utility>
#include <vector>

#include <doctest/doctest.h>

#include <taut/eigen.hpp>
#include <taut/evaluator.hpp>

using namespace taut;
using namespace taut::impl;

namespace
{

template <class T, int Order>
using matrix = Eigen::Matrix<T, Eigen::Dynamic, Eigen::Dynamic, Order>;

template <class Real, class Index, int Order>
struct layout_of
{
    using points = matrix<Real, Order>;
    using cells = matrix<Index, Order>;
};

/// Two triangles in the plane.
template <class Cells = Eigen::MatrixXi>
Cells square_cells()
{
    Cells F(2, 3);
    F << 0, 1, 2, 1, 3, 2;
    return F;
}

Eigen::MatrixXd square_points()
{
    Eigen::MatrixXd V(4, 2);
    V << 0, 0, 1, 0, 0, 1, 1, 1;
    return V;
}

} // namespace

TEST_CASE_TEMPLATE("eigen: matrices of any scalar and order make the same mesh", L,
                   layout_of<double, std::int32_t, Eigen::ColMajor>, layout_of<double, std::int64_t, Eigen::RowMajor>,
                   layout_of<float, std::int64_t, Eigen::ColMajor>, layout_of<float, std::uint32_t, Eigen::RowMajor>)
{
    typename L::points V(4, 3);
    V << 0, 0, 0, 1, 0, 0.5, 0, 1, 0.25, 1, 1, 2;
    const auto m = mesh_from(V, square_cells<typename L::cells>());
    CHECK(m.points() == std::vector<vec3>{{0, 0, 0}, {1, 0, 0.5}, {0, 1, 0.25}, {1, 1, 2}});
    CHECK(m.cells() == std::vector<std::array<idx, 3>>{{0, 1, 2}, {1, 3, 2}});

    typename L::cells T(1, 4);
    T << 0, 1, 2, 3;
    CHECK(volume_from(V, T).cells() == std::vector<std::array<idx, 4>>{{0, 1, 2, 3}});

    const auto planar = mesh_from(V.leftCols(2), square_cells<typename L::cells>()); // a block, not packed
    CHECK(planar.points()[3] == vec3(1, 1, 0));
    CHECK(points_from<2>(V.rightCols(2))[3] == vec2(1, 2));

    CHECK_THROWS_AS(mesh_from(V, T), parameter_error);
    CHECK_THROWS_AS(mesh_from(V.leftCols(1), square_cells<typename L::cells>()), parameter_error);
    T(0, 0) = typename L::cells::Scalar(-1);
    CHECK_THROWS_AS(volume_from(V, T), mesh_error);
}

TEST_CASE("eigen: a matrix of points is their memory")
{
    std::vector<vec2> x = {{1, 2}, {3, 4}, {5, 6}};
    const Eigen::MatrixXd copy = matrix_of(std::as_const(x));
    CHECK(copy(1, 0) == 3);
    CHECK(copy(2, 1) == 6);
    matrix_of(x).col(0) *= 2.0;
    CHECK(x == std::vector<vec2>{{2, 2}, {6, 4}, {10, 6}});

    Eigen::MatrixXf mine = Eigen::MatrixXf::Zero(3, 3);
    mine.leftCols(2) = matrix_of(x).cast<float>();
    CHECK(mine(2, 0) == 10);

    const auto m = mesh_from(square_points(), square_cells());
    CHECK(matrix_of(m.cells()) == square_cells());
    CHECK(matrix_of(m.points()).leftCols(2) == square_points());
}

TEST_CASE("eigen: blocks become a sparse matrix in either order of the unknowns")
{
    // Rows 0 and 1 see each other, row 2 only itself.
    const block_rows<2> H{
        {0, 2, 4, 5},
        {0, 1, 0, 1, 2},
        {mat2(1, 2, 2, 3), mat2(4, 5, 6, 7), mat2(4, 6, 5, 7), mat2(8, 9, 9, 10), mat2(11, 0, 0, 12)}};
    Eigen::MatrixXd expected = Eigen::MatrixXd::Zero(6, 6);
    for (int r = 0; r < 3; ++r)
        for (int k = H.offsets[static_cast<std::size_t>(r)]; k < H.offsets[static_cast<std::size_t>(r) + 1]; ++k)
            for (int i = 0; i < 2; ++i)
                for (int j = 0; j < 2; ++j)
                    expected(2 * r + i, 2 * H.columns[static_cast<std::size_t>(k)] + j) =
                        H.blocks[static_cast<std::size_t>(k)][j][i];
    CHECK(Eigen::MatrixXd(matrix_of(H)) == expected);

    Eigen::MatrixXd moved(6, 6);
    for (int a = 0; a < 6; ++a)
        for (int b = 0; b < 6; ++b) moved(3 * (a % 2) + a / 2, 3 * (b % 2) + b / 2) = expected(a, b);
    const auto by_coordinate = matrix_of(H, unknown_order::by_coordinate);
    CHECK(Eigen::MatrixXd(by_coordinate) == moved);
    CHECK(by_coordinate.isCompressed());
    for (int c = 0; c < 6; ++c) // entries of a column ascend, as solvers want them
    {
        int last = -1;
        for (Eigen::SparseMatrix<double>::InnerIterator it(by_coordinate, c); it; ++it)
        {
            CHECK(it.row() > last);
            last = static_cast<int>(it.row());
        }
    }
}

TEST_CASE("eigen: indices and positions make pins or springs")
{
    const auto m = mesh_from(square_points(), square_cells());
    const Eigen::Vector2i b(3, 0);
    Eigen::Matrix2d bc;
    bc << 0.1, 0.2, 0.3, 0.4;
    const auto pins = constraints_from(m, b, bc);
    CHECK(pins.pins().at(3).value == vec2(0.1, 0.2));
    CHECK(pins.pins().at(0).value == vec2(0.3, 0.4));
    const auto springs = constraints_from(m, b, bc, 5.0).springs();
    REQUIRE(springs.size() == 2);
    CHECK(springs[0].target == vec2(0.3, 0.4));
    CHECK(springs[1].weight == 5.0);

    CHECK_THROWS_AS(constraints_from(m, b, bc.topRows(1)), parameter_error);
    CHECK_THROWS_AS(constraints_from(m, Eigen::Vector2i(1, 4), bc), constraint_error);
    CHECK_THROWS_AS(constraints_from(m, Eigen::Vector2i(1, 1), bc), constraint_error);
}
