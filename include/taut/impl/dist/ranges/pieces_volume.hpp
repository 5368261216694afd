// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <set>
#include <span>
#include <string>
#include <system_error>
#include <tuple>
#include <utility>
#include <vector>

#include <taut/impl/dist/processes/homes.hpp>
#include <taut/impl/dist/ranges/ranged_volume.hpp>
#include <taut/impl/files/file/read_file.hpp>
#include <taut/impl/files/volume/write_volume.hpp>

namespace taut::dist::impl
{

/// One file of a partitioned mesh, which one process reads and writes.
struct mesh_file
{
    std::size_t number = 0; ///< of the piece among all
    io::volume_file file;
    std::vector<std::int64_t> global_ids = {};      ///< of its points; or none
    std::vector<char> ghosts = {};                  ///< a flag per cell: another piece has it, too; or none
    std::vector<std::int64_t> places = {};          ///< of its points in the whole mesh
    std::vector<std::filesystem::path> others = {}; ///< files beside it that are copied, as they are found
};

/// Files of one process that are complete but for their names, and folders that were made for them.
class named_later : public pending_output
{
public:
    ~named_later() override
    {
        files_.clear();
        std::error_code kept; // those with something in them stay
        if (!done_)
            for (auto f = folders_.rbegin(); f != folders_.rend(); ++f) std::filesystem::remove(*f, kept);
    }

    /// Throws io_error.
    void add(const std::filesystem::path& path, const std::string& bytes)
    {
        make_folder(path.parent_path());
        auto& file = files_.emplace_back(std::make_unique<io::atomic_file>(path));
        file->write(bytes);
        file->finish();
        file->link();
    }

    void commit() override
    {
        done_ = true;
        for (const auto& file : files_)
        {
            file->rename();
            file->sync_folder();
        }
    }

private:
    void make_folder(const std::filesystem::path& folder)
    {
        std::error_code failure;
        if (folder.empty() || std::filesystem::is_directory(folder, failure)) return;
        make_folder(folder.parent_path());
        if (std::filesystem::create_directory(folder, failure)) folders_.push_back(folder);
        if (failure && !std::filesystem::is_directory(folder))
            throw io::io_error(folder.string(), "cannot make this folder: " + failure.message());
    }

    std::vector<std::unique_ptr<io::atomic_file>> files_;
    std::vector<std::filesystem::path> folders_;
    bool done_ = false;
};

/// A mesh in pieces, each a file of its own with its own points. Points that pieces share are one vertex: by global
/// ids, which then are in the order of the vertices, or, where a piece has none, by exactly equal coordinates.
class pieces_volume : public ranged_volume
{
public:
    std::vector<std::int64_t> members(std::size_t group) const override
    {
        std::vector<std::int64_t> places;
        for (const auto& part : files_)
            for (const auto& g : part.file.groups)
                if (g.name == groups[group].name)
                    for (const idx v : g.vertices) places.push_back(part.places[static_cast<std::size_t>(v)]);
        return at_home(std::move(places));
    }

    /// By arrays that do not number single cells of the whole mesh.
    labelled_cells labelled() const override
    {
        const auto names = label_names();
        label_tuples labels(names.size());
        std::vector<std::int64_t> corners, tuple(names.size(), 0);
        for (const auto& part : files_)
        {
            std::vector<const std::vector<long long>*> columns;
            for (const auto& name : names)
            {
                const auto at = std::find_if(part.file.labels.begin(), part.file.labels.end(),
                                             [&](const auto& l) { return l.of_cells && l.name == name; });
                columns.push_back(at == part.file.labels.end() ? nullptr : &at->values);
            }
            each_cell(part,
                      [&](std::size_t number, int dimension, std::span<const idx> cell, io::cell_kind)
                      {
                          if (dimension < 2) return;
                          for (std::size_t k = 0; k < tuple.size(); ++k)
                              tuple[k] = columns[k] && number < columns[k]->size() ? (*columns[k])[number] : 0;
                          if (dimension == 3) return labels.add_cell(tuple);
                          corners.clear();
                          for (const idx v : cell) corners.push_back(part.places[static_cast<std::size_t>(v)]);
                          labels.add_face(corners, tuple);
                      });
        }
        return labels.numbered(all_);
    }

