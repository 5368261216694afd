// SPDX-License-Identifier: MIT
// Eigen's matrices in and out, as libigl has them; and Newton's method with a solver of one's own on the library's
// energy, gradient and Hessian.
#include <algorithm>
#include <cmath>
#include <iostream>
#include <vector>

#include <Eigen/SparseCholesky>

#include <taut/eigen.hpp>
#include <taut/solve.hpp>
#include <taut/taut.hpp>

/// A bowl of n x n squares: V has a vertex a row, F a triangle.
void make_bowl(int n, Eigen::MatrixXd& V, Eigen::MatrixXi& F)
{
    V.resize((n + 1) * (n + 1), 3);
    F.resize(2 * n * n, 3);
    for (int v = 0; v < V.rows(); ++v)
    {
        const double x = 2.0 * (v % (n + 1)) / n - 1, y = 2.0 * (v / (n + 1)) / n - 1;
        V.row(v) << x, y, x * x + y * y;
    }
    for (int f = 0; f < n * n; ++f)
    {
        const int a = f / n * (n + 1) + f % n, b = a + 1, c = a + n + 1, d = c + 1;
        F.row(2 * f) << a, b, d;
        F.row(2 * f + 1) << a, d, c;
    }
}

int main()
try
{
    Eigen::MatrixXd V;
    Eigen::MatrixXi F;
    make_bowl(10, V, F);

    // [matrices]
    taut::queue queue;
    const auto mesh = taut::mesh_from(V, F);

    const Eigen::Vector2i b(0, 120); // two corners, and where they shall be
    const Eigen::Matrix2d bc{{0, 0}, {3, 3}};
    const auto pinned = taut::parameterize(queue, mesh, {.constraints = taut::constraints_from(mesh, b, bc)});
    if (!pinned) throw taut::error(pinned.reason());
    const Eigen::MatrixXd uv = taut::matrix_of(pinned.uv);
    // [matrices]

    // [newton]
    taut::map_evaluator<taut::triangle> f(queue, mesh, taut::energy::isometric{});
    auto x = taut::points_from<2>(V.leftCols(2));
    std::vector<taut::vec2> g(x.size()), d(x.size());
    double value = f.value_gradient(x, g);
    for (int iteration = 0; iteration < 20; ++iteration)
    {
        Eigen::SparseMatrix<double> H = taut::matrix_of(f.hessian(x, taut::definiteness::projected));
        H.diagonal().array() += 1e-9; // a free map may shift and turn
        const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> solver(H);
        const Eigen::Map<const Eigen::VectorXd> gradient(&g[0].x, H.rows());
        Eigen::Map<Eigen::VectorXd>(&d[0].x, H.rows()) = -solver.solve(gradient);

        auto next = x;
        double a = std::min(1.0, 0.9 * f.max_step(x, d));
        do {
            taut::matrix_of(next) = taut::matrix_of(x) + a * taut::matrix_of(d);
            a /= 2;
        } while (a > 1e-9 && f.value(next) > value);
        x = next;
        value = f.value_gradient(x, g);
    }
    // [newton]

    const auto best = taut::parameterize(queue, mesh);
    const bool exact = uv.row(120) == bc.row(1);
    const bool same = std::abs(value - best.report.solve.value) < 1e-6 * value;
    std::cout << "pins " << (exact ? "exact" : "moved") << ", E " << value << ", "
              << (same ? "as parameterize has it" : "and parameterize has another") << '\n';
    return exact && same ? 0 : 1;
}
catch (const taut::error& e)
{
    std::cerr << e.what() << '\n';
    return 1;
}
