// SPDX-License-Identifier: MIT
#include "batch/job.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <istream>
#include <map>
#include <set>
#include <sstream>
#include <utility>

#include <nlohmann/json.hpp>

#include <taut/impl/files/file/read_file.hpp>

namespace taut::tools::batch
{

namespace
{

/// A line of a manifest, which knows where it is.
class manifest_line
{
public:
    manifest_line(const std::string& path, std::size_t number, const std::string& text) : path_(path), number_(number)
    {
        std::set<std::string> keys;
        std::string twice;
        const auto note_key = [&](int depth, nlohmann::json::parse_event_t event, nlohmann::json& key)
        {
            if (event == nlohmann::json::parse_event_t::key && depth == 1 &&
                !keys.insert(key.get<std::string>()).second)
                twice = key.get<std::string>();
            return true;
        };
        object_ = nlohmann::json::parse(text, note_key, false);
        if (object_.is_discarded()) refuse("is no JSON");
        if (!object_.is_object()) refuse("is no JSON object");
        if (!twice.empty()) refuse("has the key " + twice + " twice; one would have no effect");
    }

    [[noreturn]] void refuse(const std::string& why) const
    {
        throw io::io_error(path_, why, io::file_place{io::file_place::line, number_});
    }

    job read() const
    {
        job one;
        for (const auto& [key, value] : object_.items())
            if (key == "id")
                one.id = text(key, value);
            else if (key == "args")
                one.args = arguments(value);
            else if (key == "time_limit")
                one.time_limit = positive(key, value);
            else if (key == "memory_limit")
                one.memory_limit = whole_bytes(positive(key, value));
            else
                refuse("has the key " + key + "; there are id, args, time_limit and memory_limit");
        if (one.id.empty()) refuse("has no id; give each job one of its own");
        if (one.args.empty()) refuse("has no args; they are what follows `taut`");
        if (one.args[0] == "batch" || one.args[0] == "view") refuse("`taut " + one.args[0] + "` is no job");
        return one;
    }

private:
    std::string text(const std::string& key, const nlohmann::json& value) const
    {
        if (!value.is_string()) refuse(key + " is no string");
        auto given = value.get<std::string>();
        if (given.find('\0') != std::string::npos) refuse(key + " has a zero byte");
        return given;
    }

    std::vector<std::string> arguments(const nlohmann::json& value) const
    {
        if (!value.is_array()) refuse("args is no list");
        std::vector<std::string> all;
        for (const auto& one : value) all.push_back(text("an argument", one));
        return all;
    }

    double positive(const std::string& key, const nlohmann::json& value) const
    {
        const double x = value.is_number() ? value.get<double>() : 0;
        if (!(x > 0)) refuse(key + " is no positive number");
        return x;
    }

    const std::string& path_;
    std::size_t number_;
    nlohmann::json object_;
};

} // namespace

std::uint64_t whole_bytes(double bytes)
{
    return static_cast<std::uint64_t>(std::clamp(bytes, 1.0, 1e18));
}

std::optional<job> parse_job(const std::string& text, const std::string& path, std::size_t line)
{
    if (text.find_first_not_of(" \t\r") == std::string::npos) return std::nullopt;
    return manifest_line(path, line, text).read();
}

std::string id_in(const std::string& text)
{
    const auto line = nlohmann::json::parse(text, nullptr, false);
    if (!line.is_object() || !line.contains("id") || !line["id"].is_string()) return {};
    return line["id"].get<std::string>();
}

std::vector<job> parse_manifest(std::istream& in, const std::string& path)
{
    std::vector<job> jobs;
    std::map<std::string, std::size_t> line_of;
    std::string text;
    for (std::size_t number = 1; std::getline(in, text); ++number)
    {
        auto one = parse_job(text, path, number);
        if (!one) continue;
        jobs.push_back(std::move(*one));
        const auto [before, fresh] = line_of.emplace(jobs.back().id, number);
        if (!fresh)
            throw io::io_error(path, "has the id " + before->first + " of line " + std::to_string(before->second),
                               io::file_place{io::file_place::line, number});
    }
    if (in.bad()) throw io::io_error(path, "cannot be read; name a file that can");
    return jobs;
}

std::vector<job> read_manifest(const std::string& path)
{
    std::istringstream in(io::impl::read_file(path));
    return parse_manifest(in, path);
}

std::optional<shard> parse_shard(const std::string& text)
{
    shard s;
    const char* const end = text.data() + text.size();
    const auto [slash, bad_index] = std::from_chars(text.data(), end, s.index);
    if (bad_index != std::errc() || slash == end || *slash != '/') return std::nullopt;
    const auto [last, bad_count] = std::from_chars(slash + 1, end, s.count);
    if (bad_count != std::errc() || last != end || s.index < 1 || s.index > s.count) return std::nullopt;
    return s;
}

} // namespace taut::tools::batch
