// SPDX-License-Identifier: MIT
#include "mpi/ranged_targets.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <string_view>
#include <utility>

#include <taut/impl/dist/processes/fixed_sum.hpp>
#include <taut/impl/dist/ranges/line_layout.hpp>
#include <taut/impl/files/surface/pins.hpp>
#include <taut/surface_file.hpp>
#include <taut/volume_file.hpp>

#include "shared/failure.hpp"
#include "volume/group_targets.hpp"

namespace taut::tools::mpi
{

namespace
{

using dist::impl::communicator;
using dist::impl::ranged_volume;

/// A place for a vertex, by one of the options.
struct wish
{
    std::int64_t id;
    vec3 x;
    int option; ///< in the order of the program
};

/// Lines of a file of pins, read by ranges where all processes can, else by the first one. Throws io_error. Collective.
std::vector<io::pin<3>> pins_of(const communicator& all, const std::string& path, std::int64_t vertices)
{
    const auto most = static_cast<idx>(std::min<std::int64_t>(vertices, std::numeric_limits<idx>::max()));
    std::vector<io::pin<3>> mine;
    try
    {
        const dist::impl::text_ranges lines(all, path, '#',
                                            [](std::string_view line)
                                            { return dist::impl::blank_or(line, '#', dist::impl::line_kind::item); });
        dist::impl::suited(all,
                           [&]
                           {
                               try
                               {
                                   mine = io::impl::parse_pins<3>(lines.text(), path, most);
                               }
                               catch (const io::io_error& e)
                               {
                                   throw dist::impl::unsuited(e.what());
                               }
                           });
    }
    catch (const dist::impl::unsuited&)
    {
        mine.clear();
        all.together(
            [&]
            {
                if (all.rank() == 0) mine = io::read_pins<3>(path, most); // which says what is wrong, and where
            });
    }
    return mine;
}

class collector
{
public:
    collector(const ranged_volume& volume, const std::string& path) : volume_(volume), all_(volume.processes())
    {
        names_.path = path;
        for (const auto& g : volume.groups) names_.groups.push_back({g.name, g.dimension, {}});
        constexpr double digits = 1e-10;
        vec3 low(std::numeric_limits<double>::infinity()), high = -low;
        for (const vec3& p : volume.piece.points) low = glm::min(low, digits * p), high = glm::max(high, digits * p);
        for (int k = 0; k < 3; ++k) rounding_ = std::max(rounding_, all_.most(high[k]) - all_.least(low[k]));
    }

    void fix(const std::string& name)
    {
        const auto members = members_of(name);
        begin(name);
        for (const std::int64_t v : members) wishes_.push_back({v, point(v), option_});
    }

    void move(const std::string& text)
    {
        static constexpr std::array<std::pair<std::string_view, std::size_t>, 3> transforms = {
            {{":translate:", 3}, {":rotate:", 4}, {":scale:", 1}}};
        for (const auto& [key, count] : transforms)
            if (const auto at = text.rfind(key); at != text.npos)
                return transform(text.substr(0, at), count,
                                 numbers_of(text.substr(at + key.size()), count, "--move " + text));
        const auto at = text.rfind('=');
        if (at == text.npos)
            throw usage_error("--move " + text +
                              ": give GROUP=FILE.csv, GROUP:translate:x,y,z, GROUP:rotate:ax,ay,az,degrees or "
                              "GROUP:scale:factor");
        place(text.substr(0, at), text.substr(at + 1));
    }

    /// The wishes of the vertices here, one each; the vertices ascend. Collective.
    std::vector<wish> settled(std::vector<std::string>& notes)
    {
        std::vector<wish> kept;
        std::int64_t rounded = 0;
        all_.together(
            [&]
            {
                std::stable_sort(wishes_.begin(), wishes_.end(),
                                 [](const wish& a, const wish& b)
                                 { return a.id != b.id ? a.id < b.id : a.option < b.option; });
                for (const wish& w : wishes_)
                    if (kept.empty() || kept.back().id != w.id)
                        kept.push_back(w);
                    else
                        rounded += compare(kept.back(), w);
            });
        rounded = all_.sum(rounded);
        if (rounded > 0)
            notes.push_back(
                std::to_string(rounded) +
                " vertices in two groups with positions that differ by rounding; the first one counts, --fix before "
                "--move");
        return kept;
    }

private:
    std::size_t place_of(std::int64_t v) const { return static_cast<std::size_t>(v - volume_.first()); }
    const vec3& point(std::int64_t v) const { return volume_.piece.points[place_of(v)]; }

