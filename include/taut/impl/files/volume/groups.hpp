// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstddef>
#include <map>
#include <set>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <taut/volume_file.hpp>

namespace taut::io::impl
{

/// Ascending, each once.
inline std::vector<idx> unique_vertices(std::vector<idx> vertices)
{
    std::sort(vertices.begin(), vertices.end());
    vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
    return vertices;
}

/// The same. vertex_count: how many there could be.
inline std::vector<idx> unique_vertices(std::vector<idx> vertices, std::size_t vertex_count)
{
    if (vertices.size() < vertex_count / 8) return unique_vertices(std::move(vertices));
    std::vector<char> named(vertex_count, 0);
    for (const idx v : vertices) named[static_cast<std::size_t>(v)] = 1;
    vertices.clear();
    for (std::size_t v = 0; v < vertex_count; ++v)
        if (named[v] != 0) vertices.push_back(static_cast<idx>(v));
    return vertices;
}

/// Vertices by the number of what they belong to: an attribute of cells or points.
class tagged_vertices
{
public:
    void add(long long tag, int dimension, std::span<const idx> vertices)
    {
        if (last_ == groups_.end() || last_->first != tag) last_ = groups_.try_emplace(tag).first;
        auto& [most, all] = last_->second;
        most = std::max(most, dimension);
        all.insert(all.end(), vertices.begin(), vertices.end());
    }

    bool empty() const { return groups_.empty(); }

    /// The vertices of a number, ascending, each once.
    std::vector<idx> vertices_of(long long tag, std::size_t vertex_count) const
    {
        const auto found = groups_.find(tag);
        return found == groups_.end() ? std::vector<idx>() : unique_vertices(found->second.vertices, vertex_count);
    }

    /// Moves all to the file under name(tag).
    template <class Name>
    void move_to(volume_file& file, const Name& name)
    {
        for (auto& [tag, tagged] : groups_)
            file.groups.push_back(
                {name(tag), tagged.dimension, unique_vertices(std::move(tagged.vertices), file.points.size())});
        groups_.clear();
        last_ = groups_.end();
    }

    /// The same with names PREFIX:TAG.
    void move_to_prefixed(volume_file& file, const std::string& prefix)
    {
        move_to(file, [&](long long tag) { return prefix + ':' + std::to_string(tag); });
    }

    tagged_vertices() = default;
    tagged_vertices(const tagged_vertices&) = delete;
    tagged_vertices& operator=(const tagged_vertices&) = delete;

private:
    struct group
    {
        int dimension = 0;
        std::vector<idx> vertices;
    };
    std::map<long long, group> groups_;
    typename std::map<long long, group>::iterator last_ = groups_.end();
};

/// Names that several groups have get the dimension behind: wing:2, wing:3; then they are joined.
inline void make_names_unique(std::vector<volume_group>& groups)
{
    std::map<std::string, int> count;
    for (const auto& g : groups) ++count[g.name];
    for (auto& g : groups)
        if (count[g.name] > 1) g.name += ':' + std::to_string(g.dimension);
    std::map<std::string, std::size_t> first;
    std::set<std::size_t> joined;
    std::vector<volume_group> result;
    for (auto& g : groups)
    {
        const auto [known, fresh] = first.try_emplace(g.name, result.size());
        if (fresh)
        {
            result.push_back(std::move(g));
            continue;
        }
        auto& to = result[known->second].vertices;
        to.insert(to.end(), g.vertices.begin(), g.vertices.end());
        joined.insert(known->second);
    }
    for (const std::size_t g : joined) result[g].vertices = unique_vertices(std::move(result[g].vertices));
    groups = std::move(result);
}

} // namespace taut::io::impl
