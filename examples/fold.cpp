// SPDX-License-Identifier: MIT
// fold SURFACE OUT.obj [SHARE]: a surface in space is bent as a thin shell: its first tenth along its longest axis is
// held, and the last one turned by 60 degrees. SHARE: its thickness by its length.
#include <iostream>
#include <numbers>
#include <string>
#include <vector>

#include <taut/taut.hpp>

using namespace taut;

int main(int argc, char** argv)
try
{
    if (argc != 3 && argc != 4) throw error("fold SURFACE OUT.obj [SHARE]");
    queue q;
    const auto file = io::read_surface_file(argv[1]);
    const auto& points = file.surface.points();
    vec3 least = points.front(), most = least;
    for (const vec3& p : points) least = glm::min(least, p), most = glm::max(most, p);
    const vec3 size = most - least, middle = (least + most) / 2.0;
    const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
    vec3 across(0.0);
    across[(axis + 1) % 3] = 1;
    const rigid_motion<3> turn{.from = middle, .to = middle, .axis = across, .angle = std::numbers::pi / 3};
    const double thickness = (argc == 4 ? std::stod(argv[3]) : 0.02) * size[axis];

    // [fold]
    const thin_shell shell(file.surface);
    auto pins = taut::constraints(shell.hinges());
    for (taut::idx v = 0; v < file.surface.vertex_count(); ++v)
    {
        const vec3& p = points[static_cast<std::size_t>(v)];
        const double share = (p[axis] - least[axis]) / size[axis];
        if (share <= 0.1 || share >= 0.9) pins.pin(v, share >= 0.9 ? turn(p) : p);
    }
    const auto [x, report] = deform(q, shell, shell_params{.constraints = pins, .thickness = thickness});
    if (x.empty()) throw error(report.reason);

    file.write(argv[2], x); // with its vertices at other places
    // [fold]
    std::cout << pins.pins().size() << " vertices held" << (report.converged ? ", converged, " : ", ")
              << report.flips.flipped << " of " << report.flips.elements << " collapsed\n";
    return report.pins_held ? 0 : 1;
}
catch (const error& e)
{
    std::cerr << e.what() << '\n';
    return 1;
}
