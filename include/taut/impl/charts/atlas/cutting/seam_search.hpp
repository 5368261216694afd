// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <functional>
#include <limits>
#include <vector>

#include <taut/charts.hpp>
#include <taut/impl/charts/atlas/cut_to_disk.hpp>
#include <taut/impl/charts/atlas/cutting/over_cut.hpp>
#include <taut/impl/charts/atlas/cutting/part_charts.hpp>
#include <taut/impl/charts/atlas/cutting/patch_energy.hpp>
#include <taut/impl/charts/atlas/cutting/sew_tips.hpp>
#include <taut/impl/charts/atlas/seams/straighten.hpp>

namespace taut::impl
{

/// How seams of one surface are looked for.
struct search_setting
{
    double bound = 4.1;        ///< of the mean energy
    double over = 0.75;        ///< what the map of the surface that is cut too often may take of what is allowed
    double least_weight = 0.3; ///< of ways, where the potential is greatest
    std::size_t patch = 100;   ///< triangles that follow a zip at once
    bool part = true;          ///< charts that lie on themselves are parted
    bool everywhere = false;   ///< even by long cuts
    std::function<bool()> proceed = {};
};

/// Short seams of a connected surface within a bound of distortion, from above: it is cut more than needed along ways
/// to the extremes of a potential of its curvature and mapped; then seams are sewn up from their tips, the cheapest
/// first, and charts parted where they lie on themselves.
class seam_search
{
public:
    /// Loops around handles are never sewn up: where they are longer, by the root of the area, charts that go around
    /// none are better.
    static constexpr double most_loops = 12;

    seam_search(const rest_surface& rest, const search_setting& setting) : rest_(rest), setting_(setting) {}

    /// Maps the surface as it is, without a seam: a disk, or a disk with holes. False if that is above the bound, or
    /// lies on itself; the surface is then searched by run().
    bool run_whole()
    {
        flat_.seam.assign(rest_.facets.twin.size(), 0);
        number_fans(rest_, flat_);
        const bool mapped = start_flat(rest_, flat_);
        constexpr int few = 20;
        constexpr double isometric = 4 + 1e-9; // which needles, that are stiff in the search, need not be
        if (mapped && flat_.energy > isometric)
        {
            relax(rest_, flat_, few, 1e-3);
            if (flat_.energy < 4 + 2 * (setting_.bound - 4)) relax(rest_, flat_, 60, 1e-4);
        }
        if (mapped && flat_.energy <= setting_.bound && border_crossings(rest_, flat_, 1) == 0)
        {
            note(flat_);
            return true;
        }
        flat_ = {};
        return false;
    }

    /// False if there is no map to begin with.
    bool run()
    {
        if (!cut()) return false;
        if (!(flat_.energy <= setting_.bound)) return false;
        sew(false);
        worth_ = worth();
        if (setting_.part) part();
        return true;
    }

    const flat_surface& result() const { return flat_; }
    const search_setting& setting() const { return setting_; }

    /// Whether the surface is so rough that seams of a sensible length are above the bound. These are as good as they
    /// are.
    bool rough() const { return rough_; }

    /// What the seams cost, and what is to be kept apart in the plane: that takes distortion, which others then lack.
    double price() const
    {
        constexpr double any = 0.05, chart = 0.03; // lengths by the root of the area
        const double root = std::sqrt(rest_.total);
        const double apart = any * root + worth_ * overlap() * rest_.total;
        return seam_price(rest_, flat_.seam) + chart * root * (pieces_between(rest_.facets, flat_.seam).second - 1) +
               (border_crossings(rest_, flat_, 1) > 0 ? apart : 0);
    }

    /// The part of the area that lies on other parts of its chart.
    double overlap() const
    {
        double area = 0;
        for (const overlap_layers& one : find_overlaps(rest_, flat_)) area += one.area;
        return area / rest_.total;
    }

    /// The last result, sewn up to another bound.
    /// everywhere: charts that lie on themselves are parted, however long the cuts
    bool adjust(double bound, bool everywhere)
    {
        setting_.bound = bound;
        setting_.everywhere = setting_.everywhere || everywhere;
        if (flat_.energy > bound)
        {
            const auto fits = [bound](const state& s) { return s.flat.energy <= bound; };
            const auto last = std::find_if(trail_.rbegin(), trail_.rend(), fits);
            if (last == trail_.rend()) return false;
            flat_ = last->flat;
            parted_ = last->parted;
            trail_.erase(last.base(), trail_.end());
        }
        sew(parted_);
        if (setting_.part) part();
        return true;
    }

private:
    static constexpr double infinite = std::numeric_limits<double>::infinity();

    struct state
    {
        flat_surface flat;
        bool parted;
    };

    bool proceed() const { return !setting_.proceed || setting_.proceed(); }