    std::vector<std::filesystem::path> files_at(const std::filesystem::path& path) const override
    {
        std::vector<std::filesystem::path> files;
        for (const auto& part : files_)
        {
            files.push_back(output_of(part, path));
            for (const auto& other : part.others) files.push_back(output_of(part, path, other));
        }
        return files;
    }

    outputs write(const std::filesystem::path& path, const std::vector<vec3>& x) const override
    {
        std::vector<std::int64_t> wanted;
        for (const auto& part : files_) wanted.insert(wanted.end(), part.places.begin(), part.places.end());
        sort_unique(wanted);
        const auto told = values_at(wanted, x);
        auto written = std::make_unique<named_later>();
        all_.together(
            [&]
            {
                require_output(path);
                for (const auto& part : files_)
                {
                    std::vector<vec3> points;
                    for (const std::int64_t v : part.places) points.push_back(told[place_in(wanted, v)]);
                    written->add(output_of(part, path), io::impl::with_points(part.file, points));
                    for (const auto& other : part.others)
                        written->add(output_of(part, path, other), io::impl::read_file(other));
                }
                if (all_.rank() == 0) add_index(path, *written);
            });
        outputs files;
        files.push_back(std::move(written));
        return files;
    }

    void require_output(const std::filesystem::path& path) const override
    {
        std::error_code unknown;
        for (const auto& part : files_)
            if (const auto target = output_of(part, path); std::filesystem::equivalent(target, part.file.path, unknown))
                throw io::io_error(target.string(), "is a piece of the input; give the output another name");
    }

protected:
    explicit pieces_volume(const communicator& all) : ranged_volume(all) { partitioned = true; }

    /// The place of a piece of an output.
    virtual std::filesystem::path output_of(const mesh_file& part, const std::filesystem::path& path) const = 0;
    /// That of a file beside a piece.
    std::filesystem::path output_of(const mesh_file& part, const std::filesystem::path& path,
                                    const std::filesystem::path& other) const
    {
        return output_of(part, path).parent_path() /
               other.lexically_relative(std::filesystem::path(part.file.path).parent_path());
    }
    /// What else is written, by process 0.
    virtual void add_index(const std::filesystem::path& path, named_later& to) const = 0;

    /// The pieces of this process, of so many.
    std::pair<std::size_t, std::size_t> share(std::size_t pieces) const
    {
        const auto P = all_.ranks(), r = static_cast<std::size_t>(all_.rank());
        return {pieces * r / P, pieces * (r + 1) / P};
    }

    /// Collective. Once files_ has the pieces. Throws io_error, mesh_error.
    void join()
    {
        bool rounds = false;
        for (const auto& part : files_) rounds = rounds || part.file.places.rounds();
        single = all_.any(rounds);
        std::vector<vec3> points;
        for (const auto& part : files_) points.insert(points.end(), part.file.points.begin(), part.file.points.end());
        const auto ids = ids_of_points(points);
        homes known(all_, ids, points);
        const std::int64_t first = all_.before(static_cast<std::int64_t>(known.known().size()));
        for (std::size_t k = 0; k < known.known().size(); ++k)
        {
            known.number(k) = first + static_cast<std::int64_t>(k);
            piece.ids.push_back(known.number(k));
            piece.points.push_back(known.known()[k].x);
        }
        const auto places = known.find(ids);
        auto next = places.begin();
        for (auto& file : files_)
        {
            const auto end = next + static_cast<std::ptrdiff_t>(file.file.points.size());
            file.places.assign(next, end);
            next = end;
        }
        bound();
        add_cells();
        finish_cells();
        all_.together(
            [this]
            {
                if (cells == 0) throw mesh_error(mesh_error::empty, {}, "the pieces have no volume cells; give some");
            });
        join_groups();
    }

