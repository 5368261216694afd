// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <vector>

#include <taut/cell_data.hpp>

namespace taut::impl
{

/// Data of cells as data of points in between, for meshes of other cells at the same points: the mean over the cells of
/// each point. Directions count without their sign.
class averaged_cell_data
{
public:
    averaged_cell_data() = default;

    /// cells: arrays of point numbers.
    template <class Cells>
    averaged_cell_data(const cell_data& data, const Cells& cells, std::size_t points);

    bool empty() const { return weights_.empty() && attributes_.empty() && directions_.empty(); }

    /// For cells whose corners are the points numbers[corner].
    template <class Cells>
    cell_data at(const Cells& cells, const std::vector<idx>& numbers) const;

private:
    static void add(vec3& sum, const vec3& d) { sum += glm::dot(sum, d) < 0 ? -d : d; }

    std::size_t count_ = 0;
    std::vector<double> weights_, attributes_;
    std::vector<vec3> directions_;
};

template <class Cells>
averaged_cell_data::averaged_cell_data(const cell_data& data, const Cells& cells, std::size_t points)
    : count_(data.attribute_count)
{
    if (data.empty()) return;
    std::vector<double> around(points, 0.0);
    if (!data.weights.empty()) weights_.assign(points, 0.0);
    attributes_.assign(points * count_, 0.0);
    if (!data.directions.empty()) directions_.assign(points, vec3(0.0));
    for (std::size_t c = 0; c < cells.size(); ++c)
        for (const idx vertex : cells[c])
        {
            const auto v = static_cast<std::size_t>(vertex);
            around[v] += 1;
            if (!weights_.empty()) weights_[v] += data.weights[c];
            for (std::size_t k = 0; k < count_; ++k) attributes_[v * count_ + k] += data.attributes[c * count_ + k];
            if (!directions_.empty()) add(directions_[v], glm::normalize(data.directions[c]));
        }
    for (std::size_t v = 0; v < points; ++v)
    {
        const double n = std::max(around[v], 1.0);
        if (!weights_.empty()) weights_[v] /= n;
        for (std::size_t k = 0; k < count_; ++k) attributes_[v * count_ + k] /= n;
    }
}

template <class Cells>
cell_data averaged_cell_data::at(const Cells& cells, const std::vector<idx>& numbers) const
{
    cell_data r;
    r.attribute_count = count_;
    for (const auto& cell : cells)
    {
        const auto n = static_cast<double>(cell.size());
        double weight = 0;
        std::vector<double> attributes(count_, 0.0);
        vec3 direction(0.0);
        for (const idx corner : cell)
        {
            const auto v = static_cast<std::size_t>(numbers[static_cast<std::size_t>(corner)]);
            if (!weights_.empty()) weight += weights_[v] / n;
            for (std::size_t k = 0; k < count_; ++k) attributes[k] += attributes_[v * count_ + k] / n;
            if (!directions_.empty()) add(direction, directions_[v]);
        }
        if (!weights_.empty()) r.weights.push_back(weight);
        r.attributes.insert(r.attributes.end(), attributes.begin(), attributes.end());
        if (!directions_.empty()) r.directions.push_back(direction);
    }
    return r;
}

// Compiled once, with the bodies.
extern template averaged_cell_data::averaged_cell_data(const cell_data&, const std::vector<std::array<idx, 3>>&,
                                                       std::size_t);

extern template cell_data averaged_cell_data::at(const std::vector<std::array<idx, 3>>&, const std::vector<idx>&) const;

extern template averaged_cell_data::averaged_cell_data(const cell_data&, const std::vector<std::array<idx, 4>>&,
                                                       std::size_t);

extern template cell_data averaged_cell_data::at(const std::vector<std::array<idx, 4>>&, const std::vector<idx>&) const;

} // namespace taut::impl
