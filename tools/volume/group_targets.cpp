// SPDX-License-Identifier: MIT
#include "volume/group_targets.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <limits>
#include <numbers>
#include <string_view>
#include <type_traits>
#include <utility>

#include <taut/constraints.hpp>
#include <taut/impl/core/mesh/describe.hpp>
#include <taut/surface_file.hpp>

#include "shared/failure.hpp"
#include "shared/text_table.hpp"

namespace taut::tools
{

namespace
{

/// The ways to transform a group, and how many numbers each takes.
constexpr std::array<std::pair<const char*, std::size_t>, 3> transforms = {
    {{":translate:", 3}, {":rotate:", 4}, {":scale:", 1}}};

} // namespace

std::string file_of_move(const std::string& text)
{
    for (const auto& [key, count] : transforms)
        if (text.find(key) != text.npos) return {};
    const auto at = text.rfind('=');
    return at == text.npos ? std::string() : text.substr(at + 1);
}

std::vector<double> numbers_of(const std::string& text, std::size_t count, const std::string& option)
{
    std::vector<double> numbers;
    for (std::size_t begin = 0; begin <= text.size();)
    {
        const std::size_t end = std::min(text.find(',', begin), text.size());
        double x = 0;
        const auto [last, failure] = std::from_chars(text.data() + begin, text.data() + end, x);
        if (failure != std::errc{} || last != text.data() + end || !std::isfinite(x))
            throw usage_error(option + ": '" + text.substr(begin, end - begin) + "' is no number; write one");
        numbers.push_back(x);
        begin = end + 1;
    }
    if (numbers.size() != count)
        throw usage_error(option + ": give " + std::to_string(count) + " numbers with commas between");
    return numbers;
}

void require_half_turns(const std::vector<std::string>& moves)
{
    const auto& [key, count] = transforms[1];
    for (const auto& move : moves)
        if (const auto at = move.rfind(key); at != move.npos)
            if (std::abs(numbers_of(move.substr(at + std::string_view(key).size()), count, "--move " + move)[3]) > 180)
                throw usage_error("--move " + move +
                                  ": rotations are of 180 degrees at most here; make several runs, "
                                  "or use `taut deform`");
}

rigid_motion<3> motion_of(const std::string& group, const vec3& middle, const std::vector<double>& numbers)
{
    rigid_motion<3> motion{.from = middle, .to = middle};
    if (numbers.size() == 4)
    {
        const vec3 axis(numbers[0], numbers[1], numbers[2]);
        const double largest = std::max({std::abs(axis.x), std::abs(axis.y), std::abs(axis.z)});
        if (!(largest > 0))
            throw usage_error("--move " + group + ": the axis of a rotation has no length; give one that has");
        motion.axis = glm::normalize(axis / largest); // whose length may be beyond the range of numbers
        motion.angle = numbers[3] * std::numbers::pi / 180;
    }
    if (numbers.size() == 3) motion.to += vec3(numbers[0], numbers[1], numbers[2]);
    return motion;
}

group_targets::group_targets(const io::volume_file& file) : file_(file)
{
    constexpr double digits = 1e-10;
    vec3 low(std::numeric_limits<double>::infinity()), high = -low;
    for (const vec3& p : file.points) low = glm::min(low, digits * p), high = glm::max(high, digits * p);
    for (int k = 0; k < 3; ++k) rounding_ = std::max(rounding_, high[k] - low[k]);
}

void group_targets::fix(const std::string& name)
{
    for (const idx v : group(name).vertices) take(v, point(v), name);
}

void group_targets::move(const std::string& text)
{
    for (const auto& [key, count] : transforms)
        if (const auto at = text.rfind(key); at != text.npos)
            return transform(text.substr(0, at), count,
                             numbers_of(text.substr(at + std::string_view(key).size()), count, "--move " + text));
    const auto at = text.rfind('=');
    if (at == text.npos)
        throw usage_error("--move " + text +
                          ": give GROUP=FILE.csv, GROUP:translate:x,y,z, "
                          "GROUP:rotate:ax,ay,az,degrees or GROUP:scale:factor");
    const std::string name = text.substr(0, at);
    const auto& members = group(name).vertices;
    const auto path = text.substr(at + 1);
    const auto place = [&](const auto& p, const vec3& target)
    {
        if (!std::binary_search(members.begin(), members.end(), p.vertex))
            throw unsuitable_input(path + ": vertex " + std::to_string(p.vertex) + " is not in group " + name +
                                   "; leave its line out, or use --pins");
        constexpr int D = std::decay_t<decltype(p.target)>::length();
        if (!p.hard() || p.held != taut::impl::fixed_marks<D>::every)
            throw unsuitable_input(path + ": vertex " + std::to_string(p.vertex) +
                                   " has a weight or lacks a coordinate; use --pins for those");
        take(p.vertex, target, name);
    };
    const auto vertices = static_cast<idx>(file_.points.size());
    if (file_.dimension == 3)
        for (const auto& p : io::read_pins<3>(path, vertices)) place(p, p.target);
    else
        for (const auto& p : io::read_pins<2>(path, vertices, file_.points.front().z))
            place(p, vec3(p.target, point(p.vertex).z));
}

void group_targets::transform(const std::string& name, std::size_t kind, const std::vector<double>& n)
{
    const auto& members = group(name).vertices;
    vec3 middle(0.0);
    for (const idx v : members) middle += point(v) / static_cast<double>(members.size());
    const auto motion = motion_of(name, middle, n);
    for (const idx v : members) take(v, kind == 1 ? middle + n[0] * (point(v) - middle) : motion(point(v)), name);
    rotations_.emplace_back(members, motion);
}

std::string group_targets::note() const
{
    if (settled_.empty()) return {};
    return taut::impl::list_ids("vertex", "vertices", settled_) +
           " in two groups with positions that differ by rounding; the first one counts, --fix before --move";
}

void group_targets::take(idx v, const vec3& x, const std::string& name)
{
    if (const double plane = point(v).z; file_.dimension == 2 && std::abs(x.z - plane) > rounding_)
        throw unsuitable_input("vertex " + std::to_string(v) + " of " + name + " goes to z = " + number(x.z) +
                               ", out of the plane of the mesh, z = " + number(plane) +
                               "; give a motion within it: rotations about 0,0,1");
    const auto [at, is_new] = targets_.try_emplace(v, x);
    const auto apart = [&, at = at](int k) { return std::abs(at->second[k] - x[k]) > rounding_; };
    if (!is_new && at->second != x && !apart(0) && !apart(1) && !apart(2))
    {
        settled_.push_back(v);
        return;
    }
    if (!is_new && at->second != x && owner_[v] == name)
        throw unsuitable_input("group " + name + " is to be at two places, as vertex " + std::to_string(v) +
                               " shows; give it one --move, or --fix alone");
    if (!is_new && at->second != x)
        throw unsuitable_input("vertex " + std::to_string(v) + " is in " + owner_[v] + " and in " + name +
                               ", which go different ways; leave it to one of them");
    owner_[v] = name;
}

} // namespace taut::tools
