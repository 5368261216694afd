// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <span>

#include <taut/energies.hpp>
#include <taut/quality.hpp>

namespace taut::impl
{

/// Twice the area of a triangle from two of its edges.
inline double double_area(const vec2& a, const vec2& b)
{
    return std::abs(a.x * b.y - a.y * b.x);
}

inline double double_area(const vec3& a, const vec3& b)
{
    return glm::length(glm::cross(a, b));
}

/// Angles of a triangle at its corners, each from 0 to pi to a few roundings of the coordinates' differences: the area,
/// which is the sine part of all three, comes from the two shortest edges.
template <class Point>
std::array<double, 3> angles(const Point& p, const Point& q, const Point& r)
{
    Point a = r - q, b = p - r, c = q - p;
    double largest = 0;
    for (const Point* e : {&a, &b, &c})
        for (int k = 0; k < Point::length(); ++k) largest = std::max(largest, std::abs((*e)[k]));
    if (largest > 0) // products of lengths neither overflow nor underflow
    {
        const double unit = std::scalbn(1.0, std::clamp(-std::ilogb(largest), -1000, 1000));
        a *= unit, b *= unit, c *= unit;
    }
    const double aa = glm::dot(a, a), bb = glm::dot(b, b), cc = glm::dot(c, c);
    const double area = aa >= bb && aa >= cc ? double_area(b, c) : bb >= cc ? double_area(a, c) : double_area(a, b);
    return {std::atan2(area, -glm::dot(b, c)), std::atan2(area, -glm::dot(a, c)), std::atan2(area, -glm::dot(a, b))};
}

class spread_sum
{
public:
    void add(double ratio)
    {
        result_.min = std::min(result_.min, ratio);
        result_.max = std::max(result_.max, ratio);
        result_.rms += (ratio - 1) * (ratio - 1);
        ++count_;
    }
    spread_sum& operator+=(const spread_sum& other)
    {
        result_.min = std::min(result_.min, other.result_.min);
        result_.max = std::max(result_.max, other.result_.max);
        result_.rms += other.result_.rms;
        count_ += other.count_;
        return *this;
    }
    spread result() const
    {
        spread r = result_;
        r.rms = std::sqrt(r.rms / static_cast<double>(count_));
        return r;
    }

private:
    spread result_;
    std::size_t count_ = 0;
};

/// Sum of ((mapped - rest) / rest)^2 over the angles of the triangles of a cell.
template <class Element>
double angular_distortion(const mesh<Element>& m, std::span<const vec<Element::dimension>> x, std::size_t c)
{
    double sum = 0;
    const auto& cell = m.cells()[c];
    const auto at = [](const auto& points, idx v) { return points[static_cast<std::size_t>(v)]; };
    for (std::size_t i = 0; i < cell.size(); ++i)
        for (std::size_t j = i + 1; j < cell.size(); ++j)
            for (std::size_t k = j + 1; k < cell.size(); ++k)
            {
                const auto& p = m.points();
                const auto rest = angles(at(p, cell[i]), at(p, cell[j]), at(p, cell[k]));
                const auto mapped = angles(at(x, cell[i]), at(x, cell[j]), at(x, cell[k]));
                for (std::size_t n = 0; n < 3; ++n) sum += (mapped[n] / rest[n] - 1) * (mapped[n] / rest[n] - 1);
            }
    return sum;
}

/// Sums of a pass over the cells before the scale is known.
struct quality_sums
{
    means isometric, shape, area;
    double angular = 0, rest = 0, mapped = 0;

    quality_sums& operator+=(const quality_sums& o)
    {
        isometric += o.isometric;
        shape += o.shape;
        area += o.area;
        angular += o.angular;
        rest += o.rest;
        mapped += o.mapped;
        return *this;
    }
};

/// And what one adds up at that scale.
struct stretch_sums
{
    spread_sum l2, linf, ratio;
    double total = 0; ///< sum of l2^2, by measure

    stretch_sums& operator+=(const stretch_sums& o)
    {
        l2 += o.l2;
        linf += o.linf;
        ratio += o.ratio;
        total += o.total;
        return *this;
    }
};

} // namespace taut::impl
