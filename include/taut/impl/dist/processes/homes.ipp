// SPDX-License-Identifier: MIT
#pragma once

#include <taut/impl/dist/processes/homes.hpp>

#include <algorithm>
#include <limits>
#include <string>

#include <taut/errors.hpp>

namespace taut::dist::impl
{

homes::homes(const communicator& all, const std::vector<std::int64_t>& ids, const std::vector<vec3>& points) : all_(all)
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

std::int64_t homes::place(std::int64_t id) const
{
    const auto at = std::lower_bound(known_.begin(), known_.end(), id,
                                     [](const named_vertex& v, std::int64_t wanted) { return v.id < wanted; });
    return at == known_.end() || at->id != id ? none : at - known_.begin();
}

std::vector<std::int64_t> homes::find(const std::vector<std::int64_t>& ids) const
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

void homes::join()
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

} // namespace taut::dist::impl
