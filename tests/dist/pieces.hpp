// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <random>
#include <set>
#include <vector>

#include <mpi.h>

#include <support/meshes.hpp>
#include <taut/constraints.hpp>
#include <taut/dist.hpp>
#include <taut/queue.hpp>

namespace taut::test
{

using piece = dist::mesh_piece<tetrahedron>;

/// A queue that tests share, with the kernels that it has built: most of them need no other. Never closed, as drivers
/// may be gone when a program ends.
inline queue& common_queue()
{
    static auto* const q = new queue();
    return *q;
}

/// A communicator of the first `size` processes; MPI_COMM_NULL for the others.
class first_processes
{
public:
    explicit first_processes(int size)
    {
        int rank = 0;
        MPI_Comm_rank(MPI_COMM_WORLD, &rank);
        MPI_Comm_split(MPI_COMM_WORLD, rank < size ? 0 : MPI_UNDEFINED, rank, &comm_);
    }
    ~first_processes()
    {
        if (comm_ != MPI_COMM_NULL) MPI_Comm_free(&comm_);
    }
    first_processes(const first_processes&) = delete;
    first_processes& operator=(const first_processes&) = delete;

    MPI_Comm get() const { return comm_; }
    explicit operator bool() const { return comm_ != MPI_COMM_NULL; }

private:
    MPI_Comm comm_ = MPI_COMM_NULL;
};

inline int rank_of(MPI_Comm comm = MPI_COMM_WORLD)
{
    int rank = 0;
    MPI_Comm_rank(comm, &rank);
    return rank;
}
inline int size_of(MPI_Comm comm = MPI_COMM_WORLD)
{
    int size = 1;
    MPI_Comm_size(comm, &size);
    return size;
}

/// The cells of a mesh dealt to the processes: in blocks, or one after the other; with the vertices that they name, so
/// that many are in several pieces. Ids are the numbers of the mesh times `stride` plus `first`.
struct dealing
{
    bool in_turn = false;
    std::int64_t stride = 1, first = 0;
};
inline piece dealt(MPI_Comm comm, const mesh<tetrahedron>& m, const dealing& how = {})
{
    const auto rank = static_cast<std::size_t>(rank_of(comm)), size = static_cast<std::size_t>(size_of(comm));
    piece p;
    std::set<idx> named;
    const std::size_t n = m.cells().size();
    for (std::size_t c = 0; c < n; ++c)
    {
        if ((how.in_turn ? c % size : c * size / n) != rank) continue;
        std::array<std::int64_t, 4> ids;
        for (std::size_t k = 0; k < 4; ++k)
        {
            named.insert(m.cells()[c][k]);
            ids[k] = how.first + how.stride * m.cells()[c][k];
        }
        p.cells.push_back(ids);
    }
    for (const idx v : named)
    {
        p.ids.push_back(how.first + how.stride * v);
        p.points.push_back(m.points()[static_cast<std::size_t>(v)]);
    }
    return p;
}

/// A bar of n x n x 4 n cubes of six tetrahedra, jittered inside: 1 x 1 x 4.
inline mesh<tetrahedron> bar(int n, unsigned seed = 1)
{
    std::vector<vec3> points;
    std::vector<std::array<idx, 4>> cells;
    const int slices = 4 * n;
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> move(-0.15 / n, 0.15 / n);
    for (int k = 0; k <= slices; ++k)
        for (int j = 0; j <= n; ++j)
            for (int i = 0; i <= n; ++i)
            {
                vec3 p(double(i) / n, double(j) / n, double(k) / n);
                for (int c = 0; c < 3; ++c)
                    if (p[c] > 0 && p[c] < (c == 2 ? 4 : 1)) p[c] += move(random);
                points.push_back(p);
            }
    const auto at = [=](int i, int j, int k) { return static_cast<idx>((k * (n + 1) + j) * (n + 1) + i); };
    constexpr int orders[6][3] = {{0, 1, 2}, {1, 2, 0}, {2, 0, 1}, {0, 2, 1}, {2, 1, 0}, {1, 0, 2}};
    for (int k = 0; k < slices; ++k)
        for (int j = 0; j < n; ++j)
            for (int i = 0; i < n; ++i)
                for (int o = 0; o < 6; ++o)
                {
                    std::array<int, 3> p = {i, j, k};
                    std::array<idx, 4> t{at(i, j, k)};
                    for (std::size_t s = 0; s < 3; ++s)
                    {
                        ++p[static_cast<std::size_t>(orders[o][s])];
                        t[s + 1] = at(p[0], p[1], p[2]);
                    }
                    if (o >= 3) std::swap(t[1], t[2]);
                    cells.push_back(t);
                }
    return {std::move(points), std::move(cells)};
}

/// Pins of the two ends of a bar: one stays, the other goes where `where` says. Given by the first process alone.
template <class Where>
dist::constraints<tetrahedron> ends(MPI_Comm comm, const mesh<tetrahedron>& m, const Where& where,
                                    const dealing& how = {})
{
    dist::constraints<tetrahedron> c;
    if (rank_of(comm) != 0) return c;
    for (std::size_t v = 0; v < m.points().size(); ++v)
    {
        const vec3 p = m.points()[v];
        const auto id = how.first + how.stride * static_cast<std::int64_t>(v);
        if (p.z == 0) c.pin(id, p);
        if (p.z == 4) c.pin(id, where(p));
    }
    return c;
}
template <class Where>
taut::constraints<tetrahedron> serial_ends(const mesh<tetrahedron>& m, const Where& where)
{
    taut::constraints<tetrahedron> c(m);
    for (idx v = 0; v < m.vertex_count(); ++v)
    {
        const vec3 p = m.points()[static_cast<std::size_t>(v)];
        if (p.z == 0) c.pin(v, p);
        if (p.z == 4) c.pin(v, where(p));
    }
    return c;
}

inline vec3 stretched(const vec3& p)
{
    return {p.x, p.y, 1.5 * p.z};
}
/// A turn of the end by an angle about the middle axis of the bar.
inline auto twisted(double angle)
{
    return [c = std::cos(angle), s = std::sin(angle)](const vec3& p)
    {
        const double x = p.x - 0.5, y = p.y - 0.5;
        return vec3(0.5 + c * x - s * y, 0.5 + s * x + c * y, p.z);
    };
}

} // namespace taut::test
