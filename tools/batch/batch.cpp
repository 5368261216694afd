// SPDX-License-Identifier: MIT
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <iostream>
#include <limits>
#include <memory>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include <picture/format.hpp>

#include "batch/batch_run.hpp"
#include "batch/job.hpp"
#include "batch/job_conflicts.hpp"
#include "batch/kernel_cache.hpp"
#include "batch/scheduler_shard.hpp"
#include "commands.hpp"
#include "shared/failure.hpp"
#include "shared/interrupt.hpp"
#include "shared/outputs.hpp"
#include "shared/progress.hpp"
#include "shared/run_clock.hpp"
#include "shared/shared_options.hpp"
#include "shared/text_table.hpp"
#include "shared/writing.hpp"

#include <taut/impl/files/file/atomic_file_bodies.hpp>

namespace taut::tools
{

namespace
{

struct batch_options
{
    std::string manifest, out = standard_output, shard = "1/1", cache, progress;
    int jobs = 1;
    double memory_limit = std::numeric_limits<double>::infinity();
    batch::run_options run;
    bool quiet = false;
};

/// "152 jobs: 140 done, 3 of them failed, 12 left out as done before; 61.2 s"
std::string summary(const batch::tally& t, double seconds)
{
    std::ostringstream out;
    out << t.jobs << (t.jobs == 1 ? " job: " : " jobs: ") << t.done << " done";
    if (t.failed > 0) out << ", " << t.failed << " of them failed";
    if (t.skipped > 0) out << ", " << t.skipped << " left out as done before";
    if (t.failed_before > 0) out << ", " << t.failed_before << " of these failed";
    const std::size_t open = t.jobs - t.done - t.skipped;
    if (open > 0) out << ", " << open << " still to do";
    out << "; " << io::impl::format_number(std::round(seconds * 10) / 10, 6) << " s\n";
    return out.str();
}

exit_code run(batch_options options, const outputs& files, const run_clock& clock)
{
    const bool automatic = options.shard == "auto";
    const auto part = automatic ? batch::scheduler_shard([](const char* name) { return std::getenv(name); })
                                : batch::parse_shard(options.shard);
    if (!part && automatic)
        throw usage_error("--shard auto: no scheduler says which part this is (SLURM_ARRAY_TASK_ID, SGE_TASK_ID, "
                          "AWS_BATCH_JOB_ARRAY_INDEX, JOB_COMPLETION_INDEX, SLURM_PROCID, OMPI_COMM_WORLD_RANK, "
                          "PMI_RANK); give --shard i/N");
    if (!part) throw usage_error("--shard " + options.shard + ": is no i/N with i from 1 to N");
    if (options.run.from_standard_input == !options.manifest.empty())
        throw usage_error("jobs come from --manifest or from --stdin: give one of them");
    if (options.run.from_standard_input && part->count > 1)
        throw usage_error("--stdin takes all jobs; --shard is for a manifest");
    if (options.run.resume && io::impl::is_stream(options.out))
        throw usage_error("--resume needs the file of results: name it with --output");
    const char* const place = options.quiet ? nullptr : files.place_of_report();

    options.run.caches = options.cache.empty() ? batch::default_caches() : std::filesystem::path(options.cache);
    options.run.own = {options.run.from_standard_input ? standard_input : options.manifest, options.out,
                       options.run.caches.string()};
    std::vector<batch::job> jobs, own;
    if (!options.run.from_standard_input) jobs = batch::read_manifest(options.manifest);
    batch::require_own_files(jobs, options.run.own);
    for (std::size_t k = 0; k < jobs.size(); ++k)
        if (part->has(k)) own.push_back(std::move(jobs[k]));
    if (std::isfinite(options.memory_limit)) options.run.bounds.memory = batch::whole_bytes(options.memory_limit);
    const auto wanted = static_cast<std::size_t>(options.jobs);
    options.run.at_once = batch::most_jobs_at_once(wanted);
    if (options.run.at_once == 0) throw usage_error("--jobs: too few files may be open for a job; raise `ulimit -n`");
    if (options.run.at_once < wanted && !options.quiet)
        std::cerr << "taut: note: --jobs " << wanted << ": so few files may be open that "
                  << count(options.run.at_once, "job is", "jobs are")
                  << " at work at once; `ulimit -n` says how many\n";
    options.run.resume |= options.run.retry;

    batch::result_file results(options.out);
    progress shown(progress_of(options.progress, options.quiet), std::cerr);
    keep(true); // from here on Ctrl-C ends the jobs first
    const auto tell = [&](const batch::tally& t)
    {
        const std::string phase = std::to_string(t.running) + " at work, " + std::to_string(t.failed) + " failed";
        shown.update({.phase = phase,
                      .step = static_cast<int>(t.done + t.skipped),
                      .most_steps = static_cast<int>(t.jobs),
                      .seconds = clock.now()});
    };
    batch::tally t;
    writing([&] { t = batch::run_jobs(own, results, options.run, tell); });
    shown.finish();
    if (place && has_reader(place)) writing([&] { io::write_file(place, summary(t, clock.now())); });
    return t.failed + t.failed_before > 0 && !interrupted() ? exit_code::some_failed : exit_code::valid;
}

} // namespace

command add_batch(command_line& program, std::chrono::steady_clock::time_point launch)
{
    const auto options = std::make_shared<batch_options>();
    auto& o = *options;
    const auto app = program.add_subcommand("batch", "Run many calls of this program, each within its limits");
    add_input(
        app, "--manifest", o.manifest, "the manifest",
        R"(The jobs, one JSON object per line: {"id": "a", "args": ["unwrap", "a.obj", "-o", "flat.obj"]}, and in it, )"
        R"(if wanted, "time_limit": S and "memory_limit": BYTES)")
        .type_name("FILE.jsonl");
    app.add_flag("--stdin", o.run.from_standard_input,
                 "Read jobs from standard input, one manifest line each, until it ends");
    add_output(app, "-o,--output", o.out, {.otherwise = standard_output},
               "Append the results, one JSON object per line; - is standard output")
        .type_name("FILE.jsonl");
    app.rename("--out", "--output");
    app.add_option("--shard", o.shard, "Only part i of N of the jobs, i from 1 to N; auto: from the scheduler")
        .type_name("i/N|auto");
    app.add_flag("--resume", o.run.resume,
                 "Skip jobs with a result in --output for the same arguments and inputs, if the outputs exist");
    app.add_flag("--retry", o.run.retry, "As --resume, but run failed jobs again");
    app.add_option("--jobs", o.jobs, "Number of jobs at once; they share the processors")
        .type_name("N")
        .check(number_that([](double x) { return x >= 1 && x <= 4096; }, "must be from 1 to 4096"))
        .capture_default_str();
    add_time_limit(app, o.run.bounds.seconds,
                   "Default time limit of jobs: they end after S seconds, with their best result");
    app.add_option("--memory-limit", o.memory_limit, "Default memory limit of jobs")
        .type_name("BYTES")
        .check(number_that([](double x) { return x >= 1; }, "must be at least 1"));
    app.add_option("--grace", o.run.bounds.grace, "Time to write the best result, before a job is killed")
        .type_name("S")
        .check(number_that([](double x) { return x >= 0; }, "must not be negative"))
        .capture_default_str();
    app.add_option("--cache", o.cache, "Folder of compiled kernels, with a subfolder for each running job")
        .type_name("FOLDER");
    add_progress(app, o.progress, o.quiet);
    app.footer("exit codes: 0 all jobs have a valid map; 10 all ran, and some failed; 2, 3 as for other "
               "commands;\n  130, 143 interrupted: --resume runs the unfinished jobs again");
    return [options, launch](const outputs& files) { return run(*options, files, run_clock(launch)); };
}

} // namespace taut::tools
