// SPDX-License-Identifier: MIT
// Maps whose boundary may not cross itself: 50 generated ramps, ruffs, spirals, combs and crowns, or the meshes that
// are named, each with and without parameterize_params::no_overlap.
//   taut_bench_overlap [--limit SECONDS] [--quick] [--json FILE] [MESH...]
#include <cstdio>
#include <exception>
#include <filesystem>
#include <functional>

#include <support/strips.hpp>

#include <taut/impl/core/mesh/boundary.hpp>
#include <taut/mesh.hpp>
#include <taut/parameterize.hpp>
#include <taut/surface_file.hpp>

#include "measure.hpp"

namespace
{

using namespace taut;

struct subject
{
    std::string name;
    std::function<mesh<triangle>()> make;
};

std::vector<subject> strips()
{
    std::vector<subject> all;
    const auto add = [&all](const char* kind, const std::string& what, std::function<mesh<triangle>()> make) {
        all.push_back({std::string(kind) + ' ' + what, std::move(make)});
    };
    const auto number = [](double x)
    {
        char text[16];
        std::snprintf(text, sizeof text, "%g", x);
        return std::string(text);
    };
    for (const double turns : {1.1, 1.3, 1.6, 2.0, 3.0})
        for (const double inner : {0.8, 0.6, 0.3})
            add("ramp", number(turns) + ", " + number(inner),
                [=] { return test::ramp(static_cast<int>(60 * turns), 8, turns, inner, 1.2 - inner); });
    for (const double turns : {1.2, 1.5, 2.0, 2.5, 3.0})
        for (const double inner : {0.7, 0.4})
            add("ruff", number(turns) + ", " + number(inner),
                [=] { return test::ruff(static_cast<int>(120 * turns), 10, turns, inner, 12); });
    for (const double turns : {2.0, 4.0, 6.0})
        for (const double bump : {0.0, 0.1, 0.3})
            add("spiral", number(turns) + ", " + number(bump),
                [=] { return test::spiral(static_cast<int>(80 * turns), 6, turns, bump); });
    for (const int teeth : {6, 10, 16})
        for (const double opening : {0.6, 0.9, 1.5, 2.0})
            add("comb", number(teeth) + ", " + number(opening), [=] { return test::comb(teeth, 4, 40, opening); });
    for (const int teeth : {3, 4, 6})
        add("crown", number(teeth), [=] { return test::crown(teeth, 60 / teeth / 2, 40); });
    add("large ramp", "1.5, 0.5", [] { return test::ramp(600, 20, 1.5, 0.5, 0.5); });
    return all;
}

int run(const bench::options& options)
{
    std::vector<subject> subjects = strips();
    if (!options.paths.empty()) subjects.clear();
    for (const auto& path : options.paths)
        subjects.push_back(
            {std::filesystem::path(path).filename().string(), [path] { return io::read_surface(path); }});
    if (options.quick) subjects = {subjects.front(), subjects.back()};
    parameterize_params params;
    params.holes = true;
    const run_limits limits{.time_limit = std::chrono::duration<double>(std::stod(options.value("--limit", "60")))};

    queue q;
    auto report = bench::circumstances(q);
    std::printf("%-24s %7s | %9s %9s | %6s %9s %9s %8s %8s\n", "surface", "faces", "crossings", "energy", "rounds",
                "crossings", "energy", "check s", "apart s");
    int crossed = 0, failed = 0;
    for (const auto& [name, make] : subjects)
    {
        const auto m = make();
        const auto loops = boundary_loops(m);
        params.no_overlap = true;
        const auto r = parameterize(q, m, params, limits);
        if (!r)
        {
            std::printf("%-24s %7d | %s\n", name.c_str(), m.cell_count(), r.reason().c_str());
            ++failed;
            continue;
        }
        const auto& overlap = *r.report.overlap;
        double check = 0;
        if (overlap.before.pairs == 0)
        {
            params.no_overlap = false;
            const auto free = parameterize(q, m, params, limits);
            if (free.uv != r.uv) throw std::runtime_error(name + ": another map where there was nothing to do");
            check = bench::seconds([&] { static_cast<void>(boundary_crossings(loops, r.uv)); });
        }
        const bool valid = certify<2>(m.cells(), std::span<const vec2>(r.uv)) && boundary_crossings(loops, r.uv) == 0;
        if (!valid) throw std::runtime_error(name + ": a wrong answer");
        const double before = overlap.before.pairs > 0 ? overlap.energy_before : r.report.solve.value;
        crossed += overlap.before.pairs > 0;
        std::printf("%-24s %7d | %9zu %9.6g | %6d %9zu %9.6g %8.4f %8.3f\n", name.c_str(), m.cell_count(),
                    overlap.before.pairs, before, overlap.rounds, overlap.crossings, r.report.solve.value, check,
                    r.report.seconds.overlap);
        std::fflush(stdout);
        report["results"].push_back({{"surface", name},
                                     {"faces", m.cell_count()},
                                     {"crossings_before", overlap.before.pairs},
                                     {"energy_before", before},
                                     {"rounds", overlap.rounds},
                                     {"crossings", overlap.crossings},
                                     {"energy", r.report.solve.value},
                                     {"stop", to_string(r.report.solve.stop)},
                                     {"seconds", r.report.seconds.overlap}});
    }
    std::printf("%zu surfaces, %d of them crossed themselves without the option, %d without a map\n", subjects.size(),
                crossed, failed);
    options.write(report);
    return failed == 0 ? 0 : 1;
}

} // namespace

int main(int argc, char** argv)
try
{
    return run(bench::options(argc, argv, {"--limit"}));
}
catch (const std::exception& e)
{
    std::fprintf(stderr, "taut_bench_overlap: %s\n", e.what());
    return 2;
}
