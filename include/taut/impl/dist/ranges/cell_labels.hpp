// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include <taut/impl/dist/processes/communicator.hpp>
#include <taut/impl/dist/processes/labelled_face.hpp>

namespace taut::dist::impl
{

/// What smoothing keeps of a volume besides its boundary: interfaces between regions, and labelled faces.
struct labelled_cells
{
    std::vector<std::int64_t> regions; ///< of the cells of this process; empty: all cells are of one region
    std::vector<labelled_face> faces;  ///< of this process, by ids of vertices; those with a label
};

/// Collects the labels of cells and faces as tuples, which become numbers that are the same on all processes, as
/// io::impl::region_numbers() has them of one file.
class label_tuples
{
public:
    explicit label_tuples(std::size_t width) : width_(width) {}

    /// labels: `width` numbers.
    void add_cell(std::span<const std::int64_t> labels) { cells_.insert(cells_.end(), labels.begin(), labels.end()); }
    void add_face(std::span<const std::int64_t> corners, std::span<const std::int64_t> labels)
    {
        if (std::all_of(labels.begin(), labels.end(), [](std::int64_t x) { return x == 0; })) return;
        std::copy(corners.begin(), corners.end(), faces_.emplace_back().vertices.begin());
        of_faces_.insert(of_faces_.end(), labels.begin(), labels.end());
    }

    /// Corners of faces, one face after the other, for numbers of a file to become ids.
    std::vector<std::int64_t> corners() const
    {
        std::vector<std::int64_t> all;
        for (const auto& face : faces_)
            for (const std::int64_t v : face.vertices)
                if (v >= 0) all.push_back(v);
        return all;
    }
    void replace_corners(const std::vector<std::int64_t>& ids)
    {
        auto next = ids.begin();
        for (auto& face : faces_)
            for (std::int64_t& v : face.vertices)
                if (v >= 0) v = *next++;
    }

    /// Collective.
    labelled_cells numbered(const communicator& all)
    {
        std::vector<std::int64_t> kinds = distinct(cells_, of_faces_), none(width_, 0);
        kinds = distinct(all.gathered(kinds), none); // tuples ascend
        const auto number = [&](const std::vector<std::int64_t>& from, std::size_t k)
        {
            const auto tuple = std::span(from).subspan(k * width_, width_);
            std::size_t low = 0, high = kinds.size() / width_;
            while (high - low > 1)
            {
                const std::size_t middle = (low + high) / 2;
                (less(tuple, std::span(kinds).subspan(middle * width_, width_)) ? high : low) = middle;
            }
            return static_cast<std::int64_t>(low);
        };
        const std::int64_t zero = width_ == 0 ? 0 : number(none, 0);
        labelled_cells result;
        std::int64_t least = kinds.empty() ? 0 : static_cast<std::int64_t>(kinds.size() / width_), most = 0;
        for (std::size_t k = 0; width_ > 0 && k < cells_.size() / width_; ++k)
        {
            result.regions.push_back(number(cells_, k));
            least = std::min(least, result.regions.back());
            most = std::max(most, result.regions.back());
        }
        if (all.least(least) >= all.most(most)) result.regions.clear();
        for (std::size_t k = 0; k < faces_.size(); ++k)
        {
            const std::int64_t label = number(of_faces_, k);
            faces_[k].label = label == zero ? 0 : label < zero ? label - zero : label;
        }
        result.faces = std::move(faces_);
        return result;
    }

private:
    static bool less(std::span<const std::int64_t> a, std::span<const std::int64_t> b)
    {
        return std::lexicographical_compare(a.begin(), a.end(), b.begin(), b.end());
    }

    /// The different ones of two lists of tuples, ascending.
    std::vector<std::int64_t> distinct(const std::vector<std::int64_t>& a, const std::vector<std::int64_t>& b) const
    {
        std::vector<std::span<const std::int64_t>> tuples;
        const auto take = [&](const std::vector<std::int64_t>& from)
        {
            for (std::size_t at = 0; width_ > 0 && at < from.size(); at += width_)
            {
                const auto tuple = std::span(from).subspan(at, width_);
                if (tuples.empty() || less(tuples.back(), tuple) || less(tuple, tuples.back())) tuples.push_back(tuple);
            }
        };
        take(a);
        take(b);
        std::sort(tuples.begin(), tuples.end(), less);
        std::vector<std::int64_t> result;
        for (std::size_t k = 0; k < tuples.size(); ++k)
            if (k == 0 || less(tuples[k - 1], tuples[k]))
                result.insert(result.end(), tuples[k].begin(), tuples[k].end());
        return result;
    }

    std::size_t width_;
    std::vector<std::int64_t> cells_, of_faces_;
    std::vector<labelled_face> faces_;
};

} // namespace taut::dist::impl
