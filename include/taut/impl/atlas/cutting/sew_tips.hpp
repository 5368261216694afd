// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstddef>
#include <functional>
#include <limits>
#include <span>
#include <utility>
#include <vector>

#include <taut/impl/atlas/cutting/flat_surface.hpp>
#include <taut/impl/atlas/cutting/zip.hpp>

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
            relax(rest_, flat_, 2, 1e-5);
            if (flat_.energy > how_.bound) relax(rest_, flat_, 8, 1e-5);
            if (flat_.energy > how_.bound)
            {
                flat_ = good;
                tips_ = good_tips;
                for (price& p : prices_) p.known = false;
                if (batch == 1)
                    for (const idx t : taken) prices_[u(t)].barred = true;
                batch = 1;
            }
            else
            {
                good = flat_;
                good_tips = tips_;
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
            if (flat_.energy + prices_[u(tip)].more / rest_.total > how_.bound)
                prices_[u(tip)].barred = true; // a short edge, or one that is cheap for its length, may come after
            else
                sew(tip);
        }
    }

    static constexpr std::size_t most_crossings = 1000;
    static constexpr double infinite = std::numeric_limits<double>::infinity();
    static std::size_t u(idx i) { return static_cast<std::size_t>(i); }

    struct price
    {
        double rate = infinite;     // energy by price of the seam
        double more = infinite;     // energy
        std::vector<idx> triangles; // that it depends on
        idx when = 0;
        bool known = false, barred = false;
    };

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
            const auto is_stale = [&](idx c) { return changed_[u(c)] > p.when; };
            if (!p.known || std::any_of(p.triangles.begin(), p.triangles.end(), is_stale)) find_price(t);
            const bool hopeless = likely && flat_.energy + (1 - given_back) * p.more / rest_.total > how_.bound;
            if (p.rate < least && !hopeless) // the first of equal ones
            {
                least = p.rate;
                best = t;
            }
        }
        return best;
    }

    void find_price(idx tip)
    {
        price& p = prices_[u(tip)];
        zip z = zipper_.look(flat_, tip);
        p.known = true;
        p.when = now_;
        p.more = z.more;
        p.rate = z.side < 0 ? infinite : z.more / rest_.price[u(z.side)];
        p.triangles = std::move(z.triangles);
    }

    /// Whether it was done.
    bool sew(idx tip)
    {
        const zip z = zipper_.look(flat_, tip);
        price& p = prices_[u(tip)];
        if (!(z.more < infinite))
        {
            p.rate = infinite;
            return false;
        }
        if (how_.keep_apart)
        {
            const auto was = zipper_.remember(flat_, z);
            zipper_.apply(flat_, z);
            if (const std::size_t then = border_crossings(rest_, flat_, most_crossings); then > crossings_)
            {
                zipper_.take_back(flat_, z, was);
                p.rate = infinite;
                return false;
            }
            else
                crossings_ = then;
        }
        else
            zipper_.apply(flat_, z);
        ++now_;
        for (const idx c : z.triangles) changed_[u(c)] = now_;
        const idx next = rest_.end(z.side);
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
