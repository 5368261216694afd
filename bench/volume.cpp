// SPDX-License-Identifier: MIT
// Bars of tetrahedra that are twisted, stretched and bent, and a handle that is moved over 60 frames:
//   taut_bench_volume [--quick] [--json FILE] [CUBES_ACROSS...]     (8 16; a bar is five times as long: 30 n^3
//   tetrahedra)
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <exception>
#include <fstream>
#include <numbers>
#include <random>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include <taut/map/deform.hpp>
#include <taut/measure/rigid_motion.hpp>

#include "peak_memory.hpp"

namespace
{

using namespace taut;
using taut::idx;

double now()
{
    return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

/// A bar of 1 by 1 by 5, its vertices jittered inside and along the sides.
mesh<tetrahedron> bar(int n)
{
    std::vector<vec3> points;
    std::vector<mesh<tetrahedron>::cell> cells;
    std::mt19937 random(1);
    std::uniform_real_distribution<double> move(-0.2, 0.2);
    const auto at = [n](int i, int j, int k) { return static_cast<idx>((k * (n + 1) + j) * (n + 1) + i); };
    for (int k = 0; k <= 5 * n; ++k)
        for (int j = 0; j <= n; ++j)
            for (int i = 0; i <= n; ++i)
            {
                vec3 p(i, j, k);
                const int last[] = {n, n, 5 * n};
                for (int c = 0; c < 3; ++c)
                    if (p[c] > 0 && p[c] < last[c]) p[c] += move(random);
                points.push_back(p / double(n));
            }
    for (int k = 0; k < 5 * n; ++k)
        for (int j = 0; j < n; ++j)
            for (int i = 0; i < n; ++i)
            {
                const idx a = at(i, j, k), b = at(i + 1, j + 1, k + 1);
                const idx ring[] = {at(i + 1, j, k),     at(i + 1, j + 1, k), at(i, j + 1, k),
                                    at(i, j + 1, k + 1), at(i, j, k + 1),     at(i + 1, j, k + 1)};
                for (int s = 0; s < 6; ++s) cells.push_back({a, ring[s], ring[(s + 1) % 6], b});
            }
    return {std::move(points), std::move(cells)};
}

struct ends
{
    std::vector<idx> low, high;
    explicit ends(const mesh<tetrahedron>& m)
    {
        for (idx v = 0; v < m.vertex_count(); ++v)
        {
            const double z = m.points()[static_cast<std::size_t>(v)].z;
            if (z == 0) low.push_back(v);
            if (z == 5) high.push_back(v);
        }
    }
};

vec3 moved(const std::string& how, const vec3& p)
{
    if (how == "stretch") return p + vec3(0, 0, 2.5);
    const vec3 middle(0.5, 0.5, 5);
    const bool twist = how == "twist";
    const rigid_motion<3> turn{.from = middle,
                               .to = twist ? middle : middle + vec3(0, 2.5, -1.5),
                               .axis = twist ? vec3(0, 0, 1) : vec3(-1, 0, 0),
                               .angle = std::numbers::pi / 2};
    return turn(p);
}

void deform_bars(queue& q, int n, nlohmann::ordered_json& results)
{
    const auto m = bar(n);
    const ends e(m);
    for (const std::string how : {"twist", "stretch", "bend"})
    {
        deform_params<tetrahedron> params;
        params.constraints =
            constraints<tetrahedron>(m).fix(e.low).move(e.high, [&](const vec3& p) { return moved(how, p); });
        const bench::peak_memory memory;
        const double begin = now();
        const auto [x, r] = deform(q, m, params);
        const double seconds = now() - begin;
        std::printf(
            "%9zu %-8s %2d steps  E %.6f  gradient %.1e  %s  %zu inverted  %6.2f s: start %.2f follow %.2f solve "
            "%.2f certificate %.2f  %zu MB\n",
            m.cells().size(), how.c_str(), r.steps, r.energy, r.gradient,
            r.converged && r.pins_held ? "converged" : "NOT CONVERGED", r.flips.flipped, seconds, r.seconds.start,
            r.seconds.follow, r.seconds.solve, r.seconds.certificate, memory.bytes() >> 20);
        std::fflush(stdout);
        results.push_back({{"tetrahedra", m.cells().size()},
                           {"motion", how},
                           {"steps", r.steps},
                           {"energy", r.energy},
                           {"gradient", r.gradient},
                           {"converged", r.converged && r.pins_held},
                           {"inverted", r.flips.flipped},
                           {"seconds", seconds},
                           {"peak_bytes", memory.bytes()}});
    }
}

void frames(queue& q, int n, nlohmann::ordered_json& results)
{
    const auto m = bar(n);
    const ends e(m);
    session s(q, m, {.constraints = constraints<tetrahedron>(m).fix(e.low)});
    s.solve();
    const auto home = s.x();
    std::vector<double> times;
    std::size_t inverted = 0;
    for (int frame = 1; frame <= 60; ++frame)
    {
        std::vector<vec3> places;
        for (const idx v : e.high)
            places.push_back(home[static_cast<std::size_t>(v)] + vec3(0.02 * frame, 0.01 * frame, -0.005 * frame));
        const double begin = now();
        const auto r = s.move(e.high, places).solve({.steps = 2});
        times.push_back(1000 * (now() - begin));
        inverted += r.report.flips.flipped;
    }
    std::sort(times.begin(), times.end());
    const auto rest = s.solve();
    deform_params<tetrahedron> params;
    params.constraints = s.constraints();
    const auto scratch = deform(q, m, params);
    std::printf("%9zu session  60 frames of 2 steps: median %.1f ms, 95 %% %.1f ms, %zu inverted; E at rest %.7f, from "
                "scratch %.7f\n",
                m.cells().size(), times[30], times[57], inverted, rest.report.energy, scratch.report.energy);
    results.push_back({{"tetrahedra", m.cells().size()},
                       {"motion", "session"},
                       {"median_ms", times[30]},
                       {"p95_ms", times[57]},
                       {"inverted", inverted},
                       {"energy", rest.report.energy},
                       {"energy_from_scratch", scratch.report.energy}});
}

} // namespace

int main(int argc, char** argv)
try
{
    bool quick = false;
    std::string json;
    std::vector<int> sizes;
    for (int k = 1; k < argc; ++k)
        if (std::strcmp(argv[k], "--quick") == 0)
            quick = true;
        else if (std::strcmp(argv[k], "--json") == 0 && k + 1 < argc)
            json = argv[++k];
        else
            sizes.push_back(std::stoi(argv[k]));
    if (sizes.empty()) sizes = quick ? std::vector<int>{3} : std::vector<int>{8, 16};
    queue q;
    auto results = nlohmann::ordered_json::array();
    for (const int n : sizes)
    {
        deform_bars(q, n, results);
        frames(q, n, results);
    }
    if (!json.empty()) std::ofstream(json) << results.dump(2) << '\n';
}
catch (const std::exception& e)
{
    std::fprintf(stderr, "%s\n", e.what());
    return 1;
}
