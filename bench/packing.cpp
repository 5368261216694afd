// SPDX-License-Identifier: MIT
// Generated charts with ragged outlines (blobs, strips, L and C shapes, annuli, slivers; areas differ by about 20)
// packed in one square, and certified as floats: seconds of the processor, and how much of the square they use.
//   taut_bench_packing [--quick] [--json FILE]
#include <cstdio>
#include <ctime>
#include <utility>
#include <vector>

#include <support/chart_sets.hpp>
#include <taut/pack.hpp>

#include "measure.hpp"

namespace
{

template <class Work>
double processor_seconds(Work&& work)
{
    const std::clock_t begin = std::clock();
    work();
    return static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC;
}

} // namespace

int main(int argc, char** argv)
{
    const bench::options options(argc, argv);
    std::vector<std::pair<int, int>> sizes{{20, 5000}, {60, 1667}, {150, 667}, {400, 250}, {1000, 200}, {10'000, 200}};
    if (options.quick) sizes = {{20, 100}};
    auto results = nlohmann::ordered_json::array();
    std::printf("%8s %10s %6s %8s %8s %8s %6s\n", "charts", "triangles", "texels", "seconds", "certify", "use",
                "holds");
    for (const auto& [charts, triangles] : sizes)
        for (const int resolution : {1024, 4096})
        {
            const auto set = support::ragged_charts(charts, triangles, 20, 1);
            taut::pack_params params;
            params.resolution = resolution;
            taut::packing packed;
            const double seconds = processor_seconds(
                [&] { packed = taut::pack(set.uv, set.cells, set.first_cell, set.first_vertex, params); });
            auto uv = packed.apply(set.uv, set.first_vertex);
            for (taut::vec2& p : uv) p = {static_cast<float>(p.x), static_cast<float>(p.y)};
            taut::packing_certificate sealed;
            const double certify = processor_seconds(
                [&] { sealed = taut::certify_packing(uv, set.cells, set.first_cell, set.first_vertex); });
            const bool holds = sealed.holds(params.padding, resolution);
            std::printf("%8d %10zu %6d %8.2f %8.2f %8.3f %6s\n", charts, set.cells.size(), resolution, seconds, certify,
                        packed.utilization, holds ? "yes" : "NO");
            results.push_back({{"charts", charts},
                               {"triangles", set.cells.size()},
                               {"resolution", resolution},
                               {"cpu_seconds", seconds},
                               {"certify_cpu_seconds", certify},
                               {"utilization", packed.utilization},
                               {"holds", holds}});
            if (!holds) return 1;
        }
    options.write({{"library", "taut"}, {"commit", TAUT_BENCH_COMMIT}, {"results", std::move(results)}});
}
