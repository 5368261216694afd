// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>
#include <utility>
#include <vector>

#include <taut/impl/core/core/disjoint_sets.hpp>
#include <taut/impl/core/mesh/cell_corners.hpp>
#include <taut/impl/files/volume/cell_faces.hpp>
#include <taut/impl/files/volume/volume_file.hpp>
#include <taut/volume_file.hpp>

namespace taut::io::impl
{

/// Sum of the determinants at the corners of each cell, for a rest shape of about size 1. All 0 for a surface in space,
/// which has no sign.
template <class Element>
std::vector<double> corner_measures(const volume_file& file)
{
    const auto& x = file.at_rest();
    double most = 0;
    bool flat = true;
    for (const vec3& p : x)
    {
        for (int k = 0; k < 3; ++k) most = std::max(most, std::abs(p[k]));
        flat = flat && p.z == x.front().z;
    }
    const bool has_signs = Element::dimension == 3 || flat;
    const int exponent = most > 0 ? -std::ilogb(most) : 0;
    const double up = std::ldexp(1.0, exponent / 2),
                 on = std::ldexp(1.0, exponent - exponent / 2); // one could overflow
    const auto place = [&](idx v) { return vec<Element::dimension>(x[static_cast<std::size_t>(v)]) * up * on; };
    std::vector<double> measures;
    for_each_cell(file, Element::dimension,
                  [&](cell_kind, idx, std::span<const idx> corners)
                  {
                      const vec<Element::dimension> origin = place(corners[0]);
                      double& sum = measures.emplace_back(0.0);
                      for (const auto& t : taut::impl::corner_simplices(corners.size(), Element{}))
                      {
                          typename Element::mapped_corners simplex;
                          for (std::size_t k = 0; k < t.size(); ++k) simplex[k] = place(corners[t[k]]) - origin;
                          if (has_signs) sum += Element::determinant(simplex);
                      }
                  });
    return measures;
}

/// Finds cells with reversed orientation in a file, ascending. They are determined by the faces that neighbours share,
/// not by shapes, as inverted cells are for untangling: of the two orientations, the one that makes the measure of a
/// component positive is kept. A consistently oriented component is reversed where nine of ten cells or more are
/// negative. Non-orientable components are not changed.
inline std::vector<idx> cells_to_turn(const volume_file& file)
{
    const auto sides = file.faces();
    const auto measures = file.dimension == 2 ? corner_measures<triangle>(file) : corner_measures<tetrahedron>(file);
    const auto n = static_cast<idx>(measures.size());
    taut::impl::disjoint_sets sets(2 * n); // c: as it is; n + c: turned
    for (std::size_t s = 0; s < sides.faces.size(); ++s)
    {
        const idx twin = sides.twin[s];
        if (twin < static_cast<idx>(s)) continue;
        const idx a = sides.faces[s].cell, b = sides.faces[static_cast<std::size_t>(twin)].cell;
        const bool clash = sides.clashes(s);
        sets.join(a, clash ? n + b : b);
        sets.join(n + a, clash ? b : n + b);
    }
    struct component
    {
        std::size_t first = 0, second = 0, negative = 0; ///< cells of both orders; negative as they are
        double measure = 0;                              ///< where the second ones are turned
    };
    std::vector<component> components(static_cast<std::size_t>(n));
    const auto order = [&](idx c) // the component of a cell, and whether it is one of the second
    {
        const idx here = sets.find(c), turned = sets.find(n + c);
        return std::pair(static_cast<std::size_t>(std::min(here, turned)), here > turned);
    };
    for (idx c = 0; c < n; ++c)
    {
        const auto [at, is_second] = order(c);
        const double measure = measures[static_cast<std::size_t>(c)];
        auto& all = components[at];
        ++(is_second ? all.second : all.first);
        all.negative += measure < 0;
        all.measure += is_second ? -measure : measure;
    }
    std::vector<idx> turned;
    for (idx c = 0; c < n; ++c)
    {
        if (sets.find(c) == sets.find(n + c)) continue; // no order is right
        const auto [at, is_second] = order(c);
        const auto& all = components[at];
        const bool agree = all.first == 0 || all.second == 0;
        const bool second_is_wrong = all.measure > 0 || (all.measure == 0 && all.first >= all.second);
        if (agree ? 10 * all.negative >= 9 * (all.first + all.second) : is_second == second_is_wrong)
            turned.push_back(c);
    }
    return turned;
}

} // namespace taut::io::impl
