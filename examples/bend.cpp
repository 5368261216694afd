// SPDX-License-Identifier: MIT
// bend IN OUT [DEGREES]: a volume is bent: the first tenth along its longest axis is held, the last one is turned.
#include <iostream>
#include <numbers>
#include <string>
#include <vector>

#include <taut/taut.hpp>

using namespace taut;

int main(int argc, char** argv)
try
{
    if (argc != 3 && argc != 4) throw error("bend IN OUT [DEGREES]");
    queue q;
    const auto file = io::read_volume_file(argv[1]);
    const auto volume = file.tetrahedra();

    // [bend]
    vec3 least = file.points.front(), most = least;
    for (const vec3& p : file.points) least = glm::min(least, p), most = glm::max(most, p);
    const vec3 size = most - least;
    const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
    std::vector<taut::idx> low, high;
    vec3 middle(0.0), along(0.0), across(0.0);
    for (taut::idx v = 0; v < volume.vertex_count(); ++v)
    {
        const vec3& p = file.points[static_cast<std::size_t>(v)];
        const double share = (p[axis] - least[axis]) / size[axis];
        if (share <= 0.1) low.push_back(v);
        if (share < 0.9) continue;
        high.push_back(v);
        middle += p;
    }
    middle /= static_cast<double>(high.size());
    along[axis] = across[(axis + 1) % 3] = 1;
    const double angle = (argc == 4 ? std::stod(argv[3]) : 60) * std::numbers::pi / 180;
    const rigid_motion<3> turn{.from = middle,
                               .to = middle + size[axis] * angle / 4 * glm::cross(across, along) -
                                     size[axis] * angle * angle / 12 * along,
                               .axis = across,
                               .angle = -angle};
    deform_params<tetrahedron> params;
    params.constraints = constraints(volume).fix(low).move(high, turn);
    const auto [x, report] = deform(q, volume, params);
    if (x.empty()) throw error(report.reason);
    file.write(argv[2], x);
    // [bend]
    std::cout << high.size() << " vertices turned, E " << report.energy << (report.converged ? ", converged, " : ", ")
              << report.flips.flipped << " of " << report.flips.elements << " inverted\n";
    return report.pins_held ? 0 : 1;
}
catch (const error& e)
{
    std::cerr << e.what() << '\n';
    return 1;
}
