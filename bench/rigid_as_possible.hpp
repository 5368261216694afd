// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <stdexcept>
#include <utility>
#include <vector>

#include <Eigen/Dense>
#include <Eigen/Sparse>
#include <Eigen/SparseCholesky>

#include <taut/constraints.hpp>
#include <taut/shell.hpp>

namespace bench
{

/// As-rigid-as-possible deformation (Sorkine, Alexa 2007), to compare with: edges of spokes with cotangent weights, one
/// factorization, local and global steps by turns.
class rigid_as_possible
{
public:
    struct result
    {
        std::vector<taut::vec3> x;
        int iterations = 0;
    };

    rigid_as_possible(const taut::mesh<taut::triangle>& m, const taut::constraints<taut::hinge>& pins) : mesh_(m)
    {
        const std::size_t n = m.points().size();
        number_.assign(n, -1);
        place_ = m.points();
        int free = 0;
        for (std::size_t v = 0; v < n; ++v)
        {
            const auto pin = pins.pins().find(static_cast<taut::idx>(v));
            if (pin == pins.pins().end())
                number_[v] = free++;
            else
                place_[v] = pin->second.value;
        }
        std::vector<Eigen::Triplet<double>> entries;
        edges_.resize(n);
        for (const auto& t : m.cells())
            for (std::size_t k = 0; k < 3; ++k)
            {
                const auto i = static_cast<std::size_t>(t[k]), j = static_cast<std::size_t>(t[(k + 1) % 3]),
                           o = static_cast<std::size_t>(t[(k + 2) % 3]);
                const taut::vec3 a = m.points()[i] - m.points()[o], b = m.points()[j] - m.points()[o];
                // Obtuse angles count little, or stars turn over.
                const double w = std::max(0.5 * glm::dot(a, b) / glm::length(glm::cross(a, b)), 0.01);
                edges_[i].push_back({j, w});
                edges_[j].push_back({i, w});
            }
        for (std::size_t v = 0; v < n; ++v)
            for (const auto& [w, weight] : edges_[v])
            {
                if (number_[v] < 0) continue;
                entries.emplace_back(number_[v], number_[v], weight);
                if (number_[w] >= 0) entries.emplace_back(number_[v], number_[w], -weight);
            }
        Eigen::SparseMatrix<double> L(free, free);
        L.setFromTriplets(entries.begin(), entries.end());
        solver_.compute(L);
        if (solver_.info() != Eigen::Success) throw std::runtime_error("the Laplacian is not positive definite");
    }

    /// From the shape at rest with the pins at their places, until no vertex moves by more than `tolerance`.
    result solve(double tolerance, int most) const
    {
        result r{place_, 0};
        double moved = tolerance + 1;
        while (moved > tolerance && r.iterations < most)
        {
            ++r.iterations;
            moved = step(r.x);
        }
        return r;
    }

private:
    double step(std::vector<taut::vec3>& x) const
    {
        using mat = Eigen::Matrix3d;
        const std::size_t n = x.size();
        std::vector<mat> turns(n);
        const auto edge = [](const std::vector<taut::vec3>& p, std::size_t a, std::size_t b)
        { return Eigen::Vector3d(p[b].x - p[a].x, p[b].y - p[a].y, p[b].z - p[a].z); };
        for (std::size_t v = 0; v < n; ++v)
        {
            mat S = mat::Zero();
            for (const auto& [w, weight] : edges_[v])
                S += weight * edge(mesh_.points(), v, w) * edge(x, v, w).transpose();
            const Eigen::JacobiSVD<mat> svd(S, Eigen::ComputeFullU | Eigen::ComputeFullV);
            mat V = svd.matrixV();
            if ((V * svd.matrixU().transpose()).determinant() < 0) V.col(2) *= -1;
            turns[v] = V * svd.matrixU().transpose();
        }
        Eigen::MatrixXd right = Eigen::MatrixXd::Zero(solver_.rows(), 3);
        for (std::size_t v = 0; v < n; ++v)
        {
            if (number_[v] < 0) continue;
            for (const auto& [w, weight] : edges_[v])
            {
                Eigen::Vector3d b = -0.5 * weight * (turns[v] + turns[w]) * edge(mesh_.points(), v, w);
                if (number_[w] < 0) b += weight * Eigen::Vector3d(x[w].x, x[w].y, x[w].z);
                right.row(number_[v]) += b.transpose();
            }
        }
        const Eigen::MatrixXd found = solver_.solve(right);
        double moved = 0;
        for (std::size_t v = 0; v < n; ++v)
        {
            if (number_[v] < 0) continue;
            const taut::vec3 p(found(number_[v], 0), found(number_[v], 1), found(number_[v], 2));
            moved = std::max(moved, glm::distance(p, x[v]));
            x[v] = p;
        }
        return moved;
    }

    const taut::mesh<taut::triangle>& mesh_;
    std::vector<int> number_; ///< of free vertices; -1: pinned
    std::vector<taut::vec3> place_;
    std::vector<std::vector<std::pair<std::size_t, double>>> edges_; ///< of each vertex: the other end, the weight
    Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> solver_;
};

} // namespace bench
