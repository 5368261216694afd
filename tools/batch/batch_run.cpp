// SPDX-License-Identifier: MIT
#include "batch/batch_run.hpp"

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <deque>
#include <exception>
#include <filesystem>
#include <fstream>
#include <map>
#include <memory>
#include <optional>
#include <sstream>
#include <string>
#include <system_error>
#include <utility>

#include <poll.h>
#include <sched.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include "batch/job_files.hpp"
#include "batch/job_stream.hpp"
#include "batch/kernel_cache.hpp"
#include "shared/exit_codes.hpp"
#include "shared/failure.hpp"
#include "shared/interrupt.hpp"
#include "shared/outputs.hpp"
#include "shared/tile_names.hpp"

namespace taut::tools::batch
{

namespace
{

/// Processors that this process may use.
std::size_t processors()
{
    cpu_set_t set;
    CPU_ZERO(&set);
    const int n = ::sched_getaffinity(0, sizeof set, &set) == 0 ? CPU_COUNT(&set) : 0;
    return n > 0 ? static_cast<std::size_t>(n) : 1;
}

/// That of this process, with a cache of its own and its share of the processors, unless the user has said how many.
std::vector<std::string> environment_of(const kernel_cache& cache, std::size_t threads)
{
    auto all = environment();
    const auto has = [&](const std::string& name)
    { return std::any_of(all.begin(), all.end(), [&](const auto& v) { return v.starts_with(name + '='); }); };
    for (const std::string name : {"TAUT_THREADS", "POCL_MAX_PTHREAD_COUNT"})
        if (!has(name)) all.push_back(name + '=' + std::to_string(threads));
    std::erase_if(all, [](const auto& v) { return v.starts_with("POCL_CACHE_DIR="); });
    all.push_back("POCL_CACHE_DIR=" + cache.folder().string());
    return all;
}

/// By which it shows that a file was written since.
struct file_state
{
    dev_t device = 0;
    ino_t number = 0;
    off_t size = -1; ///< there is no such file
    timespec changed = {};

    explicit file_state(const std::string& path)
    {
        struct stat s = {};
        if (::stat(path.c_str(), &s) != 0) return;
        device = s.st_dev, number = s.st_ino, size = s.st_size, changed = s.st_ctim;
    }

    bool operator==(const file_state& o) const
    {
        return device == o.device && number == o.number && size == o.size && changed.tv_sec == o.changed.tv_sec &&
               changed.tv_nsec == o.changed.tv_nsec;
    }
};

std::optional<nlohmann::ordered_json> parsed(std::istream&& in)
{
    auto json = nlohmann::ordered_json::parse(in, nullptr, false);
    return json.is_discarded() ? std::nullopt : std::optional(std::move(json));
}

/// Files that a job at work keeps open here: two pipes, its end, the lock of its cache.
constexpr std::size_t files_of_job = 4;
/// And those that are open for a moment while one is started, looked at and written down.
constexpr std::size_t files_of_batch = 10;

std::size_t open_files()
{
    std::error_code failure;
    std::size_t count = 0;
    for (std::filesystem::directory_iterator all("/proc/self/fd", failure), end; !failure && all != end;
         all.increment(failure))
        ++count;
    return count;
}

/// A job at work.
class running_job
{
public:
    running_job(const job& j, job_files files, const std::vector<std::string>& environment, limits bounds)
        : job_(j), files_(std::move(files)), inputs_(hashes_of(files_.inputs))
    {
        for (const auto& path : files_.outputs) before_.emplace(path, file_state(path));
        bounds.seconds = j.time_limit.value_or(bounds.seconds);
        bounds.memory = j.memory_limit.value_or(bounds.memory);
        child_ = std::make_unique<child>(j.args, environment, bounds);
    }

    child& process() { return *child_; }

    result result_of(const child_end& end) const
    {
        std::vector<std::string> written;
        auto now = before_;
        for (const auto& name : files_.tiles)
            for (const auto& tile : tile_files(name)) now.try_emplace(tile.string(), ""); // was not there
        for (const auto& [path, state] : now)
            if (!(file_state(path) == state)) written.push_back(path);
        std::optional<nlohmann::ordered_json> stats;
        if (files_.stats == standard_output)
            stats = parsed(std::istringstream(end.printed));
        else if (std::error_code unknown; std::filesystem::is_regular_file(files_.stats, unknown) && // no pipe
                                          std::find(written.begin(), written.end(), files_.stats) != written.end())
            stats = parsed(std::ifstream(files_.stats));
        return make_result(job_, end, inputs_, hashes_of(written), stats);
    }

private:
    const job& job_;
    job_files files_;
    hashes inputs_;
    std::map<std::string, file_state> before_; ///< of the outputs
    std::unique_ptr<child> child_;
};

/// Slot of a running job.
struct worker
{
    std::unique_ptr<kernel_cache> cache;
    std::vector<std::string> environment;
    std::unique_ptr<running_job> at_work;
};

class batch_run
{
public:
    batch_run(const std::vector<job>& jobs, result_file& results, const run_options& options,
              const std::function<void(const tally&)>& tell)
        : jobs_(jobs.begin(), jobs.end()), results_(results), options_(options), tell_(tell)
    {
        if (options.from_standard_input)
            stream_.emplace(STDIN_FILENO, "standard input",
                            [this](const std::string& id, const std::string& why)
                            {
                                ++refused_;
                                refuse(id, result::array(), exit_code::unreadable_input, why);
                            });
        if (options.resume) before_ = results.read();
    }

