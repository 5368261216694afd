// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <numeric>

#include <taut/impl/atlas/chart_moments.hpp>
#include <taut/impl/atlas/chart_set.hpp>
#include <taut/impl/atlas/cluster_tree.hpp>
#include <taut/impl/atlas/seams/seam_arcs.hpp>
#include <taut/impl/atlas/seams/straighten.hpp>
#include <taut/impl/atlas/segment.hpp>
#include <taut/impl/atlas/surface_charts.hpp>
#include <taut/impl/atlas/surface_part.hpp>
#include <taut/impl/mesh/boundary.hpp>

namespace taut::impl
{

/// Charts of a surface during cuts and unions.
class segmenting : surface_charts
{
public:
    using surface_charts::surface_charts;

    uncut_segmentation run()
    {
        cut_by_estimate();
        if (budget_.over()) // pieces without maps, and without records of their own
        {
            charts_.push_back({.area = total_area_, .energy = infinite, .shape = {}, .triangles = {}});
            return result();
        }
        std::vector<idx> all(chart_.size());
        std::iota(all.begin(), all.end(), idx(0));
        renew(all);
        for (int round = 0; round < params_.tuning.cut_rounds && proceed(round); ++round)
        {
            const bool sewn = unite_round(unions::slits);
            if (!cut_round() && !sewn) break;
        }
        unite_all();
        if (params_.tuning.unite_rounds > 0 && proceed(params_.tuning.unite_rounds)) unite_round(unions::small);
        settle();
        return result();
    }

private:
    /// Unites pairs in rounds; one that unites less than a fifteenth of more than a thousand charts is the last.
    void unite_all()
    {
        for (idx round = 0; round < params_.tuning.unite_rounds && proceed(round); ++round)
        {
            const auto left =
                std::count_if(charts_.begin(), charts_.end(), [](auto& r) { return !r.triangles.empty(); });
            const std::ptrdiff_t before = report_.united;
            if (!unite_round(unions::all) || (left > 1000 && 15 * (report_.united - before) < left)) return;
        }
    }

    /// Computes the seams of an initial set of charts. The estimate is about twice the distortion of maps on smooth
    /// surfaces; on others it is calibrated by some charts.
    void cut_by_estimate()
    {
        budget_.lap();
        const auto tree =
            make_cluster_tree(mesh_, facets_, params_.seams, params_.together, {}, &budget_, params_.weights);
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
        for (int pass = 0; pass < 3 && budget_.proceed(); ++pass)
        {
            strain = 0;
            for (idx n = 0; n < tree.nodes(); ++n) strain += chosen[u(n)] ? tree.strain[u(n)] : 0;
            for (idx n = tree.nodes(); n-- > tree.leaves && ratio * strain > allowed();)
                if (chosen[u(n)]) undo(n);
            report_.tree_seconds += budget_.lap();
            if (pass == 0) part_hopeless(mesh_, facets_, tree, chosen);
            if (!budget_.proceed()) break;
            const double found = found_ratio(tree, chosen);
            if (!(found > 1.25 * ratio)) break;
            ratio = found;
        }
        seam_ = tree.seams(facets_, tree.labels(chosen));
        if (!budget_.proceed()) return;
        straighten(mesh_, facets_, seam_, params_.seams, params_.together, budget_,
                   seam_weights(mesh_, facets_, params_.weights));
        report_.straighten_seconds += budget_.lap();
    }

    /// Ratio of the distortion of charts to its estimate, if there are enough for a small sample; else 0.
    double found_ratio(const cluster_tree& tree, const std::vector<char>& chosen)
    {
        constexpr double share = 0.05;         // of the triangles
        constexpr idx largest = 1000, few = 8; // triangles of a chart; charts
        const auto triangles = triangles_below(tree);
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
        flatten_some(mesh_, facets_, tree, chosen, some,
                     [&](idx n, double energy, bool)
                     {
                         // What is above the bound is to be cut in any case.
                         distortion += tree.area[u(n)] * (std::min(energy, params_.max_distortion) - 4);
                         estimate += tree.strain[u(n)];
                     });
        return estimate > 0 ? distortion / estimate : 0;
    }

