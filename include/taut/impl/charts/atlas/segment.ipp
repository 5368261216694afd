// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <limits>
#include <numeric>
#include <span>
#include <utility>
#include <vector>

#include <taut/charts.hpp>
#include <taut/impl/charts/atlas/chart_set.hpp>
#include <taut/impl/charts/atlas/cluster_tree.hpp>
#include <taut/impl/charts/atlas/seams/straighten.hpp>
#include <taut/impl/charts/atlas/segment.hpp>
#include <taut/impl/charts/atlas/unite_charts.hpp>

namespace taut::impl
{

/// Ratio of the distortion of charts to its estimate, if there are enough for a small sample; else 0.
inline double found_ratio(surface_charts& all, const cluster_tree& tree, const std::vector<char>& chosen)
{
    const auto u = surface_charts::u;
    constexpr double share = 0.05;         // of the triangles
    constexpr idx largest = 1000, few = 8; // triangles of a chart; charts
    const auto triangles = tree.triangles_below();
    std::vector<char> some(chosen.size(), 0);
    double quota = 0;
    idx count = 0;
    for (idx n = 0; n < tree.nodes(); ++n)
    {
        if (!chosen[u(n)] || triangles[u(n)] > largest || triangles[u(n)] < 2) continue;
        quota += share * triangles[u(n)];
        if (quota < triangles[u(n)]) continue;
        quota -= triangles[u(n)];
        some[u(n)] = 1;
        ++count;
    }
    if (count < few) return 0;
    double distortion = 0, estimate = 0;
    all.flatten_some(all.surface, all.facets, tree, chosen, some,
                     [&](idx n, double energy)
                     {
                         // What is above the bound is to be cut in any case.
                         distortion += tree.area[u(n)] * (std::min(energy, all.params.max_distortion) - 4);
                         estimate += tree.strain[u(n)];
                     });
    return estimate > 0 ? distortion / estimate : 0;
}

/// Large charts cost most where no map is any good. The distortion of a map is no less than the one that its parts
/// have by themselves, so some of these are flattened first, and charts of which too many are above the bound
/// become their parts. chosen: nodes of the tree of a surface, changed
inline void part_hopeless(surface_charts& all, const mesh<triangle>& m, const facet_table& f, const cluster_tree& tree,
                          std::vector<char>& chosen)
{
    const auto u = surface_charts::u;
    constexpr idx large = 2500, most = 1000; // triangles of a chart that is looked at, of a part
    constexpr double share = 0.1;            // of the triangles that are flattened
    constexpr double spoiled = 0.25;         // of their area
    const auto triangles = tree.triangles_below();
    std::vector<idx> whole(u(tree.nodes()), cluster_tree::none);
    std::vector<char> parts(u(tree.nodes()), 0), some(u(tree.nodes()), 0); // parts of large charts, those looked at
    std::vector<double> seen(u(tree.nodes()), 0), bad(u(tree.nodes()), 0); // of a chart: area of these
    std::vector<double> quota(u(tree.nodes()), 0);
    for (idx n = tree.nodes(); n-- > 0;)
    {
        const idx parent = tree.parents[u(n)];
        if (chosen[u(n)])
            whole[u(n)] = triangles[u(n)] > large ? n : cluster_tree::none;
        else if (parent != cluster_tree::none && triangles[u(parent)] > most)
            whole[u(n)] = whole[u(parent)];
        if (whole[u(n)] == cluster_tree::none || triangles[u(n)] > most) continue;
        parts[u(n)] = 1;
        double& left = quota[u(whole[u(n)])]; // every so many triangles one part, so that all regions are looked at
        left += share * triangles[u(n)];
        if (left < triangles[u(n)] || 4 * triangles[u(n)] < most) continue;
        left -= triangles[u(n)];
        some[u(n)] = 1;
    }
    if (std::count(some.begin(), some.end(), char(1)) == 0) return;
    all.flatten_some(m, f, tree, parts, some,
                     [&](idx n, double energy)
                     {
                         const auto chart = u(whole[u(n)]);
                         seen[chart] += tree.area[u(n)];
                         if (!(energy <= all.params.max_distortion)) bad[chart] += tree.area[u(n)];
                     });
    for (idx n = 0; n < tree.nodes(); ++n)
    {
        if (!parts[u(n)] || !(bad[u(whole[u(n)])] > spoiled * seen[u(whole[u(n)])])) continue;
        chosen[u(n)] = 1;
        chosen[u(whole[u(n)])] = 0;
    }
}

/// Computes the seams of an initial set of charts. The estimate is about twice the distortion of maps on smooth
/// surfaces; on others it is calibrated by some charts.
inline void cut_by_estimate(surface_charts& all)
{
    const auto u = surface_charts::u;
    const auto tree = make_cluster_tree(all.surface, all.facets, all.params.seams, all.params.together, {}, &all.clock,
                                        all.params.weights);
    std::vector<char> chosen(u(tree.nodes()), 0);
    for (idx n = 0; n < tree.nodes(); ++n) chosen[u(n)] = tree.parents[u(n)] == cluster_tree::none;
    double strain = 0;
    const auto undo = [&](idx n)
    {
        chosen[u(n)] = 0;
        strain -= tree.strain[u(n)];
        for (const idx child : tree.children[u(n - tree.leaves)])
            if (child != cluster_tree::none)
            {
                chosen[u(child)] = 1;
                strain += tree.strain[u(child)];
            }
    };
    double ratio = 0.5; // of distortion to its estimate
    for (int pass = 0; pass < 3 && all.clock.proceed(); ++pass)
    {
        strain = 0;
        for (idx n = 0; n < tree.nodes(); ++n) strain += chosen[u(n)] ? tree.strain[u(n)] : 0;
        for (idx n = tree.nodes(); n-- > tree.leaves && ratio * strain > all.allowed();)
            if (chosen[u(n)]) undo(n);
        if (pass == 0) part_hopeless(all, all.surface, all.facets, tree, chosen);
        if (!all.clock.proceed()) break;
        const double found = found_ratio(all, tree, chosen);
        if (!(found > 1.25 * ratio)) break;
        ratio = found;
    }
    all.laid.seam = tree.seams(all.facets, tree.labels(chosen));
    if (!all.clock.proceed()) return;
    straighten(all.surface, all.facets, all.laid.seam, all.params.seams, all.params.together, all.clock,
               seam_weights(all.surface, all.facets, all.params.weights));
}

/// The nodes of a tree of charts, one flag each, that part each of these: into two, so that what overlaps is separate,
/// and until the estimated distortion of strained ones is halved. Pieces are undone in the order from the last.
inline std::vector<char> halves(const surface_charts& all, const surface_part& part, const cluster_tree& tree)
{
    const auto u = surface_charts::u;
    std::vector<char> chosen(u(tree.nodes()), 0);
    std::vector<idx> root(u(tree.nodes()), 0), pieces(u(tree.nodes()), 0);
    std::vector<double> strain(u(tree.nodes()), 0), wanted(u(tree.nodes()), 0);
    for (idx n = tree.nodes(); n-- > 0;)
    {
        const idx parent = tree.parents[u(n)];
        root[u(n)] = parent == cluster_tree::none ? n : root[u(parent)];
    }
    // A chart may have several roots, where given seams part it or what overlaps is apart.
    std::vector<idx> roots(all.records.size(), 0);
    std::vector<idx> first(u(tree.nodes()), cluster_tree::none); // a triangle of each root
    for (idx n = 0; n < tree.triangles; ++n)
        if (idx& one = first[u(root[u(n)])]; one == cluster_tree::none)
        {
            one = n;
            ++roots[u(all.chart[u(part.triangles[u(n)])])];
        }
    for (idx n = 0; n < tree.nodes(); ++n)
        if (root[u(n)] == n)
        {
            chosen[u(n)] = 1;
            strain[u(n)] = tree.strain[u(n)];
            if (first[u(n)] == cluster_tree::none) continue; // a hole
            const auto k = u(all.chart[u(part.triangles[u(first[u(n)])])]);
            const bool enough = roots[k] > 1 && !all.records[k].strained;
            pieces[u(n)] = enough ? 2 : 1;
            wanted[u(n)] = enough ? surface_charts::infinite : tree.strain[u(n)] / 2;
        }
    for (idx n = tree.nodes(); n-- > tree.leaves;)
    {
        const auto r = u(root[u(n)]);
        if (!chosen[u(n)] || (pieces[r] > 1 && strain[r] <= wanted[r])) continue;
        chosen[u(n)] = 0;
        strain[r] -= tree.strain[u(n)];
        --pieces[r];
        for (const idx child : tree.children[u(n - tree.leaves)])
            if (child != cluster_tree::none)
            {
                chosen[u(child)] = 1;
                strain[r] += tree.strain[u(child)];
                pieces[r] += tree.area[u(child)] > 0;
            }
    }
    return chosen;
}

/// Cuts each of these charts so that overlapping parts are separate, and the estimated distortion of strained ones
/// is halved.
inline void cut(surface_charts& all, std::span<const idx> charts)
{
    const auto u = surface_charts::u;
    all.report.cut += static_cast<idx>(charts.size());
    const auto triangles = all.triangles_of(charts);
    const surface_part part = part_of(all.surface, triangles, all.laid.seam);
    const auto f = facets(part.charts.surface);
    const auto keep = part.by_side(all.params.seams), together = part.by_side(all.params.together);
    const auto weights = part.by_side(all.params.weights);
    std::vector<std::array<idx, 2>> apart;
    std::vector<idx> place(all.chart.size(), -1);
    for (std::size_t i = 0; i < part.triangles.size(); ++i) place[u(part.triangles[i])] = static_cast<idx>(i);
    for (const idx k : charts)
        for (const auto& [a, b] : all.records[u(k)].shape.meetings)
            if (a != b) apart.push_back({place[u(a)], place[u(b)]});
    const auto tree = make_cluster_tree(part.charts.surface, f, keep, together, apart, &all.clock, weights);
    auto chosen = halves(all, part, tree);
    if (all.clock.over()) return; // the charts that there are have maps
    part_hopeless(all, part.charts.surface, f, tree, chosen);
    if (!all.clock.proceed()) return;
    auto seam = tree.seams(f, tree.labels(chosen));
    straighten(part.charts.surface, f, seam, keep, together, all.clock, seam_weights(part.charts.surface, f, weights));
    if (all.clock.over()) return;
    for (std::size_t s = 0; s < seam.size(); ++s)
        if (f.twin[s] >= 0) all.laid.seam[part.origin(s)] = seam[s];
    all.renew(triangles);
}

/// Cuts the charts above the bound, and the worst ones if the whole surface is. Returns false if there are none.
inline bool cut_round(surface_charts& all)
{
    const auto u = surface_charts::u;
    std::vector<idx> order;
    double excess = 0;
    for (idx k = 0; k < static_cast<idx>(all.records.size()); ++k)
        if (all.records[u(k)].triangles.size() > 1)
        {
            order.push_back(k);
            excess += all.to_share(all.records[u(k)]);
        }
    std::stable_sort(order.begin(), order.end(),
                     [&](idx a, idx b) { return all.records[u(a)].excess() > all.records[u(b)].excess(); });
    std::vector<idx> chosen;
    for (const idx k : order)
    {
        const chart_record& r = all.records[u(k)];
        const bool ragged = r.shape.fill < all.params.tuning.least_fill && r.area > all.total_area / 200;
        if (r.energy <= all.params.max_distortion && !r.shape.crosses && !ragged && excess <= all.allowed()) continue;
        all.records[u(k)].strained = r.energy > all.params.max_distortion || ragged || excess > all.allowed();
        chosen.push_back(k);
        excess -= 0.6 * all.to_share(r); // what two halves have less, about
    }
    if (chosen.empty()) return false;
    cut(all, chosen);
    return true;
}

uncut_segmentation segment_surface(const mesh<triangle>& m, const facet_table& f, const charts_to_maps& flatten,
                                   const segment_params& params, const run_limits& limits)
{
    params.validate();
    limits.validate();
    surface_charts all(m, f, flatten, params, limits);
    cut_by_estimate(all);
    if (all.clock.over()) // pieces without maps, and without records of their own
    {
        all.records.push_back(
            {.area = all.total_area, .energy = surface_charts::infinite, .shape = {}, .triangles = {}});
        return all.result();
    }
    std::vector<idx> triangles(all.chart.size());
    std::iota(triangles.begin(), triangles.end(), idx(0));
    all.renew(triangles);
    for (int round = 0; round < params.tuning.cut_rounds && all.proceed(round); ++round)
    {
        const bool sewn = unite_round(all, unions::slits);
        if (!cut_round(all) && !sewn) break;
    }
    unite_all(all);
    if (params.tuning.unite_rounds > 0 && all.proceed(params.tuning.unite_rounds)) unite_round(all, unions::small);
    all.settle();
    return all.result();
}

segmentation cut_apart(const mesh<triangle>& m, const facet_table& f, uncut_segmentation made,
                       const segment_params& params)
{
    chart_set set = cut(m, f, std::move(made.laid));
    segmentation r{std::move(set.seam), std::move(set.charts), std::move(set.uv), std::move(set.energy), made.report};
    r.report.seam_length = length_of_seams(m, f, r.seam);
    for (std::size_t k = 0; k < r.energy.size(); ++k)
    {
        r.report.unmapped += !(r.energy[k] < std::numeric_limits<double>::infinity());
        r.report.above += r.energy[k] > params.max_distortion;
        r.report.crossing += made.crosses[static_cast<std::size_t>(r.charts.first_triangle(k))];
    }
    return r;
}

} // namespace taut::impl
