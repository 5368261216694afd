// SPDX-License-Identifier: MIT
// Charts of the plane, packed into tiles.
#include <memory>

#include <taut/pack.hpp>

#include "bindings.hpp"
#include "call.hpp"
#include "reports.hpp"

namespace taut::python
{

namespace
{

/// Charts in the order that the packer takes: triangles of one chart after the other, and so their vertices.
struct pack_job
{
    std::vector<vec2> uv;
    std::vector<std::array<idx, 3>> cells;
    std::vector<idx> first_cell, first_vertex;
    pack_params params;
    run_limits limits;

    packing make() const { return pack(uv, cells, first_cell, first_vertex, params, limits); }
};

/// Outlines that are in the tiles already: rows of tile, then the two ends of an edge within its tile.
std::vector<tile_wall> walls_of(const array& tiles, const array& ends)
{
    const auto numbers = ids_of(tiles);
    const auto points = points_of<2>(ends, "walls"); // two rows an edge
    std::vector<tile_wall> walls(numbers.size());
    for (std::size_t i = 0; i < walls.size(); ++i) walls[i] = {numbers[i], {points[2 * i], points[2 * i + 1]}};
    return walls;
}

nb::object pack_of(const array& uv, const array& F, const array& first_cell, const array& first_vertex,
                   const nb::dict& keywords, const control_handle& watched)
{
    const options given(keywords);
    auto job = std::make_shared<pack_job>();
    job->uv = points_of<2>(uv, "uv");
    job->cells = cells_of<3>(F, "F");
    job->first_cell = ids_of(first_cell);
    job->first_vertex = ids_of(first_vertex);
    pack_params& params = job->params;
    given.read("resolution", params.resolution);
    given.read("padding", params.padding);
    given.read("tiles", params.tiles);
    given.read("rotate", params.rotate);
    given.read("rounding", params.rounding);
    given.read_seconds("time_limit", job->limits.time_limit);
    if (const auto a = given.rows("densities")) params.densities = numbers_of(*a);
    if (const auto tiles = given.rows("wall_tiles")) params.walls = walls_of(*tiles, *given.rows("wall_ends"));
    job->limits.observer = watched.shared->observer("pack");
    return told(run(watched.shared, given.progress(), [job] { return job->make(); }),
                [job](const packing& made) -> nb::object
                {
                    nb::dict d;
                    std::vector<idx> tiles;
                    for (const auto& place : made.places) tiles.push_back(place.tile);
                    d["uv"] = array_of<2>(made.apply(job->uv, job->first_vertex));
                    d["tile"] = array_of(tiles);
                    d["scale"] = made.scale;
                    d["utilization"] = made.utilization;
                    d["complete"] = made.complete;
                    return d;
                });
}

} // namespace

void add_packing(nb::module_& m)
{
    m.def("pack", &pack_of);
}

} // namespace taut::python
