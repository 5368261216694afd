// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include <taut/mesh.hpp>

namespace bench::peer
{

/// Quadratic models of the energy, positive semi-definite element by element.
enum class model
{
    newton, ///< the Hessian with its negative eigenvalue set to zero
    slim    ///< reweighted proxy of Rabinovich et al. 2017: exact in the gradient, along the singular directions
};

/// Lower triangle of a symmetric matrix of 2 x 2 blocks over the vertices, by columns of numbers: what CHOLMOD reads.
struct block_matrix
{
    std::vector<int> column, row; ///< 2 n + 1 offsets; rows in ascending order
    std::vector<double> value;

    int size() const { return static_cast<int>(column.size()) - 1; }
    /// Where column c keeps its diagonal.
    double& diagonal(int c) { return value[static_cast<std::size_t>(column[static_cast<std::size_t>(c)])]; }
};

/// Symmetric Dirichlet energy of a map, mean by rest area, with its derivatives: one thread, double, x and y of a
/// vertex side by side. rank: new number of each vertex, which decides the fill of the factor.
class problem
{
public:
    problem(const taut::mesh<taut::triangle>& m, const std::vector<int>& rank);

    std::size_t numbers() const { return 2 * vertices_; }

    /// Infinite if a triangle is flipped.
    double value(const std::vector<double>& x) const;
    double gradient(const std::vector<double>& x, std::vector<double>& g) const;
    void matrix(const std::vector<double>& x, model kind, block_matrix& h) const;

    /// The matrix with its pattern; fixes where each triangle adds to it.
    block_matrix make_matrix();

    /// The largest a for which no triangle of x + t d flips, t in [0, a).
    double longest_step(const std::vector<double>& x, const std::vector<double>& d) const;

    /// The s for which the energy of s x is least.
    double best_scale(const std::vector<double>& x) const;

    const std::vector<std::array<int, 3>>& corners() const { return corners_; }

private:
    /// Shape functions' gradients of corners 1 and 2 are (p, q) and (0, r); w is the share of the rest area.
    struct rest
    {
        double p, q, r, w;
    };
    /// Where the blocks of edges 01, 12, 20 and of the corners begin in the two columns they lie in.
    struct slots
    {
        std::array<int, 6> left, right;
        std::array<bool, 3> transposed;
    };

    std::size_t vertices_;
    std::vector<std::array<int, 3>> corners_;
    std::vector<rest> rest_;
    std::vector<slots> slots_;
};

} // namespace bench::peer