    /// The surface cut too often, and its map.
    bool cut()
    {
        flat_.seam = disk_cutting(rest_.surface, rest_.facets).loops();
        budget unlimited;
        constexpr int rounds = 3;
        for (int round = 0; round < rounds; ++round)
            straighten(rest_.surface, rest_.facets, flat_.seam, {}, {}, unlimited, rest_.price);
        const double root = std::sqrt(rest_.total);
        if (seam_length(rest_, flat_.seam) > most_loops * root) return false;
        // Strips of a smooth surface that are half as wide have a sixteenth of the excess.
        const double longest = most_loops * root * std::pow(std::max(1.0, 0.1 / (setting_.bound - 4)), 0.25);
        over_cutting more(rest_, setting_.least_weight);
        constexpr int most = 100;
        const double enough = 4 + setting_.over * (setting_.bound - 4);
        double stop = 0.7;
        for (int turn = 0; turn < 12 && proceed(); ++turn, stop *= 0.8)
        {
            const int added = more.run(flat_.seam, stop, most, longest);
            if (turn > 0 && added == 0) continue;
            number_fans(rest_, flat_);
            if (!start_flat(rest_, flat_)) return false;
            relax(rest_, flat_, 60, 1e-4);
            if (flat_.energy <= enough) break;
        }
        // Corners that few triangles meet in have little curvature for what they distort.
        for (int turn = 0; turn < 40 && flat_.energy > enough && flat_.energy < infinite && proceed(); ++turn)
        {
            if (seam_length(rest_, flat_.seam) > longest) break;
            if (cut_strained(rest_, flat_, 0.5 * (flat_.energy - enough)) == 0) break;
            number_fans(rest_, flat_);
            start_flat(rest_, flat_);
            relax(rest_, flat_, 60, 1e-4);
        }
        if (flat_.energy > setting_.bound && flat_.energy < infinite && seam_length(rest_, flat_.seam) >= longest)
        {
            rough_ = true;
            setting_.bound = 4 + (flat_.energy - 4) / setting_.over;
        }
        return flat_.energy < infinite;
    }

    void sew(bool keep_apart)
    {
        const sewing how{.bound = setting_.bound,
                         .patch = setting_.patch,
                         .keep_apart = keep_apart,
                         .proceed = setting_.proceed,
                         .told = [this](const flat_surface& f) { note(f); }};
        tip_sewing(rest_, flat_, how).run();
    }

    /// The length of seams that could be sewn up for what it costs to keep an overlap apart in the plane, by its area.
    double worth() const
    {
        constexpr double apart = 0.2; // mean energy that an overlap of the whole area would cost, at least
        constexpr double least = 5, most = 15, part = 0.3;
        const double root = std::sqrt(rest_.total);
        const double here = seam_price(rest_, flat_.seam);
        double lengths = 0; // by mean energy, at the bound
        for (const state& s : trail_)
            if (s.flat.energy < flat_.energy - part * (setting_.bound - 4))
                lengths = (seam_price(rest_, s.flat.seam) - here) / (flat_.energy - s.flat.energy);
        return std::clamp(apart * lengths, least * root, most * root) / rest_.total;
    }

    /// Keeps a state to come back to.
    void note(const flat_surface& f)
    {
        const double step = 0.02 * (setting_.bound - 4);
        if (trail_.empty() || trail_.back().parted != parted_ || f.energy > trail_.back().flat.energy + step)
            trail_.push_back({f, parted_});
    }

    void part()
    {
        constexpr int turns = 3;
        for (int turn = 0; turn < turns && proceed() && border_crossings(rest_, flat_, 1) > 0; ++turn)
        {
            if (part_charts(rest_, flat_, {.worth = worth_}) == 0) break;
            relax(rest_, flat_, 8, 1e-5);
            parted_ = true;
            trail_.push_back({flat_, parted_});
            sew(true);
        }
        if (proceed() && border_crossings(rest_, flat_, 1) > 0) part_rest();
    }

    /// Parts small layers, too, if that is worth it.
    void part_rest()
    {
        const state was{flat_, parted_};
        const double before = price();
        const auto kept = trail_.size();
        const parting all{.least_area = 0,
                          .longest = setting_.everywhere ? infinite : parting{}.longest,
                          .worth = worth_,
                          .most = 400,
                          .at_once = true};
        if (part_charts(rest_, flat_, all) == 0) return;
        relax(rest_, flat_, 8, 1e-5);
        parted_ = true;
        trail_.push_back({flat_, parted_});
        sew(true);
        if (setting_.everywhere || price() < before) return;
        flat_ = was.flat;
        parted_ = was.parted;
        trail_.erase(trail_.begin() + static_cast<std::ptrdiff_t>(kept), trail_.end());
    }

    const rest_surface& rest_;
    search_setting setting_;
    flat_surface flat_;
    std::vector<state> trail_; // within the bound, of ever fewer seams
    bool parted_ = false, rough_ = false;
    double worth_ = 0; // of an overlap, by its area
};

} // namespace taut::impl
