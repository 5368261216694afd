// SPDX-License-Identifier: MIT
// over_processes: a bar over the processes of mpirun, twisted by a quarter turn. Each process makes its own slices.
#include <cmath>
#include <cstdint>
#include <iostream>

#include <mpi.h>

#include <taut/dist.hpp>

namespace
{

using piece = taut::dist::mesh_piece<taut::tetrahedron>;

/// Slices of a bar of n x n x 4 n cubes, as many as there are for one process of `size`.
piece slices(int n, int rank, int size)
{
    piece p;
    const auto id = [n](int i, int j, int k) { return (std::int64_t{k} * (n + 1) + j) * (n + 1) + i; };
    const int first = 4 * n * rank / size, last = 4 * n * (rank + 1) / size;
    for (int k = first; k <= last; ++k) // the last one is also the neighbour's
        for (int j = 0; j <= n; ++j)
            for (int i = 0; i <= n; ++i)
            {
                p.ids.push_back(id(i, j, k));
                p.points.emplace_back(double(i) / n, double(j) / n, double(k) / n);
            }
    constexpr int orders[6][3] = {{0, 1, 2}, {1, 2, 0}, {2, 0, 1}, {0, 2, 1}, {2, 1, 0}, {1, 0, 2}};
    for (int k = first; k < last; ++k)
        for (int j = 0; j < n; ++j)
            for (int i = 0; i < n; ++i)
                for (int o = 0; o < 6; ++o)
                {
                    int at[3] = {i, j, k};
                    std::array<std::int64_t, 4> cell = {id(i, j, k), 0, 0, 0};
                    for (std::size_t s = 0; s < 3; ++s)
                    {
                        ++at[orders[o][s]];
                        cell[s + 1] = id(at[0], at[1], at[2]);
                    }
                    if (o >= 3) std::swap(cell[1], cell[2]);
                    p.cells.push_back(cell);
                }
    return p;
}

} // namespace

int main(int argc, char** argv)
{
    MPI_Init(&argc, &argv);
    int rank = 0, size = 1, code = 0;
    MPI_Comm_rank(MPI_COMM_WORLD, &rank);
    MPI_Comm_size(MPI_COMM_WORLD, &size);
    try
    {
        // [deform]
        const piece mine = slices(6, rank, size); // ids, points, cells of this process
        taut::dist::constraints<taut::tetrahedron> pins;
        for (std::size_t v = 0; v < mine.ids.size(); ++v)
        {
            const taut::vec3 p = mine.points[v];
            if (p.z == 0) pins.pin(mine.ids[v], p);
            if (p.z == 4) pins.pin(mine.ids[v], {1 - p.y, p.x, p.z}); // a quarter turn
        }
        const auto [x, report] = taut::dist::deform<taut::tetrahedron>(MPI_COMM_WORLD, mine, {.constraints = pins});
        // x: one position for each of mine.ids, certified; the report is the same on all processes
        // [deform]
        if (rank == 0)
            std::cout << report.flips.elements << " tetrahedra, " << report.flips.flipped << " inverted, energy "
                      << report.energy << ", " << (report.converged ? "converged" : "not converged") << '\n';
        code = report.outcome == taut::outcome::valid && x.size() == mine.ids.size() ? 0 : 1;
    }
    catch (const taut::error& e) // all processes come here, with the same text
    {
        if (rank == 0) std::cerr << e.what() << '\n';
        code = 1;
    }
    MPI_Finalize();
    return code;
}
