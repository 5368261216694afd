// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <span>
#include <vector>

#include <taut/errors.hpp>
#include <taut/types.hpp>

/// Survey of the faces of a map for pictures: drawable and flipped ones, distribution of distortions.
namespace taut::io
{

/// Twice the signed area of a triangle of the plane, positive when counter-clockwise.
inline double uv_determinant(const vec2& a, const vec2& b, const vec2& c)
{
    return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

/// Survey of all faces, before anything is drawn.
struct face_survey
{
    std::size_t faces = 0;                         ///< all of them
    std::vector<std::size_t> flipped;              ///< drawable, but the uv triangle has no positive area; ascending
    std::size_t undrawable = 0;                    ///< a corner does not exist or is not finite
    std::size_t unknown = 0;                       ///< drawable, not flipped, with a distortion of NaN
    double median = 0, percentile99 = 0, most = 0; ///< of the known distortions of faces that are not flipped
    bool measured = false;                         ///< there is at least one such face
};

namespace impl
{

/// Coordinates beyond this are as good as infinite: their areas overflow.
inline constexpr double largest_coordinate = 1e150;

inline bool drawable(const vec2& p)
{
    return std::abs(p.x) <= largest_coordinate && std::abs(p.y) <= largest_coordinate; // false for NaN
}

inline bool drawable(std::span<const vec2> uv, const std::array<idx, 3>& cell)
{
    return std::all_of(cell.begin(), cell.end(),
                       [&](idx v) {
                           return v >= 0 && static_cast<std::size_t>(v) < uv.size() &&
                                  drawable(uv[static_cast<std::size_t>(v)]);
                       });
}

inline std::array<vec2, 3> corners(std::span<const vec2> uv, const std::array<idx, 3>& cell)
{
    const auto at = [&](int i) { return uv[static_cast<std::size_t>(cell[static_cast<std::size_t>(i)])]; };
    return {at(0), at(1), at(2)};
}

inline bool flipped(const std::array<vec2, 3>& t)
{
    return !(uv_determinant(t[0], t[1], t[2]) > 0);
}

} // namespace impl

/// Looks at all faces. distortion: one number a face, or empty for "not measured".
/// Errors: parameter_error for any other number of distortions.
inline face_survey survey_faces(std::span<const vec2> uv, std::span<const std::array<idx, 3>> cells,
                                std::span<const double> distortion)
{
    if (!distortion.empty() && distortion.size() != cells.size())
        throw parameter_error("distortion", "needs one number a face, or none");
    face_survey s;
    s.faces = cells.size();
    std::vector<double> known;
    known.reserve(distortion.size());
    for (std::size_t f = 0; f < cells.size(); ++f)
    {
        if (!impl::drawable(uv, cells[f]))
            ++s.undrawable;
        else if (impl::flipped(impl::corners(uv, cells[f])))
            s.flipped.push_back(f);
        else if (distortion.empty())
            continue;
        else if (std::isnan(distortion[f]))
            ++s.unknown;
        else
            known.push_back(distortion[f]);
    }
    if ((s.measured = !known.empty()))
    {
        const auto rank = [&](double part)
        {
            const auto at = known.begin() + std::lround(part * static_cast<double>(known.size() - 1));
            std::nth_element(known.begin(), at, known.end());
            return *at;
        };
        s.median = rank(0.5);
        s.percentile99 = rank(0.99);
        s.most = rank(1);
    }
    return s;
}

} // namespace taut::io
