// SPDX-License-Identifier: MIT
#include <cstdint>
#include <set>
#include <string>

#include <sys/mman.h>
#include <unistd.h>

#include "../../tools/batch/content_hash.cpp"
#include "../../tools/batch/job.cpp"
#include "../../tools/batch/result.cpp"
#include "budget.hpp"
#include "mutator.hpp"
#include "require.hpp"

namespace
{

using namespace taut;
using fuzz::dice;
namespace batch = tools::batch;

/// A value of JSON, seldom a deep one.
std::string value(dice& random, int depth = 0)
{
    if (random.one_in(400)) return std::string(random.between(1, 2000), random.one_in(2) ? '[' : '{');
    switch (random.below(depth > 3 ? 4 : 6))
    {
    case 0:
        return random.number();
    case 1:
        return '"' + std::string(random.pick({"", "a", "\\u0000", "\\ud800", "-o", "x.obj", "batch", "view"})) + '"';
    case 2:
        return std::string(random.pick({"null", "true", "false", "1e400", "-1"}));
    case 3:
        return "\"unwrap\"";
    case 4:
        return '[' + value(random, depth + 1) + ", " + value(random, depth + 1) + ']';
    default:
        return "{\"" + std::string(random.pick({"id", "args", "code", "a"})) + "\": " + value(random, depth + 1) + '}';
    }
}

/// Jobs or results, one a line.
std::string generate(dice& random)
{
    const bool jobs = random.one_in(2);
    std::string text;
    for (std::size_t n = random.between(1, 5); n > 0; --n)
    {
        const auto of = [&](const std::string& usual) { return random.one_in(12) ? value(random) : usual; };
        text += "{\"id\": " + of('"' + random.count(5) + '"') +
                ", \"args\": " + of(R"(["unwrap", "in.obj", "-o", "out.obj"])");
        if (jobs && random.one_in(3)) text += ", \"time_limit\": " + of("60");
        if (jobs && random.one_in(3)) text += ", \"memory_limit\": " + of("1e9");
        if (!jobs) text += ", \"code\": " + of("0") + ", \"inputs\": " + of(R"({"in.obj": null})");
        if (!jobs) text += ", \"outputs\": " + of("{}") + ", \"stats\": " + of("{}");
        if (random.one_in(20)) text += ", \"more\": " + value(random);
        text += std::string(random.one_in(30) ? "" : "}") + std::string(random.one_in(30) ? "" : "\n");
    }
    return text;
}

/// A file without a name.
class nameless_file
{
public:
    nameless_file(const std::uint8_t* data, std::size_t size) : number_(::memfd_create("fuzz", 0))
    {
        fuzz::require(number_ >= 0 && ::write(number_, data, size) == static_cast<ssize_t>(size), "a file");
    }
    ~nameless_file() { ::close(number_); }
    nameless_file(const nameless_file&) = delete;
    nameless_file& operator=(const nameless_file&) = delete;

    std::string path() const { return "/proc/self/fd/" + std::to_string(number_); }

private:
    int number_;
};

} // namespace

extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size, std::size_t most, unsigned seed)
{
    return taut::fuzz::mutate(data, size, most, seed, generate);
}

/// Whatever the bytes: jobs have an id of their own and arguments, results an id, or they are an error of the library.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
    const nameless_file file(data, size);
    const taut::fuzz::budget limit(size);
    std::vector<batch::job> jobs;
    try
    {
        jobs = batch::read_manifest(file.path());
        std::set<std::string> ids;
        for (const auto& job : jobs)
        {
            fuzz::require(!job.args.empty() && ids.insert(job.id).second, "jobs have arguments and ids of their own");
            fuzz::require(job.time_limit.value_or(1) > 0, "a limit is positive");
        }
    }
    catch (const error&)
    {
    }
    try
    {
        for (const auto& [id, result] : batch::result_file(file.path()).read())
        {
            fuzz::require(result["id"] == id, "a result has its id");
            batch::succeeded(result);
            for (const auto& job : jobs) batch::stands(result, job, {});
        }
    }
    catch (const error&)
    {
    }
    return 0;
}