    tally operator()()
    {
        while (may_start() || count_.running > 0 || may_come())
        {
            if (interrupted()) stop();
            if (may_come() && next_ + at_once_ > jobs_.size()) stream_->read(jobs_);
            count_.jobs = jobs_.size() + refused_;
            fill();
            wait();
            look();
            tell_(count_);
        }
        if (failure_) std::rethrow_exception(failure_);
        return count_;
    }

private:
    static constexpr int pause = 20; ///< milliseconds between two looks at what jobs use

    bool may_start() const { return next_ < jobs_.size() && !interrupted() && !failure_; }

    bool may_come() const { return stream_ && !stream_->ended() && !interrupted() && !failure_; }

    /// The answer to what is not run.
    void refuse(const std::string& id, const result& args, exit_code code, const std::string& why)
    {
        child_end end;
        end.code = to_int(code);
        results_.append({{"id", id}, {"args", args}, {"code", end.code}, {"outcome", outcome_of(end)}, {"error", why}});
        ++count_.done, ++count_.failed;
    }

    /// Gives work to those who have none.
    void fill()
    {
        for (auto& w : workers_)
            if (!w.at_work && count_.running < at_once_) start(w);
        while (workers_.size() < at_once_ && may_start()) start(workers_.emplace_back());
    }

    void start(worker& w)
    {
        while (may_start())
        {
            const job& j = jobs_[next_++];
            auto files = arguments_.files(j.args);
            if (skipped(j, files)) continue;
            job_conflicts with_batch(options_.own); // as links are now
            with_batch.add(j.id, files);
            if (const auto why = with_batch.found(); !why.empty())
            {
                refuse(j.id, j.args, exit_code::usage, why);
                continue;
            }
            try
            {
                if (!w.cache)
                {
                    w.cache = std::make_unique<kernel_cache>(options_.caches);
                    w.environment = environment_of(*w.cache, std::max<std::size_t>(1, processors() / options_.at_once));
                }
                w.at_work = std::make_unique<running_job>(j, std::move(files), w.environment, options_.bounds);
                ++count_.running;
            }
            catch (const std::system_error& e) // the system has no room for one more; when one ends, it has
            {
                if (count_.running == 0) throw usage_error(std::string("no job can be started: ") + e.what());
                at_once_ = count_.running;
                --next_;
            }
            catch (const error&) // once those at work have ended
            {
                failure_ = std::current_exception();
            }
            return;
        }
    }

    bool skipped(const job& j, const job_files& files)
    {
        const auto found = before_.find(j.id);
        if (found == before_.end()) return false;
        const bool good = succeeded(found->second);
        if ((options_.retry && !good) || !stands(found->second, j, files)) return false;
        ++count_.skipped;
        if (!good) ++count_.failed_before;
        return true;
    }

    void wait() const
    {
        std::vector<pollfd> news;
        for (const auto& w : workers_)
            if (w.at_work)
                for (const auto& one : w.at_work->process().news()) news.push_back(one);
        if (may_come() && next_ >= jobs_.size()) news.push_back({stream_->file(), POLLIN, 0});
        if (!news.empty()) ::poll(news.data(), news.size(), pause);
    }

    void look()
    {
        for (auto& w : workers_)
        {
            if (!w.at_work) continue;
            const auto end = w.at_work->process().look();
            if (!end) continue;
            const auto ended = std::exchange(w.at_work, nullptr);
            --count_.running;
            if (belongs_to_interruption(*end)) continue;
            const auto r = ended->result_of(*end);
            results_.append(r);
            ++count_.done;
            if (!succeeded(r)) ++count_.failed;
        }
    }

    /// Returns whether a job ended with the batch: schedulers that end a group of processes may reach it first.
    static bool belongs_to_interruption(const child_end& end)
    {
        if (end.by == child_end::asked) return true;
        const bool signalled = end.code == to_int(exit_code::interrupted) || end.code == to_int(exit_code::terminated);
        if (!signalled || end.by != child_end::itself) return false;
        for (int k = 0; k < 10 && !interrupted(); ++k) ::poll(nullptr, 0, 10);
        return interrupted();
    }

    void stop()
    {
        for (auto& w : workers_)
            if (w.at_work) w.at_work->process().stop(SIGINT);
    }

    std::deque<job> jobs_; // those at work are referred to
    std::optional<job_stream> stream_;
    std::size_t refused_ = 0;
    result_file& results_;
    const run_options& options_;
    const std::function<void(const tally&)>& tell_;
    std::map<std::string, earlier_result> before_;
    argument_reader arguments_;
    std::vector<worker> workers_;
    std::size_t at_once_ = options_.at_once;
    std::exception_ptr failure_; ///< why no more jobs are started
    std::size_t next_ = 0;
    tally count_;
};

} // namespace

std::size_t most_jobs_at_once(std::size_t wanted)
{
    const std::size_t needed = open_files() + files_of_batch + files_of_job * wanted;
    rlimit limit{};
    if (::getrlimit(RLIMIT_NOFILE, &limit) != 0 || limit.rlim_cur >= needed) return wanted;
    limit.rlim_cur = std::min<rlim_t>(limit.rlim_max, needed);
    ::setrlimit(RLIMIT_NOFILE, &limit);
    ::getrlimit(RLIMIT_NOFILE, &limit);
    const std::size_t lacking = needed - std::min<std::size_t>(needed, limit.rlim_cur);
    return wanted - std::min(wanted, (lacking + files_of_job - 1) / files_of_job);
}

tally run_jobs(const std::vector<job>& jobs, result_file& results, const run_options& options,
               const std::function<void(const tally&)>& tell)
{
    return batch_run(jobs, results, options, tell)();
}

} // namespace taut::tools::batch