    std::vector<mesh_file> files_; ///< of this process, ascending

private:
    std::vector<std::int64_t> ids_of_points(const std::vector<vec3>& points) const
    {
        bool named = true;
        for (const auto& part : files_) named = named && part.global_ids.size() == part.file.points.size();
        std::vector<std::int64_t> ids;
        if (!all_.all(named)) return leaders(points);
        for (const auto& part : files_) ids.insert(ids.end(), part.global_ids.begin(), part.global_ids.end());
        return ids;
    }

    /// A point of a piece, by its place among the points of all.
    struct placed
    {
        vec3 x;
        std::int64_t piece, place;
        auto key() const { return std::tuple(x.x, x.y, x.z); }
    };

    /// Collective. Of each point the first of those at the same position in different pieces.
    std::vector<std::int64_t> leaders(const std::vector<vec3>& points) const
    {
        std::int64_t place = all_.before(static_cast<std::int64_t>(points.size()));
        parcels<placed> to(all_.ranks());
        std::vector<std::size_t> asked;
        std::size_t at = 0;
        for (const auto& part : files_)
            for (std::size_t v = 0; v < part.file.points.size(); ++v)
            {
                const vec3 x = points[at++] + vec3(0.0); // no -0
                std::uint64_t hash = 0;
                for (int k = 0; k < 3; ++k)
                {
                    hash = (hash ^ std::bit_cast<std::uint64_t>(x[k])) * 0x9e3779b97f4a7c15U;
                    hash ^= hash >> 29U;
                }
                asked.push_back(static_cast<std::size_t>(hash % all_.ranks()));
                to[asked.back()].push_back({x, static_cast<std::int64_t>(part.number), place++});
            }
        const auto got = all_.exchange(to);
        std::vector<std::size_t> order(got.items.size());
        for (std::size_t k = 0; k < order.size(); ++k) order[k] = k;
        const auto& p = got.items;
        std::sort(order.begin(), order.end(),
                  [&](std::size_t a, std::size_t b)
                  { return std::tuple(p[a].key(), p[a].place) < std::tuple(p[b].key(), p[b].place); });
        std::vector<std::int64_t> leader(p.size());
        all_.together([&] { lead(p, order, leader); });
        parcels<std::int64_t> tell(all_.ranks());
        for (std::size_t r = 0; r < all_.ranks(); ++r)
            for (std::size_t k = got.begin[r]; k < got.begin[r + 1]; ++k) tell[r].push_back(leader[k]);
        const auto told = all_.exchange(tell);
        auto next = told.begin;
        std::vector<std::int64_t> result;
        for (const std::size_t r : asked) result.push_back(told.items[next[r]++]);
        return result;
    }

    /// Coincident points of one piece are different ones.
    static void lead(const std::vector<placed>& p, const std::vector<std::size_t>& order,
                     std::vector<std::int64_t>& leader)
    {
        for (std::size_t begin = 0, end = 0; begin < order.size(); begin = end)
        {
            while (end < order.size() && p[order[end]].key() == p[order[begin]].key()) ++end;
            std::set<std::int64_t> pieces;
            for (std::size_t k = begin; k < end; ++k) pieces.insert(p[order[k]].piece);
            const bool twice = pieces.size() < end - begin;
            if (twice && pieces.size() > 1)
                throw mesh_error(mesh_error::non_finite, {},
                                 "piece " + std::to_string(p[order[begin]].piece) +
                                     " has two points at one position that other pieces have, too, so that which is "
                                     "which is not known; save the pieces with global ids of their points");
            for (std::size_t k = begin; k < end; ++k) leader[order[k]] = p[order[twice ? k : begin]].place;
        }
    }

