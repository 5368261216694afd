// SPDX-License-Identifier: MIT
// Random pinned maps with a free boundary: of each mesh's free map 1 to 20 random vertices are pinned up to 5 to 50 %
// of the longer side of the map's box away from where they were, and the mesh is parameterized anew. What became of
// each, and whether a map that is called valid holds its pins, has no flipped triangle, and winds once around every
// vertex inside, by angles that are added up.
//   taut_bench_pins [--cases N] [--seed N] [--limit SECONDS] [--json FILE] [MESH...]
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <numbers>
#include <random>

#include <support/meshes.hpp>
#include <support/winding.hpp>

#include <taut/parameterize.hpp>
#include <taut/surface_file.hpp>

#include "measure.hpp"

namespace
{

using namespace taut;
using taut::idx;

struct tally
{
    int problems = 0, valid = 0, infeasible = 0, gave_up = 0, branched = 0, wrong = 0;
    std::vector<double> seconds;

    void add(const tally& t)
    {
        problems += t.problems;
        valid += t.valid;
        infeasible += t.infeasible;
        gave_up += t.gave_up;
        branched += t.branched;
        wrong += t.wrong;
        seconds.insert(seconds.end(), t.seconds.begin(), t.seconds.end());
    }

    double median() const
    {
        auto sorted = seconds;
        std::sort(sorted.begin(), sorted.end());
        return sorted.empty() ? 0 : sorted[sorted.size() / 2];
    }
};

void print(const std::string& name, const tally& t)
{
    std::printf("%-16s %8d %6d %11d %8d %9d %6d %8.2f %8.2f\n", name.c_str(), t.problems, t.valid, t.infeasible,
                t.gave_up, t.branched, t.wrong, t.median(), *std::max_element(t.seconds.begin(), t.seconds.end()));
    std::fflush(stdout);
}

std::string stage_of_success(const map_report& r)
{
    for (const auto& s : r.untangling)
        if (s.stop == "injective") return s.stage;
    return "";
}

tally measure(queue& q, const std::string& name, const mesh<triangle>& m, int cases, unsigned seed, double limit,
              nlohmann::ordered_json& results)
{
    const auto free = parameterize(q, m);
    if (!free) throw std::runtime_error(name + ": no free map: " + free.reason());
    vec2 low = free.uv.front(), high = low;
    for (const vec2& p : free.uv)
    {
        low = glm::min(low, p);
        high = glm::max(high, p);
    }
    const double side = std::max(high.x - low.x, high.y - low.y);
    tally t;
    for (int k = 0; k < cases; ++k)
    {
        std::mt19937 random(seed + static_cast<unsigned>(k));
        const auto uniform = [&](double from, double to)
        { return from + (to - from) * (static_cast<double>(random()) / random.max()); };
        const int pins = std::min(20, 1 + static_cast<int>(uniform(0, 20)));
        const double most = uniform(0.05, 0.5);
        auto wanted = constraints(m);
        while (static_cast<int>(wanted.pins().size()) < pins)
        {
            const auto v = static_cast<idx>(random() % free.uv.size());
            const double length = most * side * std::sqrt(uniform(0, 1)), angle = uniform(0, 2 * std::numbers::pi);
            if (!wanted.pins().contains(v))
                wanted.pin(v, free.uv[static_cast<std::size_t>(v)] + length * vec2(std::cos(angle), std::sin(angle)));
        }
        map_result r;
        const double seconds = bench::seconds(
            [&]
            { r = parameterize(q, m, {.constraints = wanted}, {.time_limit = std::chrono::duration<double>(limit)}); });
        bool right = !r || (certify<2>(m.cells(), r.uv).flipped == 0 && test::wound_vertices(m, r.uv).empty());
        for (const auto& [v, pin] : wanted.pins())
            right = right && (!r || r.uv[static_cast<std::size_t>(v)] == pin.value);
        ++t.problems;
        t.valid += static_cast<bool>(r);
        t.infeasible += r.report.outcome == outcome::infeasible;
        t.gave_up += !r && r.report.outcome != outcome::infeasible;
        t.branched += r && r.report.flips.branched > 0;
        t.wrong += !right;
        t.seconds.push_back(seconds);
        results.push_back({{"mesh", name},
                           {"seed", seed + static_cast<unsigned>(k)},
                           {"pins", pins},
                           {"moved", most},
                           {"valid", static_cast<bool>(r)},
                           {"right", right},
                           {"reason", r.reason()},
                           {"stage", stage_of_success(r.report)},
                           {"energy", r.report.solve.value},
                           {"untangle", r.report.seconds.untangle},
                           {"seconds", seconds}});
    }
    print(name, t);
    return t;
}

} // namespace

int main(int argc, char** argv)
try
{
    const bench::options options(argc, argv, {"--cases", "--seed", "--limit"});
    const int cases = std::stoi(options.value("--cases", options.quick ? "4" : "56"));
    const auto seed = static_cast<unsigned>(std::stoul(options.value("--seed", "1")));
    const double limit = std::stod(options.value("--limit", "60"));
    queue q;
    auto report = bench::circumstances(q);
    std::printf("taut %s %s on %s\n\n%-16s %8s %6s %11s %8s %9s %6s %8s %8s\n", TAUT_VERSION_STRING, TAUT_BENCH_COMMIT,
                q.device().name().c_str(), "mesh", "problems", "valid", "infeasible", "gave up", "branched", "wrong",
                "median s", "most s");
    tally all;
    for (const std::filesystem::path path : options.paths)
        all.add(measure(q, path.stem().string(), io::read_surface(path), cases, seed, limit, report["results"]));
    if (options.paths.empty())
        all.add(measure(q, "generated", test::bumpy(options.quick ? 12 : 40), cases, seed, limit, report["results"]));
    print("all", all);
    options.write(report);
    return all.wrong + all.branched == 0 ? 0 : 1;
}
catch (const std::exception& e)
{
    std::fprintf(stderr, "%s\n", e.what());
    return 1;
}