    void begin(const std::string& name)
    {
        option_ = static_cast<int>(options_.size());
        options_.push_back(name);
    }

    std::vector<std::int64_t> members_of(const std::string& name)
    {
        const auto& found = names_.find_group(name); // throws on all processes alike
        return volume_.members(static_cast<std::size_t>(&found - names_.groups.data()));
    }

    void transform(const std::string& name, std::size_t kind, const std::vector<double>& n)
    {
        const auto members = members_of(name);
        begin(name);
        dist::impl::shared_sums sums(3);
        for (const std::int64_t v : members)
            for (int k = 0; k < 3; ++k) sums[static_cast<std::size_t>(k)].add(point(v)[k]);
        const auto sum = sums.totals(all_);
        const auto count = static_cast<double>(all_.sum(static_cast<std::int64_t>(members.size())));
        const vec3 middle = vec3(sum[0], sum[1], sum[2]) / count;
        const auto motion = motion_of(name, middle, n);
        for (const std::int64_t v : members)
            wishes_.push_back({v, kind == 1 ? middle + n[0] * (point(v) - middle) : motion(point(v)), option_});
    }

    void place(const std::string& name, const std::string& path)
    {
        const auto members = members_of(name);
        begin(name);
        const auto pins = pins_of(all_, path, volume_.vertices);
        std::vector<wish> read;
        all_.together(
            [&]
            {
                for (const auto& p : pins)
                {
                    if (!p.hard() || p.held != taut::impl::fixed_marks<3>::every)
                        throw unsuitable_input(path + ": vertex " + std::to_string(p.vertex) +
                                               " has a weight or lacks a coordinate; use --pins for those");
                    read.push_back({p.vertex, p.target, option_});
                }
            });
        read = volume_.sent_home(read);
        all_.together(
            [&]
            {
                for (const wish& w : read)
                    if (!std::binary_search(members.begin(), members.end(), w.id))
                        throw unsuitable_input(path + ": vertex " + std::to_string(w.id) + " is not in group " + name +
                                               "; leave its line out, or use --pins");
            });
        wishes_.insert(wishes_.end(), read.begin(), read.end());
    }

    /// Whether two wishes differ by rounding alone; throws where they differ by more.
    bool compare(const wish& first, const wish& other) const
    {
        if (first.x == other.x) return false;
        const auto& a = options_[static_cast<std::size_t>(first.option)];
        const auto& b = options_[static_cast<std::size_t>(other.option)];
        const auto apart = [&](int k) { return std::abs(first.x[k] - other.x[k]) > rounding_; };
        if (!apart(0) && !apart(1) && !apart(2)) return true;
        if (a == b)
            throw unsuitable_input("group " + a + " is to be at two places, as vertex " + std::to_string(first.id) +
                                   " shows; give it one --move, or --fix alone");
        throw unsuitable_input("vertex " + std::to_string(first.id) + " is in " + a + " and in " + b +
                               ", which go different ways; leave it to one of them");
    }

    const ranged_volume& volume_;
    const communicator& all_;
    io::volume_file names_; ///< of the groups alone
    std::vector<std::string> options_;
    std::vector<wish> wishes_; ///< of vertices here
    int option_ = 0;
    double rounding_ = 0;
};

} // namespace

ranged_targets targets_of(const ranged_volume& volume, const shape_options& options)
{
    const auto& all = volume.processes();
    collector wanted(volume, options.input);
    for (const auto& name : options.fixed) wanted.fix(name);
    for (const auto& move : options.moves) wanted.move(move);
    ranged_targets found;
    std::vector<std::int64_t> pinned;
    for (const wish& w : wanted.settled(found.notes))
    {
        found.fixed.push_back(w.id);
        found.pins.pin(w.id, w.x);
        pinned.push_back(w.id);
    }
    if (options.smoothing) return found;
    if (!options.pins.empty())
        for (const auto& p : pins_of(all, options.pins, volume.vertices))
        {
            if (!p.hard())
            {
                if (p.weight > 0) found.pins.spring(p.vertex, p.target, p.weight);
                found.springs += p.weight > 0;
                continue;
            }
            pinned.push_back(p.vertex);
            for (int k = 0; k < 3; ++k)
                if ((p.held >> k & 1U) != 0) found.pins.pin(p.vertex, k, p.target[k]);
        }
    found.springs = all.sum(found.springs);
    found.pinned = all.sum(static_cast<std::int64_t>(volume.at_home(std::move(pinned)).size()));
    return found;
}

} // namespace taut::tools::mpi