    /// Large charts cost most where no map is any good. The distortion of a map is no less than the one that its parts
    /// have by themselves, so some of these are flattened first, and charts of which too many are above the bound
    /// become their parts. chosen: nodes of the tree of a surface, changed
    void part_hopeless(const mesh<triangle>& m, const facet_table& f, const cluster_tree& tree,
                       std::vector<char>& chosen)
    {
        constexpr idx large = 2500, most = 1000; // triangles of a chart that is looked at, of a part
        constexpr double share = 0.1;            // of the triangles that are flattened
        constexpr double spoiled = 0.25;         // of their area
        const auto triangles = triangles_below(tree);
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
        flatten_some(m, f, tree, parts, some,
                     [&](idx n, double energy, bool)
                     {
                         const auto chart = u(whole[u(n)]);
                         seen[chart] += tree.area[u(n)];
                         if (!(energy <= params_.max_distortion)) bad[chart] += tree.area[u(n)];
                     });
        for (idx n = 0; n < tree.nodes(); ++n)
        {
            if (!parts[u(n)] || !(bad[u(whole[u(n)])] > spoiled * seen[u(whole[u(n)])])) continue;
            chosen[u(n)] = 1;
            chosen[u(whole[u(n)])] = 0;
        }
    }

    /// Cuts the charts above the bound, and the worst ones if the whole surface is. Returns false if there are none.
    bool cut_round()
    {
        std::vector<idx> order;
        double excess = 0;
        for (idx k = 0; k < static_cast<idx>(charts_.size()); ++k)
            if (charts_[u(k)].triangles.size() > 1)
            {
                order.push_back(k);
                excess += to_share(charts_[u(k)]);
            }
        std::stable_sort(order.begin(), order.end(),
                         [&](idx a, idx b) { return charts_[u(a)].excess() > charts_[u(b)].excess(); });
        std::vector<idx> chosen;
        for (const idx k : order)
        {
            const record& r = charts_[u(k)];
            const bool ragged = r.shape.fill < params_.tuning.least_fill && r.area > total_area_ / 200;
            if (r.energy <= params_.max_distortion && !r.shape.crosses && !ragged && excess <= allowed()) continue;
            charts_[u(k)].strained = r.energy > params_.max_distortion || ragged || excess > allowed();
            chosen.push_back(k);
            excess -= 0.6 * to_share(r); // what two halves have less, about
        }
        if (chosen.empty()) return false;
        cut(chosen);
        return true;
    }

