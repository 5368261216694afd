// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <chrono>
#include <ctime>
#include <functional>
#include <map>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include <nlohmann/json.hpp>

#include <taut/files.hpp>
#include <taut/queue.hpp>
#include <taut/version.hpp>

#ifndef TAUT_BENCH_COMMIT
#define TAUT_BENCH_COMMIT "unknown"
#endif

/// What the benchmarks share: timing that survives a busy machine, and results with their circumstances.
namespace bench
{

using clock = std::chrono::steady_clock;

template <class F>
double seconds(F&& work)
{
    const auto begin = clock::now();
    work();
    return std::chrono::duration<double>(clock::now() - begin).count();
}

/// Processor seconds of all threads of the process so far, those of a device that is the processor included.
inline double cpu_seconds()
{
    return static_cast<double>(std::clock()) / CLOCKS_PER_SEC;
}

/// Seconds of repeated work. The median is what one gets; the least is what the work costs on an idle machine.
struct timing
{
    double median = 0, least = 0;
};

/// The timing of each piece of work. They take turns, so that what else runs on the machine slows all of them and
/// ratios hold; one round before the first is not counted.
inline std::vector<timing> interleaved(int repeats, const std::vector<std::function<void()>>& works)
{
    std::vector<std::vector<double>> times(works.size());
    for (int r = -1; r < repeats; ++r)
        for (std::size_t i = 0; i < works.size(); ++i)
        {
            const double t = seconds(works[i]);
            if (r >= 0) times[i].push_back(t);
        }
    std::vector<timing> summary;
    for (auto& t : times)
    {
        std::sort(t.begin(), t.end());
        summary.push_back({t[t.size() / 2], t.front()});
    }
    return summary;
}

/// Where, when and with what the figures were measured; `results` is left to fill.
inline nlohmann::ordered_json circumstances(const taut::queue& q)
{
    const auto now = std::time(nullptr);
    char date[32];
    std::strftime(date, sizeof date, "%Y-%m-%dT%H:%M:%SZ", std::gmtime(&now));
    const auto& d = q.device();
    return {{"library", "taut"},
            {"version", TAUT_VERSION_STRING},
            {"commit", TAUT_BENCH_COMMIT},
            {"date", date},
            {"device", d.name()},
            {"platform", d.platform()},
            {"driver", d.driver_version()},
            {"compute_units", d.compute_units()},
            {"host_threads", std::thread::hardware_concurrency()},
            {"results", nlohmann::ordered_json::array()}};
}

/// --quick, --json FILE, further options with a value that the program names, and paths.
struct options
{
    bool quick = false;
    std::string json;
    std::map<std::string, std::string> values; ///< of the further options that were given
    std::vector<std::string> paths;

    /// further: their names, "--levels 0,1" say as "--levels".
    options(int argc, char** argv, const std::vector<std::string>& further = {})
    {
        for (int i = 1; i < argc; ++i)
        {
            const std::string word = argv[i];
            if (word == "--quick")
                quick = true;
            else if (word == "--json" && i + 1 < argc)
                json = argv[++i];
            else if (std::find(further.begin(), further.end(), word) != further.end() && i + 1 < argc)
                values[word] = argv[++i];
            else if (word.starts_with("-"))
                throw std::invalid_argument("unknown option " + word + usage(further));
            else
                paths.push_back(word);
        }
    }

    std::string value(const std::string& name, const std::string& otherwise) const
    {
        const auto found = values.find(name);
        return found == values.end() ? otherwise : found->second;
    }

    void write(const nlohmann::ordered_json& report) const
    {
        if (json.empty()) return;
        taut::io::write_file(json, report.dump(2) + '\n');
    }

private:
    static std::string usage(const std::vector<std::string>& further)
    {
        std::string text = "; usage: [--quick] [--json FILE]";
        for (const auto& name : further) text += " [" + name + " VALUE]";
        return text + " [MESH...]";
    }
};

} // namespace bench
