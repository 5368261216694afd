// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <span>
#include <vector>

#include <taut/impl/energy/area.hpp>
#include <taut/impl/energy/distortion.hpp>
#include <taut/impl/exact/certify.hpp>
#include <taut/impl/measure/singular_values.hpp>

namespace taut::impl
{

/// Statistics over the elements of a ratio that is 1 without distortion.
struct spread
{
    double min = std::numeric_limits<double>::infinity();
    double max = 0;
    double rms = 0; ///< sqrt(mean((ratio - 1)^2)), every element counting 1
};

} // namespace taut::impl

namespace taut
{

/// Quality of a map: the distortion measures of the literature, and counts of flipped elements. Energies see the map as
/// it is. Stretch and area are the paper's columns (Table 3) and are taken after scaling the map to the total measure
/// of the rest mesh, the sum of unsigned mapped measures; angles do not depend on scale. Everything but the energies is
/// finite also for flipped elements (they count with |det|), as long as no element is flat.
struct quality
{
    certificate flips;           ///< exact
    impl::means isometric;       ///< |S|^2 (1 + 1/det^2), minimum 4; tetrahedra: shape * area, minimum 2
    impl::means shape;           ///< |S|^2 / (D det^(2/D)), minimum 1
    impl::means area;            ///< det + 1/det, minimum 2
    double scale = 1;            ///< factor that gives the map the rest mesh's measure
    impl::spread stretch_l2;     ///< sqrt(|S^-1|^2 / D): how the map back to the surface stretches (Sander et al. 2001)
    impl::spread stretch_linf;   ///< largest singular value of S^-1
    double stretch_l2_total = 0; ///< sqrt of the mean of stretch_l2^2 by rest measure: Sander's norm of the whole map
    impl::spread area_ratio;     ///< mapped / rest measure
    double angular = 0;          ///< mean over all angles of triangles or faces of ((mapped - rest) / rest)^2
};

} // namespace taut

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

namespace taut
{

/// Measures a map. x: #V image points in the units of `ideal`.
template <class Element>
quality measure_quality(const mesh<Element>& m, const impl::ideal_elements<Element>& ideal,
                        std::span<const vec<Element::dimension>> x)
{
    constexpr int D = Element::dimension;
    quality q;
    q.flips = certify<D>(m.cells(), x, ideal.measure);
    const std::size_t cells = m.cells().size();
    const auto sums =
        impl::block_sum<impl::quality_sums>(cells,
                                            [&](impl::quality_sums& s, std::size_t c)
                                            {
                                                const auto e = impl::mapped_element(m, ideal, x, c);
                                                s.isometric.add(impl::bounded(energy::isometric{}, e), e.measure);
                                                s.shape.add(impl::bounded(energy::shape{}, e), e.measure);
                                                s.area.add(impl::bounded(energy::area{}, e), e.measure);
                                                s.angular += impl::angular_distortion(m, x, c);
                                                s.rest += e.measure;
                                                s.mapped += std::abs(e.det) * e.measure;
                                            });
    q.isometric = sums.isometric.over(cells, sums.rest);
    q.shape = sums.shape.over(cells, sums.rest);
    q.area = sums.area.over(cells, sums.rest);
    constexpr std::size_t angles = D == 2 ? 3 : 12; // of a cell
    q.angular = sums.angular / static_cast<double>(angles * cells);
    q.scale = D == 2 ? std::sqrt(sums.rest / sums.mapped) : std::cbrt(sums.rest / sums.mapped);

    const auto stretch = impl::block_sum<impl::stretch_sums>(cells,
                                                             [&](impl::stretch_sums& s, std::size_t c)
                                                             {
                                                                 const auto e = impl::mapped_element(m, ideal, x, c);
                                                                 const auto sigma =
                                                                     impl::singular_values<D>(q.scale * e.S);
                                                                 double sum = 0;
                                                                 double volume = 1;
                                                                 for (const double v : sigma)
                                                                 {
                                                                     sum += 1 / (v * v);
                                                                     volume *= v;
                                                                 }
                                                                 s.l2.add(std::sqrt(sum / D));
                                                                 s.linf.add(1 / sigma.back());
                                                                 s.ratio.add(volume);
                                                                 s.total += e.measure * sum / D;
                                                             });
    q.stretch_l2 = stretch.l2.result();
    q.stretch_linf = stretch.linf.result();
    q.area_ratio = stretch.ratio.result();
    q.stretch_l2_total = std::sqrt(stretch.total / sums.rest);
    return q;
}

/// Measures a map in the units of the mesh. Throws mesh_error where a cell is flat or inverted at rest.
template <class Element>
quality measure_quality(const mesh<Element>& m, std::span<const vec<Element::dimension>> x)
{
    // In units of the model, so that squares neither overflow nor vanish.
    const double unit = impl::unit_scale(m);
    std::vector<vec<Element::dimension>> scaled(x.begin(), x.end());
    for (auto& p : scaled) p *= unit;
    return measure_quality<Element>(m, impl::ideal_elements<Element>(m, unit), scaled);
}

} // namespace taut