    /// f(number in the file, dimension, corners, kind) of the cells of a piece that are not those of another.
    template <class F>
    static void each_cell(const mesh_file& part, const F& f)
    {
        std::size_t number = 0;
        for (const auto& block : part.file.cells)
            for (std::size_t c = 0; c < block.size(); ++c, ++number)
                if (number >= part.ghosts.size() || part.ghosts[number] == 0)
                    f(number, io::impl::shape_of(block.kind).dimension, block.cell(c), block.kind);
    }

    /// Collective. Arrays of cells that label more than one cell by a value, as io::impl::region_numbers() chooses
    /// them of one file.
    std::vector<std::string> label_names() const
    {
        constexpr std::size_t most = 257;
        std::vector<std::string> mine; // a value, and the name of its array
        std::int64_t count = 0;
        for (const auto& part : files_)
        {
            for (const auto& block : part.file.cells) count += static_cast<std::int64_t>(block.size());
            for (const auto& label : part.file.labels)
            {
                std::set<long long> values;
                for (const long long x : label.values)
                    if (label.of_cells && values.size() < most) values.insert(x);
                for (const long long x : values) mine.insert(mine.end(), {std::to_string(x), label.name});
            }
        }
        count = all_.sum(count);
        std::map<std::string, std::set<std::string>> found;
        const auto told = all_.gathered(mine);
        for (std::size_t k = 0; k + 1 < told.size(); k += 2) found[told[k + 1]].insert(told[k]);
        std::vector<std::string> names;
        for (const auto& [name, values] : found)
        {
            const auto n = static_cast<std::int64_t>(values.size());
            const bool many = values.size() >= most || (n > 16 && 2 * n > count);
            const bool ghosts = name == "vtkGhostType" || name == "vtkGhostLevels";
            if (!many && !ghosts && values != std::set<std::string>{"0"}) names.push_back(name);
        }
        return names;
    }

    void add_cells()
    {
        std::vector<std::int64_t> corners;
        for (const auto& part : files_)
            each_cell(part,
                      [&](std::size_t, int dimension, std::span<const idx> cell, io::cell_kind kind)
                      {
                          if (dimension != 3) return;
                          corners.clear();
                          for (const idx v : cell) corners.push_back(part.places[static_cast<std::size_t>(v)]);
                          add_solid(kind, corners);
                      });
    }

    /// Collective. Groups of all pieces by name, but those of arrays that have too many values in one, or in all.
    void join_groups()
    {
        constexpr std::size_t most = 256;
        std::vector<std::string> mine;
        const auto tell = [&](const std::string& what, const std::string& name) { mine.push_back(what + name); };
        for (const auto& part : files_)
        {
            for (const auto& g : part.file.groups) tell(std::to_string(g.dimension), g.name);
            for (const auto& label : part.file.labels)
            {
                tell("a", label.name);
                const bool made = std::any_of(part.file.groups.begin(), part.file.groups.end(),
                                              [&](const auto& g) { return g.name.starts_with(label.name + ':'); });
                if (!made && !label.values.empty()) tell("x", label.name);
            }
        }
        std::map<std::string, int> known;
        std::set<std::string> arrays, dropped = {"vtkGhostType", "vtkGhostLevels"};
        for (const auto& told : all_.gathered(mine))
        {
            std::string name = told.substr(1);
            if (told[0] == 'x')
                dropped.insert(std::move(name));
            else if (told[0] == 'a')
                arrays.insert(std::move(name));
            else
            {
                auto& dimension = known[name];
                dimension = std::max(dimension, told[0] - '0');
            }
        }
        const auto of_array = [&](const std::string& array)
        {
            const auto begin = known.lower_bound(array + ':');
            auto end = begin;
            while (end != known.end() && end->first.starts_with(array + ':')) ++end;
            return std::pair(begin, end);
        };
        for (const auto& array : arrays)
            if (const auto [begin, end] = of_array(array);
                dropped.count(array) != 0 || static_cast<std::size_t>(std::distance(begin, end)) > most)
                known.erase(begin, end);
        for (const auto& [name, dimension] : known) groups.push_back({name, dimension});
    }
};

} // namespace taut::dist::impl
