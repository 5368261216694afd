// SPDX-License-Identifier: MIT
// cloth.cpp: an energy that knows the warp of a cloth, how stiff each triangle is, and a slider.
#include <cstddef>
#include <iostream>
#include <vector>

#include <taut/taut.hpp>

using namespace taut;
using namespace taut::energy;

// [energy]
/// Woven cloth: stretch along the warp, the first axis, costs as much as the triangle (attribute 0) and the slider
/// (parameter 0) say; otherwise it is as isometric as possible.
struct cloth
{
    static constexpr bool barrier = true;

    template <class T, int D>
    T operator()(const element<T, D>& e) const
    {
        const T stretch = glm::dot(e.S[0], e.S[0]) - T(1); // of a thread of the warp, squared
        return isometric{}(e) + e.parameter(0) * e.attribute(0) * stretch * stretch;
    }
};
// [energy]

int main(int argc, char** argv)
{
    if (argc != 2)
    {
        std::cerr << "usage: cloth SURFACE\n";
        return 2;
    }
    try
    {
        const auto surface = io::read_surface(argv[1]);
        queue q;
        const std::size_t n = surface.cells().size();
        // [use]
        cell_data data;
        data.directions.assign(n, vec3(1, 0, 0)); // the warp, projected to each triangle
        data.attribute_count = 1;
        for (std::size_t c = 0; c < n; ++c) data.attributes.push_back(c < n / 2 ? 1.0 : 4.0); // two fabrics
        data.weights.assign(n, 1.0);
        data.weights.front() = 10; // one triangle counts ten times

        double before = 0;
        for (const double slider : {0.0, 1.0, 2.0}) // kernels are built once
        {
            const auto map = parameterize(q, surface, {.energy = {cloth{}, {slider}}, .data = data});
            std::cout << "slider " << slider << ": " << map.report << '\n';
            if (!map || map.report.solve.value < before) return 1; // a stiffer cloth costs more
            before = map.report.solve.value;
        }
        // [use]
    }
    catch (const taut::error& e)
    {
        std::cerr << e.what() << '\n';
        return 1;
    }
}
