// SPDX-License-Identifier: MIT
// make_report N MOST: writes the report of a sphere in six charts, each N x N squares, to standard output; the view
// gets at most MOST triangles. A seventh chart is one triangle apart, and one triangle has no chart.
#include <cmath>
#include <cstddef>
#include <cstdlib>
#include <iostream>
#include <limits>
#include <map>

#include <report/atlas_page.hpp>
#include <taut/types.hpp>

using namespace taut;

namespace
{

struct sphere
{
    std::vector<vec3> points;
    std::vector<std::array<idx, 3>> cells;
    std::vector<std::array<vec2, 3>> uv;
    std::vector<idx> chart;
    std::vector<double> energy;

    /// |S|^2 (1 + 1 / det^2) of a triangle whose lengths in the atlas are `scale` times those of the sphere.
    double isometric(const std::array<vec3, 3>& p, const std::array<vec2, 3>& q, double scale) const
    {
        const vec3 e = p[1] - p[0], f = p[2] - p[0];
        const double length = glm::length(e), x = glm::dot(e, f) / length, y = glm::length(glm::cross(e, f)) / length;
        const vec2 s = (q[1] - q[0]) / (scale * length), t = ((q[2] - q[0]) / scale - x * s) / y;
        const double det = s.x * t.y - s.y * t.x;
        return (glm::dot(s, s) + glm::dot(t, t)) * (1 + 1 / (det * det));
    }

    sphere(int n, int alone)
    {
        std::map<std::array<int, 3>, idx> number; // corners of faces of a cube of side 2 n
        for (int side = 0; side < 6; ++side)
        {
            const int axis = side % 3, sign = side < 3 ? 1 : -1;
            const auto vertex = [&](int i, int j)
            {
                std::array<int, 3> at{};
                at[std::size_t(axis)] = sign * n;
                at[std::size_t((axis + 1) % 3)] = sign * (2 * i - n);
                at[std::size_t((axis + 2) % 3)] = 2 * j - n;
                const auto [found, fresh] = number.emplace(at, static_cast<idx>(points.size()));
                if (fresh)
                    points.push_back(glm::normalize(
                        vec3(std::tan(at[0] * 0.785 / n), std::tan(at[1] * 0.785 / n), std::tan(at[2] * 0.785 / n))));
                return found->second;
            };
            const auto place = [&](int i, int j)
            { return vec2(side % 3, side / 3) * 0.33 + vec2(0.01) + vec2(i, j) * (0.31 / n); };
            for (int i = 0; i < n; ++i)
                for (int j = 0; j < n; ++j)
                {
                    add({vertex(i, j), vertex(i + 1, j), vertex(i + 1, j + 1)},
                        {place(i, j), place(i + 1, j), place(i + 1, j + 1)}, side);
                    add({vertex(i, j), vertex(i + 1, j + 1), vertex(i, j + 1)},
                        {place(i, j), place(i + 1, j + 1), place(i, j + 1)}, side);
                }
        }
        const auto apart = [&](double height)
        {
            for (const vec3& p : {vec3(1.2, 0, height), vec3(1.4, 0, height), vec3(1.2, 0.2, height)})
                points.push_back(p);
            const auto end = static_cast<idx>(points.size());
            return std::array<idx, 3>{end - 3, end - 2, end - 1};
        };
        for (int k = 0; k < alone; ++k)
        {
            const double size = 0.1 / alone;
            const vec2 at(0.1 + k * size, 0.8);
            add(apart(2.0 * k / alone), {at, at + vec2(size, 0), at + vec2(0, size)}, 6 + k);
        }
        cells.push_back(apart(-0.2));
        uv.push_back({vec2(NAN), vec2(NAN), vec2(NAN)});
        chart.push_back(-1);
        energy.push_back(std::numeric_limits<double>::quiet_NaN());
    }

    void add(std::array<idx, 3> cell, std::array<vec2, 3> places, idx of_chart)
    {
        std::array<vec3, 3> p;
        for (std::size_t k = 0; k < 3; ++k) p[k] = points[static_cast<std::size_t>(cell[k])];
        cells.push_back(cell);
        uv.push_back(places);
        chart.push_back(of_chart);
        energy.push_back(isometric(p, places, 0.2));
    }
};

} // namespace

int main(int argc, char** argv)
{
    if (argc != 4) return 2;
    const int alone = std::atoi(argv[3]);
    const sphere s(std::atoi(argv[1]), alone);
    report::atlas_page page;
    page.title = "sphere </script><script>alert(1)</script>.obj";
    page.command = "taut atlas sphere.obj -o 'out <b>.obj' --report sphere.html";
    page.points = s.points;
    page.cells = s.cells;
    page.uv = s.uv;
    page.chart = s.chart;
    page.energy = s.energy;
    page.columns = {{"iterations", {3, 4, 5, 6, 7, 8}}};
    page.columns[0].values.resize(static_cast<std::size_t>(6 + alone), std::numeric_limits<double>::quiet_NaN());
    page.repairs = {"1 triangle (12) had no area and was dropped"};
    page.stages = {{"read", 0.1}, {"charts", 0.4, 5.5}, {"flatten", 1.2, 4.3}, {"pack", 0.3, 4.3}};
    page.numbers = {
        {"charts", std::to_string(6 + alone)}, {"use of the square", "0.62"}, {"flipped", "0"}, {"overlaps", "0"}};
    page.most_triangles = static_cast<idx>(std::atoi(argv[2]));
    std::cout << report::atlas_report_html(page);
}
