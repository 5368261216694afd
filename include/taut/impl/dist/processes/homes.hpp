// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include <taut/impl/dist/processes/communicator.hpp>
#include <taut/types.hpp>

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
    homes(const communicator& all, const std::vector<std::int64_t>& ids, const std::vector<vec3>& points);

    /// Vertices that are at home here, by id, each once.
    const std::vector<named_vertex>& known() const { return known_; }

    std::size_t home(std::int64_t id) const { return static_cast<std::size_t>((id - first_) / each_); }

    /// The place among known() of an id that is at home here, or none.
    std::int64_t place(std::int64_t id) const;

    /// The number of a vertex at home here.
    std::int64_t& number(std::size_t place) { return numbers_[place]; }

    /// Collective. The numbers of ids, any, in their order; none where no vertex has that id.
    std::vector<std::int64_t> find(const std::vector<std::int64_t>& ids) const;

private:
    bool has_home(std::int64_t id) const { return id >= first_ && (id - first_) / each_ < all_.size(); }

    void join();

    communicator all_;
    std::int64_t first_ = 0, each_ = 1;
    std::vector<named_vertex> known_;
    std::vector<std::int64_t> numbers_;
};

} // namespace taut::dist::impl
