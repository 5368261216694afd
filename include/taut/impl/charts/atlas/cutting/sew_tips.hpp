// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstddef>
#include <functional>
#include <limits>
#include <span>
#include <utility>
#include <vector>

#include <taut/impl/charts/atlas/cutting/flat_surface.hpp>
#include <taut/impl/charts/atlas/cutting/zip.hpp>

namespace taut::impl
{

/// How seams are sewn up.
struct sewing
{
    double bound = 4.1;            ///< of the mean energy
    std::size_t patch = 100;       ///< triangles around a tip that follow at once
    bool keep_apart = false;       ///< no zip after which charts meet themselves more often than before
    bool whole = true;             ///< the whole map follows now and then; false: patches alone, for large surfaces
    std::function<bool()> proceed; ///< asked between zips: go on?
    std::function<void(const flat_surface&)> told; ///< of each state that is within the bound
};

/// Sews up seams from their tips, those first that cost least energy for their length, until the next would lead above
/// a bound. Prices are of a patch around the tip whose rim stays; every so many zips the whole map follows.
class tip_sewing
{
public:
    tip_sewing(const rest_surface& rest, flat_surface& flat, const sewing& how)
        : rest_(rest),
          flat_(flat),
          how_(how),
          zipper_(rest, how.patch),
          changed_(rest.surface.cells().size(), 0),
          prices_(rest.surface.points().size())
    {
    }

    /// The map is within the bound before, and afterwards.
    void run()
    {
        if (!(flat_.energy <= how_.bound)) return;
        if (!how_.whole) return run_in_patches();
        find_tips();
        crossings_ = how_.keep_apart ? border_crossings(rest_, flat_, most_crossings) : 0;
        flat_surface good = flat_;
        std::vector<idx> good_tips = tips_, taken;
        idx good_now = now_, good_map = map_;
        int since = 0, batch = 12;
        while (!how_.proceed || how_.proceed())
        {
            const idx tip = cheapest(batch == 1);
            bool over = false;
            if (tip >= 0)
            {
                taken.push_back(tip);
                if (sew(tip)) ++since;
                over = flat_.energy > how_.bound;
            }
            if (since < batch && !over && tip >= 0) continue;
            since = 0;
            map_ = ++maps_;
            whole_newton all(rest_, flat_);
            all.run(2, 1e-5);
            if (flat_.energy > how_.bound) all.run(8, 1e-5, how_.bound);
            if (flat_.energy > how_.bound)
            {
                flat_ = good;
                tips_ = good_tips;
                map_ = good_map;
                forget(good_now);
                if (batch == 1)
                    for (const idx t : taken) prices_[u(t)].barred = true;
                batch = 1;
            }
            else
            {
                good = flat_;
                good_tips = tips_;
                good_now = now_;
                good_map = map_;
                marks_.clear();
                if (how_.keep_apart) crossings_ = border_crossings(rest_, flat_, most_crossings);
                if (how_.told) how_.told(flat_);
                if (flat_.energy > how_.bound - 0.03 * (how_.bound - 4)) batch = 1;
            }
            taken.clear();
            if (tip < 0) break;
        }
        relax(rest_, flat_, 10, 1e-6);
    }

private:
    void run_in_patches()
    {
        find_tips();
        crossings_ = how_.keep_apart ? border_crossings(rest_, flat_, most_crossings) : 0;
        while (!how_.proceed || how_.proceed())
        {
            const idx tip = cheapest(false);
            if (tip < 0) return;
            if (flat_.energy + prices_[u(tip)].found.more / rest_.total > how_.bound)
                prices_[u(tip)].barred = true; // a short edge, or one that is cheap for its length, may come after
            else
                sew(tip);
            marks_.clear();
        }
    }

    static constexpr std::size_t most_crossings = 1000;
    static constexpr double infinite = std::numeric_limits<double>::infinity();
    static std::size_t u(idx i) { return static_cast<std::size_t>(i); }

    struct price
    {
        double rate = infinite; // energy by price of the seam
        zip found;              // in the map `map`, as far as other zips have left its triangles as they were
        idx when = 0, map = 0;
        bool known = false, barred = false;
    };

    struct mark
    {
        idx triangle, before; // what changed_ was
    };

    /// Goes back to when triangles had been changed so often: prices of other states are not those of now.
    void forget(idx when)
    {
        for (; !marks_.empty(); marks_.pop_back()) changed_[u(marks_.back().triangle)] = marks_.back().before;
        for (price& p : prices_)
            if (p.when > when || p.map != map_) p.known = false;
    }