    /// Cuts each of these charts so that overlapping parts are separate, and the estimated distortion of strained ones
    /// is halved.
    void cut(std::span<const idx> charts)
    {
        report_.cut += static_cast<idx>(charts.size());
        const auto triangles = triangles_of(charts);
        const surface_part part = part_of(mesh_, triangles, seam_, number_);
        const auto f = facets(part.charts.surface);
        budget_.lap();
        const auto of_part = [&](std::span<const char> flags)
        {
            std::vector<char> result(flags.empty() ? 0 : f.twin.size(), 0);
            for (std::size_t s = 0; s < result.size(); ++s) result[s] = flags[part.origin(s)];
            return result;
        };
        const auto keep = of_part(params_.seams), together = of_part(params_.together);
        std::vector<double> weights(params_.weights.empty() ? 0 : f.twin.size());
        for (std::size_t s = 0; s < weights.size(); ++s) weights[s] = params_.weights[part.origin(s)];
        std::vector<std::array<idx, 2>> apart;
        for (std::size_t i = 0; i < part.triangles.size(); ++i) place_[u(part.triangles[i])] = static_cast<idx>(i);
        for (const idx k : charts)
            for (const auto& [a, b] : charts_[u(k)].shape.meetings)
                if (a != b) apart.push_back({place_[u(a)], place_[u(b)]});
        const auto tree = make_cluster_tree(part.charts.surface, f, keep, together, apart, &budget_, weights);

        // Pieces of a chart are undone in the order from the last.
        std::vector<char> chosen(u(tree.nodes()), 0);
        std::vector<idx> root(u(tree.nodes()), 0), pieces(u(tree.nodes()), 0);
        std::vector<double> strain(u(tree.nodes()), 0), wanted(u(tree.nodes()), 0);
        for (idx n = tree.nodes(); n-- > 0;)
        {
            const idx parent = tree.parents[u(n)];
            root[u(n)] = parent == cluster_tree::none ? n : root[u(parent)];
        }
        // A chart may have several roots, where given seams part it or what overlaps is apart.
        const auto chart_of = [&](idx n) { return root[u(n)]; };
        std::vector<idx> roots(charts_.size(), 0);
        std::vector<idx> first(u(tree.nodes()), cluster_tree::none); // a triangle of each root
        for (idx n = 0; n < tree.triangles; ++n)
            if (idx& one = first[u(root[u(n)])]; one == cluster_tree::none)
            {
                one = n;
                ++roots[u(chart_[u(part.triangles[u(n)])])];
            }
        for (idx n = 0; n < tree.nodes(); ++n)
            if (root[u(n)] == n)
            {
                chosen[u(n)] = 1;
                strain[u(n)] = tree.strain[u(n)];
                if (first[u(n)] == cluster_tree::none) continue; // a hole
                const auto k = u(chart_[u(part.triangles[u(first[u(n)])])]);
                const bool enough = roots[k] > 1 && !charts_[k].strained;
                pieces[u(n)] = enough ? 2 : 1;
                wanted[u(n)] = enough ? infinite : tree.strain[u(n)] / 2;
            }
        for (idx n = tree.nodes(); n-- > tree.leaves;)
        {
            const auto r = u(chart_of(n));
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
        report_.tree_seconds += budget_.lap();
        if (budget_.over()) return; // the charts that there are have maps
        part_hopeless(part.charts.surface, f, tree, chosen);
        if (!budget_.proceed()) return;
        auto seam = tree.seams(f, tree.labels(chosen));
        straighten(part.charts.surface, f, seam, keep, together, budget_,
                   seam_weights(part.charts.surface, f, weights));
        if (budget_.over()) return;
        for (std::size_t s = 0; s < seam.size(); ++s)
            if (f.twin[s] >= 0) seam_[part.origin(s)] = seam[s];
        report_.straighten_seconds += budget_.lap();
        renew(triangles);
    }

    /// Candidates for unions of charts.
    enum class unions
    {
        all,   ///< pairs of neighbours
        small, ///< such pairs of little area: cuts leave many behind, and they cost little
        slits  ///< charts that cross themselves, without a slit that may be why
    };

    /// Flattens pairs of neighbouring charts as one, and keeps those within the bounds. Returns false if no pair is
    /// left.
    bool unite_round(unions what)
    {
        constexpr double little = 0.01; // of all area
        const bool slits = what == unions::slits;
        struct pair
        {
            double price = 0;
            idx arc = 0;
            std::array<idx, 2> charts;
        };
        const double room = allowed() - total_excess();
        if (!(room > 0)) return false;
        const auto crossing = [](const record& r) { return !r.triangles.empty() && r.shape.crosses; };
        if (slits && std::none_of(charts_.begin(), charts_.end(), crossing)) return false;
        if (sides_.items.empty()) sides_ = starting_sides(mesh_);
        const csr arcs = seam_arcs(mesh_, facets_, sides_, seam_);
        std::vector<chart_moments> moments(charts_.size());
        for (idx c = 0; c < mesh_.cell_count(); ++c)
        {
            const auto x = mesh_.rest(c);
            moments[u(chart_[u(c)])] += chart_moments::of_triangle(glm::cross(x[1] - x[0], x[2] - x[0]));
            for (std::size_t s = 3 * u(c); s < 3 * u(c) + 3; ++s)
                if (facets_.twin[s] < 0 || seam_[s]) moments[u(chart_[u(c)])].perimeter += length(s);
        }
        std::vector<pair> pairs;
        for (idx a = 0; a < arcs.rows(); ++a)
        {
            const idx side = arcs.row(a)[0];
            const idx p = chart_[u(side) / 3], q = chart_[u(facets_.twin[u(side)]) / 3];
            if ((p == q) != slits || (slits && !charts_[u(p)].shape.crosses)) continue;
            if (!(charts_[u(p)].energy < infinite) || !(charts_[u(q)].energy < infinite)) continue;
            double shared = 0;
            bool kept = false;
            for (const idx s : arcs.row(a))
            {
                shared += length(u(s));
                kept = kept || (!params_.seams.empty() && params_.seams[u(s)]);
            }
            const std::array<idx, 2> both{std::min(p, q), std::max(p, q)};
            if (kept || std::binary_search(refused_.begin(), refused_.end(), both)) continue;
            chart_moments sum = moments[u(p)];
            if (p != q) sum += moments[u(q)];
            sum.perimeter -= 2 * shared;
            if (what == unions::small && sum.area > little * total_area_) continue;
            const double strain = sum.strain();
            // An estimate that is far above the bound is seldom wrong.
            if (strain / sum.area > 4 * (params_.max_distortion - 4)) continue;
            const double more = strain / 2 - before(both).excess();
            if (more < 2 * room) pairs.push_back({more, a, both});
        }
        std::stable_sort(pairs.begin(), pairs.end(), [](const pair& x, const pair& y) { return x.price < y.price; });

        std::vector<char> taken(charts_.size(), 0);
        std::vector<pair> tried;
        double planned = 0;
        for (const pair& p : pairs)
        {
            if (taken[u(p.charts[0])] || taken[u(p.charts[1])] || planned > 2 * room) continue;
            taken[u(p.charts[0])] = taken[u(p.charts[1])] = 1;
            planned += std::max(0.0, p.price);
            tried.push_back(p);
        }
        return !tried.empty() && try_pairs(arcs, tried, room, what);
    }

    /// Returns whether a chart is a disk, or one with holes: by Euler, V - E + F = 2 - loops.
    static std::vector<char> planar(const chart_mesh& charts)
    {
        std::vector<idx> twice(u(charts.charts()), 0), loops(twice.size(), 0); // twice V - E + F
        std::size_t k = 0;
        for (const auto& loop : boundary_loops(charts.surface))
        {
            while (loop[0] >= charts.first_vertex[k + 1]) ++k;
            ++loops[k];
            twice[k] -= static_cast<idx>(loop.size());
        }
        std::vector<char> result(twice.size());
        for (k = 0; k < twice.size(); ++k)
        {
            twice[k] += 2 * (charts.first_vertex[k + 1] - charts.first_vertex[k]) -
                        (charts.first_cell[k + 1] - charts.first_cell[k]);
            result[k] = loops[k] > 0 && twice[k] == 2 * (2 - loops[k]);
        }
        return result;
    }

    /// True if one was kept.
    template <class Pairs>
    bool try_pairs(const csr& arcs, const Pairs& tried, double room, unions what)
    {
        auto seam = seam_;
        std::vector<idx> involved;
        std::vector<std::size_t> pair_of(charts_.size(), 0);
        for (std::size_t i = 0; i < tried.size(); ++i)
        {
            for (const idx s : arcs.row(tried[i].arc)) seam[u(s)] = seam[u(facets_.twin[u(s)])] = 0;
            for (const idx k : tried[i].charts) pair_of[u(k)] = i;
            involved.push_back(tried[i].charts[0]);
            if (tried[i].charts[1] != tried[i].charts[0]) involved.push_back(tried[i].charts[1]);
        }
        const auto pair_at = [&](const surface_part& part, idx k)
        { return pair_of[u(chart_[u(part.triangles[u(part.charts.first_cell[u(k)])])])]; };
        surface_part part = part_of(mesh_, triangles_of(involved), seam, number_);
        // A slit around a handle, or the only one of a closed surface, must stay.
        const auto open = planar(part.charts);
        involved.clear();
        for (idx k = 0; k < part.charts.charts(); ++k)
        {
            const auto& charts = tried[pair_at(part, k)].charts;
            if (!open[u(k)])
                refused_.push_back(charts);
            else
                for (std::size_t i = 0; i < (charts[0] == charts[1] ? 1U : 2U); ++i) involved.push_back(charts[i]);
        }
        std::sort(refused_.begin(), refused_.end());
        if (involved.empty()) return false;
        if (std::count(open.begin(), open.end(), 0) > 0) part = part_of(mesh_, triangles_of(involved), seam, number_);
        const auto [maps, shapes] = flatten(part);
        if (budget_.over()) return false;

        struct trial
        {
            double more = 0;
            std::size_t pair = 0;
            idx chart = 0; // of the part
        };
        // Slim charts do not pack well, and small ones are what fills the gaps.
        const double slimmest = what == unions::small ? 0.85 : 0.72;
        std::vector<trial> trials;
        for (idx k = 0; k < part.charts.charts(); ++k)
        {
            const std::size_t i = pair_at(part, k);
            const record was = before(tried[i].charts);
            const double more = (maps.energy[u(k)] - 4) * was.area - was.excess();
            const laid_shape& shape = shapes[u(k)];
            const bool slit = tried[i].charts[0] == tried[i].charts[1]; // there may be others
            const bool lies_well = !shape.crosses && shape.fill >= std::min(slimmest, was.shape.fill);
            const bool good = maps.energy[u(k)] <= params_.max_distortion && (slit || lies_well);
            trials.push_back({good ? more : infinite, i, k});
        }
        std::stable_sort(trials.begin(), trials.end(), [](const trial& x, const trial& y) { return x.more < y.more; });
        const idx united = report_.united;
        for (const trial& t : trials)
        {
            const auto& pair = tried[t.pair];
            if (!(t.more <= room))
            {
                refused_.push_back(pair.charts);
                continue;
            }
            room -= t.more;
            accept(arcs.row(pair.arc), pair.charts, part, maps, shapes[u(t.chart)], t.chart);
        }
        std::sort(refused_.begin(), refused_.end());
        return report_.united > united;
    }

    /// Replaces two charts by their union, which is chart k of a part.
    void accept(std::span<const idx> arc, const std::array<idx, 2>& charts, const surface_part& part,
                const chart_maps& maps, const laid_shape& shape, idx k)
    {
        ++report_.united;
        for (const idx s : arc) seam_[u(s)] = seam_[u(facets_.twin[u(s)])] = 0;
        for (const idx old : charts) charts_[u(old)].triangles.clear();
        take(part, maps, shape, k);
    }
};

uncut_segmentation segment_surface(const mesh<triangle>& m, const facet_table& f, const charts_to_maps& flatten,
                                   const segment_params& params)
{
    params.validate();
    return segmenting(m, f, flatten, params).run();
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
