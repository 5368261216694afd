// SPDX-License-Identifier: MIT
// Solvers side by side on given meshes and their Loop subdivisions: effort to 1 %, 0.1 % and 1e-6 of the best energy,
// from the opening of the file to the map, with every phase of the set-up. Medians of runs that take turns.
#include <charconv>
#include <cstdio>
#include <exception>
#include <sstream>

#include <support/meshes.hpp>

#include <taut/surface_file.hpp>

#include "library_solvers.hpp"
#include "loop_subdivision.hpp"
#include "native.hpp"
#include "peers.hpp"
#include "solve_table.hpp"
#include "stream.hpp"

namespace
{

using namespace bench;
using surface = taut::mesh<taut::triangle>;

std::vector<std::string> words(const std::string& list)
{
    std::vector<std::string> result;
    std::istringstream stream(list);
    for (std::string word; std::getline(stream, word, ',');) result.push_back(word);
    return result;
}

double number(const std::string& text)
{
    double value = 0;
    const auto [end, failure] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (failure != std::errc() || end != text.data() + text.size())
        throw std::invalid_argument("not a number: " + text);
    return value;
}

/// A folder that goes with the object: subdivided meshes are read from files, as users' are.
class scratch_folder
{
public:
    scratch_folder()
    {
        std::string name = (std::filesystem::temp_directory_path() / "taut-bench-XXXXXX").string();
        if (!mkdtemp(name.data())) throw std::runtime_error("cannot make " + name);
        path_ = name;
    }
    ~scratch_folder()
    {
        std::error_code ignored;
        std::filesystem::remove_all(path_, ignored);
    }
    scratch_folder(const scratch_folder&) = delete;
    scratch_folder& operator=(const scratch_folder&) = delete;

    std::filesystem::path write(const surface& m) const
    {
        const auto file = path_ / "mesh.obj";
        taut::io::write_obj(file, m, std::vector<taut::vec2>(m.points().size()));
        return file;
    }

private:
    std::filesystem::path path_;
};

class solve_bench
{
public:
    explicit solve_bench(const options& o)
        : options_(o),
          repeats_(static_cast<int>(number(o.value("--repeats", o.quick ? "2" : "5")))),
          limit_(number(o.value("--limit", "60"))),
          report_(circumstances(queue_))
    {
        if (repeats_ < 1) throw std::invalid_argument("--repeats must be at least 1");
        for (auto table : {library_solvers(queue_), peer_solvers()})
            for (auto& s : table)
                if (chosen(s.name)) solvers_.push_back(std::move(s));
        for (const auto& name : words(options_.value("--solvers", "")))
            if (std::none_of(solvers_.begin(), solvers_.end(), [&](const solver& s) { return s.name == name; }))
                throw std::invalid_argument("--solvers: no solver is called '" + name + "'");
    }

    void run()
    {
        triad_ = options_.quick ? device_triad(queue_, std::size_t{1} << 20) : device_triad(queue_);
        std::printf("taut %s %s on %s, driver %s; triad %.1f GB/s", TAUT_VERSION_STRING, TAUT_BENCH_COMMIT,
                    queue_.device().name().c_str(), queue_.device().driver_version().c_str(), triad_ * 1e-9);
        report_["triad_bytes_a_second"] = triad_;
        if (queue_.device().is_cpu())
        {
            const double host = host_triad();
            std::printf(", in plain C++ %.1f GB/s", host * 1e-9);
            report_["host_triad_bytes_a_second"] = host;
        }
        if (!peer_solvers().empty())
        {
            report_["blas"] = peer_blas();
            std::printf("; peers: one thread, BLAS %s", peer_blas().c_str());
        }
        std::printf(
            "\nSeconds are wall-clock, from the opening of the file, less start-up of the device (kernel builds).\n"
            "Moved: bytes between the device's memory and its kernels, start-up included; of a queue that does "
            "not count them, the least that the elements alone take.\n");

        warm_up();
        for (const auto& path : options_.paths) all_levels(path, taut::io::read_surface(path));
        if (options_.paths.empty()) all_levels("", taut::test::bumpy(options_.quick ? 8 : 60, 0.4));
    }

