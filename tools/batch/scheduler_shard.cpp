// SPDX-License-Identifier: MIT
#include "batch/scheduler_shard.hpp"

#include <charconv>
#include <cstddef>
#include <string_view>

#include "shared/failure.hpp"

namespace taut::tools::batch
{

namespace
{

/// How a scheduler numbers what it starts: from `first` in steps, as many as `count`, or up to `last`. Numbers or names
/// of variables; empty: there is none.
struct numbering
{
    const char* index;
    const char* first;
    const char* step;
    const char* count;
    const char* last;
};

constexpr numbering arrays[] = {
    {"SLURM_ARRAY_TASK_ID", "SLURM_ARRAY_TASK_MIN", "SLURM_ARRAY_TASK_STEP", "SLURM_ARRAY_TASK_COUNT", ""},
    {"SGE_TASK_ID", "SGE_TASK_FIRST", "SGE_TASK_STEPSIZE", "", "SGE_TASK_LAST"},
    {"AWS_BATCH_JOB_ARRAY_INDEX", "", "", "AWS_BATCH_JOB_ARRAY_SIZE", ""},
    {"JOB_COMPLETION_INDEX", "", "", "JOB_COMPLETIONS", ""}};
constexpr numbering processes[] = {{"SLURM_PROCID", "", "", "SLURM_NTASKS", ""},
                                   {"OMPI_COMM_WORLD_RANK", "", "", "OMPI_COMM_WORLD_SIZE", ""},
                                   {"PMI_RANK", "", "", "PMI_SIZE", ""}};

using variables = std::function<const char*(const char*)>;

std::optional<std::size_t> number(const variables& variable, const char* name)
{
    const char* const value = *name ? variable(name) : nullptr;
    if (!value || std::string_view(value) == "undefined") return std::nullopt; // as Grid Engine says outside of arrays
    const std::string_view digits(value);
    std::size_t n = 0;
    const auto [end, failure] = std::from_chars(digits.data(), digits.data() + digits.size(), n);
    if (failure != std::errc() || end != digits.data() + digits.size())
        throw usage_error("--shard auto: " + std::string(name) + " is \"" + value + "\", which is no number");
    return n;
}

std::optional<shard> by(const numbering& how, const variables& variable)
{
    const auto index = number(variable, how.index);
    if (!index) return std::nullopt;
    const std::size_t first = number(variable, how.first).value_or(0), step = number(variable, how.step).value_or(1);
    auto count = number(variable, how.count);
    if (const auto last = number(variable, how.last); last && step > 0 && *last >= first)
        count = (*last - first) / step + 1;
    if (!count)
        throw usage_error("--shard auto: " + std::string(how.index) + " is set, but not " +
                          (*how.count ? how.count : how.last) + ", the number of parts; set it, or give --shard i/N");
    const std::size_t place = step > 0 && *index >= first ? (*index - first) / step : *count;
    if (place >= *count)
        throw usage_error("--shard auto: " + std::string(how.index) + " is " + std::to_string(*index) + ", beyond " +
                          std::to_string(*count) + " parts");
    return shard{place + 1, *count};
}

template <std::size_t N>
std::optional<shard> first_of(const numbering (&all)[N], const variables& variable)
{
    for (const auto& how : all)
        if (const auto found = by(how, variable)) return found;
    return std::nullopt;
}

} // namespace

std::optional<shard> scheduler_shard(const variables& variable)
{
    const auto task = first_of(arrays, variable), process = first_of(processes, variable);
    if (!task || !process) return task ? task : process;
    return shard{(task->index - 1) * process->count + process->index, task->count * process->count};
}

} // namespace taut::tools::batch
