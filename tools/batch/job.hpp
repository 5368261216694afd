// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <iosfwd>
#include <optional>
#include <string>
#include <vector>

namespace taut::tools::batch
{

/// One call of the program.
struct job
{
    std::string id;                            ///< unique in its manifest
    std::vector<std::string> args;             ///< as after `taut`
    std::optional<double> time_limit;          ///< seconds; nothing: that of the run
    std::optional<std::uint64_t> memory_limit; ///< bytes of resident memory; nothing: that of the run
};

/// A limit of memory in whole bytes, at least one, and no more than any machine has.
std::uint64_t whole_bytes(double bytes);

/// Reads a manifest: a JSON object a line, `{"id": "...", "args": ["unwrap", ...], "time_limit": S, "memory_limit":
/// BYTES}`, the last two as wanted. Empty lines count and mean nothing.
/// Throws io::io_error with the line: what is no such object, has another key, an id twice, no argument, or a command
/// that is no job (`batch` itself, and `view`, which waits for a person).
std::vector<job> read_manifest(const std::string& path);
/// One line of it; none for an empty one. Throws io::io_error.
std::optional<job> parse_job(const std::string& text, const std::string& path, std::size_t line);
/// The id that a line names, be it a job or not; empty if it names none.
std::string id_in(const std::string& text);
std::vector<job> parse_manifest(std::istream& text, const std::string& path);

/// A part of the jobs of a manifest, number `index` of `count`, from 1: every count-th job, so that parts are equally
/// long and no job is in two of them.
struct shard
{
    std::size_t index = 1, count = 1;

    bool has(std::size_t job) const noexcept { return job % count == index - 1; }
};

/// Parses `3/8`. None if it is no such pair of numbers.
std::optional<shard> parse_shard(const std::string& text);

} // namespace taut::tools::batch
