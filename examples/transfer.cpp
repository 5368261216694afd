// SPDX-License-Identifier: MIT
// Two surfaces in one parameter plane: the boundary and some features of a mesh are pinned onto places in the
// parameterization of another one, as for cut-and-paste editing (paper, section 4.1 and figure 9).
//   transfer SOURCE TARGET [OUT.obj]
#include <cmath>
#include <iostream>
#include <numbers>

#include <taut/taut.hpp>

using namespace taut;

/// The vertex of a map that is nearest to a point.
taut::idx nearest(const std::vector<vec2>& uv, const vec2& p)
{
    std::size_t best = 0;
    for (std::size_t v = 1; v < uv.size(); ++v)
        if (glm::distance(uv[v], p) < glm::distance(uv[best], p)) best = v;
    return static_cast<taut::idx>(best);
}

/// The disk that a map fills, about: the mean of its boundary, and the radius of a circle of its area.
struct frame
{
    vec2 centre{0};
    double radius = 0;

    frame(const mesh<triangle>& m, const std::vector<vec2>& uv)
    {
        const auto loop = boundary_loops(m)[0];
        const auto at = [&](std::size_t i) { return uv[static_cast<std::size_t>(loop[i % loop.size()])]; };
        double area = 0;
        for (std::size_t i = 0; i < loop.size(); ++i)
        {
            centre += at(i) / static_cast<double>(loop.size());
            area += (at(i).x * at(i + 1).y - at(i).y * at(i + 1).x) / 2;
        }
        radius = std::sqrt(area / std::numbers::pi);
    }
    vec2 place(const vec2& p) const { return centre + radius * p; }
};

int main(int argc, char** argv)
try
{
    if (argc < 3)
    {
        std::cerr << "usage: transfer SOURCE TARGET [OUT.obj]\n";
        return 2;
    }
    queue q;
    const auto source = io::read_surface(argv[1]), target = io::read_surface(argv[2]);
    const auto from = parameterize(q, source), to = parameterize(q, target);
    if (!from || !to) return 1;

    // The boundary of the source goes onto a circle within the target's map, and five features onto vertices there.
    const frame own(source, from.uv);
    frame hole(target, to.uv);
    hole.radius *= 0.6;
    constraints<triangle> pins(source);
    std::vector<vec2> circle;
    for (int k = 0; k < 256; ++k)
        circle.push_back(hole.place({std::cos(std::numbers::pi * k / 128), std::sin(std::numbers::pi * k / 128)}));
    pins.pin_boundary(circle);
    for (const vec2 feature : {vec2(0, 0), vec2(0.3, 0.2), vec2(-0.3, 0.2), vec2(0, -0.35), vec2(0.1, 0.4)})
    {
        const auto v = nearest(from.uv, own.place(feature));
        if (pins.held(v) != 0) continue;
        pins.pin(v, to.uv[static_cast<std::size_t>(nearest(to.uv, hole.place(feature)))]);
    }
    const auto pasted = parameterize(q, source, {.constraints = pins});
    if (!pasted)
    {
        std::cerr << pasted.reason() << '\n';
        return 1;
    }
    if (argc > 3) io::write_obj(argv[3], source, pasted.uv);
    std::cout << pasted.report << ", " << pins.pins().size() << " pins\n";
}
catch (const error& e)
{
    std::cerr << e.what() << '\n';
    return 1;
}
