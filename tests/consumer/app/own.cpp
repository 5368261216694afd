// SPDX-License-Identifier: MIT
// An energy, a kernel and an element of one's own, from public headers alone.
#include <cmath>
#include <iostream>
#include <vector>

#include <taut/certify.hpp>
#include <taut/constraints.hpp>
#include <taut/energy.hpp>
#include <taut/kernel.hpp>
#include <taut/mesh.hpp>
#include <taut/parameterize.hpp>
#include <taut/solve.hpp>

/// Shape, and a spring against changes of area.
struct rubber
{
    static constexpr bool barrier = true;
    double stiffness = 0.5;

    template <class T, int D>
    T operator()(const taut::element<T, D>& e) const
    {
        return taut::norm2(e.S) / e.det + stiffness * (e.det + 1 / e.det);
    }
};

/// A triangle that wants to be equilateral, of the area that it has at rest.
struct equilateral_triangle : taut::triangle
{
    static taut::mat2 ideal(const rest_corners& x)
    {
        const double area = 0.5 * glm::length(glm::cross(x[1] - x[0], x[2] - x[0]));
        const double edge = std::sqrt(4 * area / std::sqrt(3.0));
        return taut::mat2(edge, 0, 0.5 * edge, 2 * area / edge);
    }
};

int main()
{
    using taut::vec2;
    const std::vector<taut::vec3> points{{0, 0, 0}, {1, 0, 1}, {2, 0, 0}, {0, 1, 0}, {1, 1, 1}, {2, 1, 0}};
    const std::vector<taut::mesh<taut::triangle>::cell> cells{{0, 1, 3}, {1, 4, 3}, {1, 2, 4}, {2, 5, 4}};
    const taut::mesh<taut::triangle> roof(points, cells);
    taut::queue queue;

    if (const auto found = taut::check_gradient<2>(rubber{}); !found) return std::cerr << found, 1;
    const auto map = taut::parameterize(
        queue, roof, {.energy = rubber{}, .constraints = taut::constraints(roof).pin(0, {0, 0}).pin(5, {2.5, 1})});
    if (!map || map.uv[5] != vec2(2.5, 1)) return std::cerr << map.report, 2;

    const taut::buffer<double> x(queue, std::vector<double>{1, 2, 3});
    taut::buffer<double> y(queue, std::vector<double>{1, 1, 1});
    queue.submit(
        [&](taut::handler& h)
        {
            const auto in = x.read(h);
            const auto out = y.read_write(h);
            h.parallel_for(3, [=](auto i) { out[i] = 2.0 * in[i] + out[i]; });
        });
    if (y.download() != std::vector<double>{3, 5, 7}) return 3;

    // A unit equilateral triangle mapped to itself is at rest for this element, a right one is not.
    const double rest = taut::energy::rest_value<2>(rubber{});
    const auto energy_of = [&](const std::vector<vec2>& x)
    {
        const taut::mesh<equilateral_triangle> one({{x[0], 0}, {x[1], 0}, {x[2], 0}}, {{0, 1, 2}});
        return taut::map_evaluator<equilateral_triangle>(queue, one, rubber{}).value(x);
    };
    const double at_rest = energy_of({{0, 0}, {1, 0}, {0.5, std::sqrt(0.75)}});
    const double right = energy_of({{0, 0}, {1, 0}, {0, 1}});
    std::cout << "energies " << at_rest << ' ' << right << ", at rest " << rest << '\n';
    return std::abs(at_rest - rest) < 1e-12 && right > rest + 0.1 && taut::certify<2>(cells, map.uv) ? 0 : 4;
}
