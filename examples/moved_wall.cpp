// SPDX-License-Identifier: MIT
// moved_wall IN.su2 OUT.su2: a wall of a channel bulges inwards, and the mesh follows, as between two runs of a flow
// solver. Markers "wall", "inlet", "outlet", "far"; the file is written as it was but for coordinates.
#include <cmath>
#include <iostream>
#include <set>
#include <vector>

#include <taut/taut.hpp>

int main(int argc, char** argv)
try
{
    if (argc != 3) throw taut::error("moved_wall IN.su2 OUT.su2");
    taut::queue queue;
    // [wall]
    const auto file = taut::io::read_volume_file(argv[1]);
    const auto mesh = file.triangles(); // file.tetrahedra() in space
    const auto bulge = [](const taut::vec2& p) { return p + taut::vec2(0, 0.4 * std::pow(p.x * (3 - p.x) / 2.25, 2)); };
    const auto& wall = file.find_group("wall").vertices;
    std::set<taut::idx> still; // corners are in two of the groups
    for (const char* marker : {"inlet", "outlet", "far"})
        for (const taut::idx v : file.find_group(marker).vertices) still.insert(v);
    for (const taut::idx v : wall) still.erase(v);
    const auto pins = taut::constraints(mesh).fix(std::vector<taut::idx>(still.begin(), still.end())).move(wall, bulge);
    const auto [x, report] = taut::deform(queue, mesh, taut::deform_params<taut::triangle>{.constraints = pins});

    std::vector<taut::vec3> points;
    for (const taut::vec2& p : x) points.emplace_back(p, 0.0);
    file.write(argv[2], points);
    // [wall]
    std::cout << wall.size() << " vertices of the wall moved, " << (report.pins_held ? "pins exact, " : "pins missed, ")
              << report.flips.flipped << " of " << report.flips.elements << " inverted\n";
    return report.outcome == taut::outcome::valid ? 0 : 1;
}
catch (const taut::error& e)
{
    std::cerr << e.what() << '\n';
    return 1;
}
