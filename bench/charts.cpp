// SPDX-License-Identifier: MIT
// Charts flattened all at once against one at a time with `parameterize`, by stage. Charts are generated: bumpy disks
// ("bumpy"), and closed-up caps of a sphere ("caps"), which stretch.
//   taut_bench_charts [--quick] [--json FILE]
// The first call of the program pays for its kernels: run it with an empty POCL_CACHE_DIR to see how much.
#include <algorithm>
#include <cstdio>
#include <ctime>
#include <string>
#include <utility>
#include <vector>

#include <support/meshes.hpp>

#include <taut/charts.hpp>
#include <taut/impl/charts/atlas/chart_mesh.hpp>
#include <taut/impl/core/solve/report.hpp>
#include <taut/parameterize.hpp>

#include "measure.hpp"

namespace
{

using namespace taut;
using namespace taut::impl;
using taut::idx;

double cpu_seconds()
{
    std::timespec now{};
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
    return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

struct chart_set
{
    std::string name;
    std::vector<mesh<triangle>> parts;

    chart_mesh joined() const
    {
        std::vector<vec3> points;
        std::vector<std::array<idx, 3>> cells;
        for (const auto& part : parts)
        {
            const auto first = static_cast<idx>(points.size());
            points.insert(points.end(), part.points().begin(), part.points().end());
            for (auto t : part.cells())
            {
                for (idx& v : t) v += first;
                cells.push_back(t);
            }
        }
        const mesh<triangle> all(std::move(points), std::move(cells));
        const auto f = facets(all);
        return cut_charts(all, f, std::vector<char>(f.twin.size(), 0));
    }
};

chart_set bumpy_charts(std::size_t count, int n)
{
    chart_set set{"bumpy", {}};
    for (std::size_t k = 0; k < count; ++k)
        set.parts.push_back(test::bumpy(n, 0.15, static_cast<std::uint32_t>(k) + 1));
    return set;
}

chart_set caps(std::size_t count, int n)
{
    chart_set set{"caps", {}};
    for (std::size_t k = 0; k < count; ++k)
        set.parts.push_back(test::cap(n, 1.0 + 1.6 * static_cast<double>(k) / static_cast<double>(count)));
    return set;
}

void measure(queue& q, const chart_set& set, std::size_t sample, nlohmann::ordered_json& results)
{
    const chart_mesh charts = set.joined();
    flattened_charts flat;
    flatten_charts(q, charts);
    const double cpu = cpu_seconds(), wall = bench::seconds([&] { flat = flatten_charts(q, charts); });
    const double used = cpu_seconds() - cpu;
    double iterations = 0, energy = 0;
    std::size_t valid = 0;
    for (const auto& report : flat.charts)
    {
        iterations += report.iterations;
        energy += report.energy;
        valid += report.valid;
    }
    // One at a time: the first ones warm up, then some of all sizes stand for all.
    sample = std::min(sample, set.parts.size());
    const std::size_t stride = set.parts.size() / sample;
    double single = 0, single_cpu = 0;
    for (const bool counts : {false, true})
        for (std::size_t k = 0; k < (counts ? sample : std::min<std::size_t>(sample, 5)); ++k)
        {
            const double before = cpu_seconds();
            const double t = bench::seconds([&] { parameterize(q, set.parts[k * stride]); });
            if (!counts) continue;
            single += t;
            single_cpu += cpu_seconds() - before;
        }
    const double scale = static_cast<double>(set.parts.size()) / static_cast<double>(sample);
    const auto n = static_cast<double>(set.parts.size());
    const auto& s = flat.seconds;
    std::printf("%-6s %7d %8d %6zu %6.2f %8.4f %7.3f %7.3f %7.3f %7.3f %7.3f %7.3f %6llu %9.1f %7.1f %7.1f\n",
                set.name.c_str(), charts.charts(), charts.surface.cell_count(), valid, iterations / n, energy / n, wall,
                used, s.start, s.prepare, s.solve, s.certify, static_cast<unsigned long long>(flat.counters.launches),
                single * scale, single / wall * scale, single_cpu / used * scale);
    std::fflush(stdout);
    results.push_back({{"set", set.name},
                       {"charts", charts.charts()},
                       {"triangles", charts.surface.cell_count()},
                       {"valid", valid},
                       {"iterations", iterations / n},
                       {"energy", energy / n},
                       {"seconds", wall},
                       {"cpu_seconds", used},
                       {"start", s.start},
                       {"prepare", s.prepare},
                       {"solve", s.solve},
                       {"certify", s.certify},
                       {"launches", flat.counters.launches},
                       {"one_by_one_seconds", single * scale},
                       {"one_by_one_cpu_seconds", single_cpu * scale}});
}

} // namespace

int main(int argc, char** argv)
{
    const bench::options options(argc, argv);
    queue q;
    auto report = bench::circumstances(q);
    const chart_mesh one = chart_set{"one", {test::cap(3)}}.joined();
    const double cpu = cpu_seconds(), first = bench::seconds([&] { flatten_charts(q, one); });
    std::printf("first call: %.2f s, %.2f CPU s\n", first, cpu_seconds() - cpu);
    std::printf("set     charts triangl.  valid  steps   energy seconds     CPU   start prepare   solve certify launch "
                "1 by 1, s   ratio     CPU\n");
    const std::size_t part = options.quick ? 100 : 1;
    measure(q, bumpy_charts(10000 / part, 9), 200 / part, report["results"]);
    measure(q, bumpy_charts(200 / part, 14), 40 / part + 1, report["results"]);
    measure(q, bumpy_charts(400 / part, 30), 20 / part + 1, report["results"]);
    measure(q, caps(10000 / part, 6), 200 / part, report["results"]);
    measure(q, caps(200 / part, 9), 40 / part + 1, report["results"]);
    options.write(report);
}
