// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include <taut/impl/core/types.hpp>
#include <taut/impl/mesh/mesh_error.hpp>
#include <taut/impl/processes/communicator.hpp>

namespace taut::dist::impl
{

/// A vertex under the number that the caller gives it.
struct named_vertex
{
    std::int64_t id;
    vec3 x;
};

/// The processes that know of vertices by the caller's numbers, which are any: the range of numbers is cut into equal
/// pieces. It takes each vertex once, whoever gives it, and answers with the number that it gets.
class homes
{
public:
    static constexpr std::int64_t none = -1;

    /// Collective. Vertices may be given by several processes, at the same position. Throws mesh_error.
    homes(const communicator& all, const std::vector<std::int64_t>& ids, const std::vector<vec3>& points) : all_(all)
    {
        std::int64_t low = std::numeric_limits<std::int64_t>::max(), high = std::numeric_limits<std::int64_t>::min();
        for (const std::int64_t id : ids) low = std::min(low, id), high = std::max(high, id);
        first_ = all_.least(low);
        const std::int64_t last = all_.most(high);
        all_.together(
            [&]
            {
                if (first_ > last) throw mesh_error(mesh_error::empty, {}, "the mesh has no vertices; give it some");
                if (first_ < 0)
                    throw mesh_error(mesh_error::index_out_of_range, {},
                                     "vertex " + std::to_string(first_) + " has a negative number; count from 0");
            });
        each_ = (last - first_) / all_.size() + 1;
        parcels<named_vertex> to(all_.ranks());
        for (std::size_t i = 0; i < ids.size(); ++i) to[home(ids[i])].push_back({ids[i], points[i]});
        known_ = all_.exchange(to).items;
        std::stable_sort(known_.begin(), known_.end(), [](const auto& a, const auto& b) { return a.id < b.id; });
        all_.together([this] { join(); });
        numbers_.assign(known_.size(), none);
    }

    /// Vertices that are at home here, by id, each once.
    const std::vector<named_vertex>& known() const { return known_; }

    std::size_t home(std::int64_t id) const { return static_cast<std::size_t>((id - first_) / each_); }

    /// The place among known() of an id that is at home here, or none.
    std::int64_t place(std::int64_t id) const
    {
        const auto at = std::lower_bound(known_.begin(), known_.end(), id,
                                         [](const named_vertex& v, std::int64_t wanted) { return v.id < wanted; });
        return at == known_.end() || at->id != id ? none : at - known_.begin();
    }

    /// The number of a vertex at home here.
    std::int64_t& number(std::size_t place) { return numbers_[place]; }

    /// Collective. The numbers of ids, any, in their order; none where no vertex has that id.
    std::vector<std::int64_t> find(const std::vector<std::int64_t>& ids) const
    {
        std::vector<std::int64_t> asked;
        for (const std::int64_t id : ids)
            if (has_home(id)) asked.push_back(id);
        std::sort(asked.begin(), asked.end());
        asked.erase(std::unique(asked.begin(), asked.end()), asked.end());
        parcels<std::int64_t> ask(all_.ranks()), tell(all_.ranks());
        for (const std::int64_t id : asked) ask[home(id)].push_back(id);
        const auto wanted = all_.exchange(ask);
        for (std::size_t r = 0; r < all_.ranks(); ++r)
            for (const std::int64_t id : wanted.from(r))
            {
                const std::int64_t at = place(id);
                tell[r].push_back(at < 0 ? none : numbers_[static_cast<std::size_t>(at)]);
            }
        const auto told = all_.exchange(tell).items; // homes ascend as asked does
        std::vector<std::int64_t> found;
        found.reserve(ids.size());
        for (const std::int64_t id : ids)
            found.push_back(
                has_home(id)
                    ? told[static_cast<std::size_t>(std::lower_bound(asked.begin(), asked.end(), id) - asked.begin())]
                    : none);
        return found;
    }

private:
    bool has_home(std::int64_t id) const { return id >= first_ && (id - first_) / each_ < all_.size(); }

    void join()
    {
        std::size_t n = 0;
        for (const named_vertex& v : known_)
        {
            if (n == 0 || known_[n - 1].id != v.id)
                known_[n++] = v;
            else if (known_[n - 1].x != v.x)
                throw mesh_error(mesh_error::non_finite, {},
                                 "vertex " + std::to_string(v.id) +
                                     " has two positions; give the same one wherever it is given");
        }
        known_.resize(n);
    }

    communicator all_;
    std::int64_t first_ = 0, each_ = 1;
    std::vector<named_vertex> known_;
    std::vector<std::int64_t> numbers_;
};

} // namespace taut::dist::impl