    const nlohmann::ordered_json& report() const { return report_; }

    /// False if a solver returned a map with a flipped triangle.
    bool right() const { return right_; }

private:
    bool chosen(const std::string& name) const
    {
        const auto list = words(options_.value("--solvers", ""));
        return list.empty() || std::find(list.begin(), list.end(), name) != list.end();
    }

    double host_triad() const
    {
        native::crew workers;
        const std::size_t n = std::size_t{options_.quick ? 1u : 64u} << 17;
        std::vector<double> a(n), b(n, 1), c(n, 2);
        const auto t = interleaved(10, {[&] { native::triad(workers, a, b, 3.0, c); }});
        return 3.0 * sizeof(double) * static_cast<double>(n) / t.front().least;
    }

    /// Every solver once on a small mesh, which fills the caches of kernels.
    void warm_up() const
    {
        const auto file = scratch_.write(taut::test::bumpy(options_.quick ? 4 : 40, 0.3));
        for (const auto& s : solvers_) s.run(file, {.seconds = limit_});
    }

    void all_levels(const std::string& path, surface m)
    {
        const auto levels = words(options_.value("--levels", options_.quick ? "0,1" : "0"));
        int last = 0;
        for (const auto& word : levels) last = std::max(last, static_cast<int>(number(word)));
        for (int level = 0; level <= last; ++level)
        {
            if (level > 0) m = loop_subdivision(m);
            if (std::find(levels.begin(), levels.end(), std::to_string(level)) == levels.end()) continue;
            mesh_result result;
            result.name = path.empty() ? "generated" : std::filesystem::path(path).stem().string();
            result.level = level;
            result.faces = m.cells().size();
            result.vertices = m.points().size();
            const bool as_given = level == 0 && !path.empty();
            measure(result, as_given ? std::filesystem::path(path) : scratch_.write(m));
        }
    }

    void measure(mesh_result& result, const std::filesystem::path& file)
    {
        const std::string given = options_.value("--best", "");
        double best = given.empty() ? std::numeric_limits<double>::infinity() : number(given);
        for (const auto& s : solvers_) result.solvers.push_back({s.name, {}});
        for (int r = 0; r < repeats_; ++r)
            for (std::size_t i = 0; i < solvers_.size(); ++i)
            {
                auto& runs = result.solvers[i].runs;
                if (!runs.empty() && runs.back().limited) continue; // too slow to be worth repeating
                run_limits limits{.seconds = limit_};
                if (!solvers_[i].own_stop && std::isfinite(best)) limits.enough = best * (1 + enough);
                runs.push_back(solvers_[i].run(file, limits));
                right_ = right_ && (!runs.back().valid || runs.back().flipped == 0);
                if (given.empty()) best = std::min(best, result.solvers[i].lowest());
            }
        result.best = best;
        print(result, triad_);
        report_["results"].push_back(to_json(result));
        options_.write(report_); // what is measured stays, whatever comes
    }

    static constexpr double enough = 1e-7; // relative error below which an energy is as good as the best

    const options& options_;
    int repeats_;
    double limit_;
    scratch_folder scratch_;
    taut::queue queue_;
    nlohmann::ordered_json report_;
    std::vector<solver> solvers_;
    double triad_ = 0;
    bool right_ = true;
};

} // namespace

int main(int argc, char** argv)
try
{
    const bench::options options(argc, argv, {"--levels", "--repeats", "--solvers", "--best", "--limit"});
    solve_bench b(options);
    b.run();
    if (!b.right()) std::fprintf(stderr, "a solver flipped a triangle\n");
    return b.right() ? 0 : 1;
}
catch (const std::exception& e)
{
    std::fprintf(stderr, "%s\n", e.what());
    return 1;
}