    bool is_tip(idx v) const { return !rest_.rim[u(v)] && seam_degree(rest_, flat_.seam, v) == 1; }

    void find_tips()
    {
        tips_.clear();
        for (idx v = 0; v < rest_.vertices(); ++v)
            if (is_tip(v)) tips_.push_back(v);
    }

    /// The tip that costs least, or -1. likely: of those that the bound probably allows
    idx cheapest(bool likely)
    {
        constexpr double given_back = 0.6; // by the whole map, of what a patch with a rim that stays costs, at most
        idx best = -1;
        double least = infinite;
        for (const idx t : tips_)
        {
            price& p = prices_[u(t)];
            if (p.barred) continue;
            if (!is_known(p)) find_price(t);
            const bool hopeless = likely && flat_.energy + (1 - given_back) * p.found.more / rest_.total > how_.bound;
            if (p.rate < least && !hopeless) // the first of equal ones
            {
                least = p.rate;
                best = t;
            }
        }
        return best;
    }

    bool is_known(const price& p) const
    {
        const auto is_stale = [&](idx c) { return changed_[u(c)] > p.when; };
        return p.known && std::none_of(p.found.triangles.begin(), p.found.triangles.end(), is_stale);
    }

    void find_price(idx tip)
    {
        price& p = prices_[u(tip)];
        p.found = zipper_.look(flat_, tip);
        p.known = true;
        p.when = now_;
        p.map = map_;
        p.rate = p.found.side < 0 ? infinite : p.found.more / rest_.price[u(p.found.side)];
    }

    /// Whether it was done.
    bool sew(idx tip)
    {
        price& p = prices_[u(tip)];
        if (p.map != map_) find_price(tip); // the whole map has followed since
        const zip& z = p.found;
        if (!(z.more < infinite)) return false;
        if (how_.keep_apart)
        {
            const auto was = zipper_.remember(flat_, z);
            zipper_.apply(flat_, z);
            if (const std::size_t then = border_crossings(rest_, flat_, most_crossings); then > crossings_)
            {
                zipper_.take_back(flat_, z, was);
                p.rate = infinite;
                p.when = now_;
                return false;
            }
            else
                crossings_ = then;
        }
        else
            zipper_.apply(flat_, z);
        ++now_;
        const zip done = std::exchange(p.found, {});
        p.known = false;
        for (const idx c : done.triangles) marks_.push_back({c, std::exchange(changed_[u(c)], now_)});
        const idx next = rest_.end(done.side);
        std::erase(tips_, tip);
        std::erase(tips_, next);
        if (is_tip(next)) tips_.insert(std::lower_bound(tips_.begin(), tips_.end(), next), next);
        prices_[u(next)].known = false;
        return true;
    }

    const rest_surface& rest_;
    flat_surface& flat_;
    const sewing& how_;
    zipper zipper_;
    std::vector<idx> changed_; // one a triangle: when it was
    idx now_ = 1;
    idx map_ = 0, maps_ = 0;    // that the whole map has followed to, of how many
    std::vector<mark> marks_;   // of changed_, since the last good state
    std::vector<price> prices_; // one a vertex
    std::vector<idx> tips_;     // ascending
    std::size_t crossings_ = 0;
};

/// Sews up seams of charts that have a map, on the surface itself, until they are at a bound of their mean energy.
/// kept: sides that stay seams, or empty; factors: what a unit of length of a seam counts along each side, or empty
/// Returns whether something has changed.
inline bool sew_laid(const mesh<triangle>& m, const laid_seams& laid, std::span<const char> kept, double bound,
                     const std::function<bool()>& proceed, std::span<const double> factors = {})
{
    laid_part own = laid_part::of(m, laid, kept, factors);
    const rest_surface& rest = own.rest;
    flat_surface& flat = own.flat;
    constexpr idx most = 16'000; // triangles of which the whole map may follow
    const bool whole = laid.whole && rest.triangles() <= most;
    const auto before = seam_price(rest, flat.seam);
    const sewing how{.bound = bound,
                     .patch = whole ? std::size_t{120} : std::size_t{300},
                     .keep_apart = true,
                     .whole = whole,
                     .proceed = proceed,
                     .told = {}};
    tip_sewing(rest, flat, how).run();
    if (!(seam_price(rest, flat.seam) < before)) return false;
    own.write(laid);
    return true;
}

} // namespace taut::impl
