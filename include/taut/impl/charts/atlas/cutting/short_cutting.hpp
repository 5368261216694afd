// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <cstddef>
#include <memory>
#include <numeric>
#include <optional>
#include <span>
#include <thread>
#include <utility>
#include <vector>

#include <taut/impl/charts/atlas/cutting/coarse_surface.hpp>
#include <taut/impl/charts/atlas/cutting/lift_seams.hpp>
#include <taut/impl/charts/atlas/cutting/patch_energy.hpp>
#include <taut/impl/charts/atlas/cutting/seam_search.hpp>
#include <taut/impl/charts/atlas/cutting/way_prices.hpp>
#include <taut/impl/charts/atlas/surface_part.hpp>
#include <taut/impl/core/core/budget.hpp>
#include <taut/impl/core/core/parallel.hpp>

namespace taut::impl
{

/// What short_cutting is to keep.
struct cutting_params
{
    double bound = 4.1;                   ///< of the mean isometric energy of the whole surface
    std::span<const char> seams = {};     ///< sides that are seams in any case, or empty
    std::span<const char> together = {};  ///< sides that are to be none, or empty
    std::span<const double> factors = {}; ///< what a unit of length of a seam counts along each side, or empty: 1
    bool part = true;                     ///< charts that lie on themselves are parted
    idx coarse = 5000;                    ///< triangles of the surfaces that are searched, about
};

/// Short seams of a surface of any number of components: a search on a coarse surface for each, led back over the
/// surface itself.
class short_cutting
{
public:
    short_cutting(const mesh<triangle>& m, const facet_table& f, const cutting_params& params, budget& limits)
        : mesh_(m),
          facets_(f),
          params_(params),
          limits_(limits),
          pieces_{cut_charts(m, f, flags(params.seams, f.twin.size())), {}},
          searches_(u(pieces_.charts.charts()))
    {
        pieces_.triangles = pieces_.charts.cell_origins;
        together_ = pieces_.by_side(params.together);
        factors_ = pieces_.by_side(params.factors);
    }

    /// Looks for seams within the bound.
    void run()
    {
        std::vector<std::size_t> order(searches_.size());
        std::iota(order.begin(), order.end(), std::size_t(0));
        std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return cells(a) > cells(b); });
        for_each(order.size(), [&](std::size_t i) { prepare(order[i]); });
        struct task
        {
            std::size_t piece;
            search_setting setting;
            std::unique_ptr<seam_search> search;
            bool found = false;
            double price = 0;
        };
        std::vector<task> tasks;
        for (const std::size_t k : order)
            if (searches_[k] && searches_[k]->rest && !searches_[k]->search)
                for (const search_setting& s : settings(searches_[k]->rest->triangles(), searches_[k]->bound))
                    tasks.push_back({k, s, {}});
        for_each(tasks.size(),
                 [&](std::size_t i)
                 {
                     task& t = tasks[i];
                     t.search = std::make_unique<seam_search>(*searches_[t.piece]->rest, t.setting);
                     t.found = t.search->run();
                     if (t.found) t.price = t.search->price();
                 });
        for (task& t : tasks)
        {
            auto& best = searches_[t.piece]->search;
            if (t.found && (!best || t.price < searches_[t.piece]->price))
            {
                best = std::move(t.search);
                searches_[t.piece]->price = t.price;
            }
            t.search.reset();
        }
    }

    /// Sews up or opens seams for a bound that is larger by `more`.
    /// everywhere: charts that lie on themselves are parted, however long the cuts
    void adjust(double more, bool everywhere)
    {
        for_each(searches_.size(),
                 [&](std::size_t k)
                 {
                     if (!searches_[k] || !searches_[k]->search || searches_[k]->rough()) return;
                     piece_search& p = *searches_[k];
                     // Of few triangles a cut changes much, and may have left more than is needed.
                     if (more < 0) p.bound = std::min(p.bound, p.search->result().energy);
                     p.bound = std::max(p.bound + more, 4 + 0.8 * (p.bound - 4));
                     if (p.search->adjust(p.bound, everywhere && params_.part)) return;
                     auto anew = std::make_unique<seam_search>(*p.rest, p.search->setting());
                     if (anew->run()) p.search = std::move(anew);
                 });
    }

    /// That given seams leave.
    std::size_t pieces() const { return searches_.size(); }

    /// Whether most of the surface is so rough that the bound is given up.
    bool rough() const
    {
        double sum = 0;
        for (const auto& p : searches_)
            if (p && p->search && p->rough()) sum += p->rest->total;
        return sum > 0.5 * area();
    }

    /// The part of the area that lies on other parts of its chart.
    double overlap() const
    {
        double sum = 0;
        for (const auto& p : searches_)
            if (p && p->search) sum += p->search->overlap() * p->rest->total;
        return sum / area();
    }

    /// Of the whole surface.
    double area() const
    {
        double sum = 0;
        for (const auto& p : searches_)
            if (p) sum += p->area;
        return sum;
    }

    /// What a seam along each side of the surface counts.
    std::vector<double> prices() const { return side_prices(mesh_, facets_, {}, params_.factors); }

    /// One flag a triangle of the surface: 1 where no seams were found.
    std::vector<char> unfound() const
    {
        std::vector<char> result(mesh_.cells().size(), 0);
        for (std::size_t k = 0; k < searches_.size(); ++k)
            if (!searches_[k] || !searches_[k]->search)
                for (std::size_t i = 0; i < cells(k); ++i) result[origin(k, 3 * i) / 3] = 1;
        return result;
    }

    /// One flag a side of the surface: 1 where seams stay as they are, since they are given, or were found on the
    /// surface itself.
    std::vector<char> settled() const
    {
        std::vector<char> stay = flags(params_.seams, facets_.twin.size());
        for (std::size_t k = 0; k < searches_.size(); ++k)
            if (searches_[k] && searches_[k]->search && !searches_[k]->coarser)
                for (std::size_t s = 0; s < 3 * cells(k); ++s) stay[origin(k, s)] = 1;
        return stay;
    }

    /// The seams of the surface, one flag a side.
    std::vector<char> seams()
    {
        std::vector<char> seam = flags(params_.seams, facets_.twin.size());
        for_each(searches_.size(),
                 [&](std::size_t k)
                 {
                     if (!searches_[k] || !searches_[k]->search) return;
                     const auto own = lifted(k);
                     for (std::size_t s = 0; s < own.size(); ++s)
                         if (own[s]) seam[origin(k, s)] = 1;
                 });
        return seam;
    }

    /// Places of the corners of the surface in the maps of searches on the surface itself; 0 elsewhere.
    std::vector<vec2> places() const
    {
        std::vector<vec2> uv(facets_.twin.size(), vec2(0.0));
        for (std::size_t k = 0; k < searches_.size(); ++k)
            if (searches_[k] && searches_[k]->search && !searches_[k]->coarser)
                for (std::size_t s = 0; s < 3 * cells(k); ++s) uv[origin(k, s)] = searches_[k]->search->result().uv[s];
        return uv;
    }

private:
    static std::size_t u(idx i) { return static_cast<std::size_t>(i); }

    static std::vector<char> flags(std::span<const char> given, std::size_t n)
    {
        std::vector<char> all(given.begin(), given.end());
        all.resize(n, 0);
        return all;
    }

    struct piece_search
    {
        std::optional<mesh<triangle>> surface; // fine
        facet_table facets;
        std::vector<idx> origins;            // of coarse vertices
        bool coarser = false, noisy = false; // noisy: in small patches already, which coarser ones do not show
        std::optional<rest_surface> rest;
        std::unique_ptr<seam_search> search;
        double bound = 4, price = 0, area = 0;

        bool rough() const { return noisy || search->rough(); }
    };

    std::size_t first(std::size_t k) const { return u(pieces_.charts.first_cell[k]); }
    std::size_t cells(std::size_t k) const { return first(k + 1) - first(k); }

    /// The side of the surface that is side s of a piece.
    std::size_t origin(std::size_t k, std::size_t s) const { return pieces_.origin(3 * first(k) + s); }

    /// Values of the sides of a piece, or none, among those of all pieces.
    template <class T>
    std::span<const T> own(const std::vector<T>& all, std::size_t k) const
    {
        return all.empty() ? std::span<const T>() : std::span<const T>(all).subspan(3 * first(k), 3 * cells(k));
    }

    /// Calls work(i) for all i below n on several threads, as long as the run is to go on.
    template <class Work>
    void for_each(std::size_t n, const Work& work)
    {
        owner_ = std::this_thread::get_id();
        parallel_for(
            n,
            [&](std::size_t begin, std::size_t end)
            {
                for (std::size_t i = begin; i < end && proceed(); ++i) work(i);
            },
            0, 1);
    }

    /// The observer is asked by the thread that it was given to.
    bool proceed()
    {
        if (std::this_thread::get_id() == owner_ && !stopped_ && !limits_.proceed()) stopped_ = true;
        return !stopped_;
    }

    void prepare(std::size_t k)
    {
        searches_[k] = std::make_unique<piece_search>();
        piece_search& p = *searches_[k];
        p.surface = chart_alone(pieces_.charts, k);
        p.facets = facets(*p.surface);
        p.area = area_of(*p.surface, 0, p.surface->cell_count());
        if (least_loops(*p.surface, p.facets) > seam_search::most_loops * std::sqrt(p.area)) return;
        coarse_surface coarse =
            make_coarse(*p.surface, p.facets,
                        p.surface->cell_count() > params_.coarse * 7 / 5 ? params_.coarse : p.surface->cell_count(),
                        [this] { return proceed(); });
        if (stopped_) return;
        p.coarser = coarse.cells.size() < p.surface->cells().size();
        // Patches of so many triangles have borders that are longer than seams are searched for.
        constexpr idx patch = 100;
        p.noisy = p.coarser && patch_energy(*p.surface, p.facets, patch) > params_.bound;
        // Seams become shorter on the surface itself, and distortion more.
        p.bound = params_.bound - (p.coarser ? 0.02 : 0.001) * (params_.bound - 4);
        p.origins = std::move(coarse.origins);
        const idx first_span = span_small_holes(coarse);
        p.rest = rest_surface::of(mesh<triangle>(std::move(coarse.points), std::move(coarse.cells)), first_span);
        p.area = p.rest->total;
        if (!factors_.empty() || (!p.coarser && !together_.empty()))
        {
            const auto price = fine_prices(k);
            if (p.coarser)
                p.rest->price = way_prices(*p.surface, p.facets, starting_sides(*p.surface), price, *p.rest, p.origins);
            else
                std::copy(price.begin(), price.end(), p.rest->price.begin());
        }
        auto whole = std::make_unique<seam_search>(*p.rest, settings(p.rest->triangles(), p.bound).front());
        if (whole->run_whole()) p.search = std::move(whole);
    }

    std::vector<search_setting> settings(idx triangles, double bound)
    {
        search_setting one{.bound = bound, .over = 0.85, .part = params_.part, .proceed = [this] { return proceed(); }};
        search_setting two = one; // as different as it can be: greedy searches that are alike fail alike
        two.over = 0.95;
        two.least_weight = 0.8;
        constexpr idx few = 200; // triangles that all settings cut alike
        return triangles < few ? std::vector{one} : std::vector{one, two};
    }

    /// The seams of a piece on the surface itself, one flag a side of it.
    std::vector<char> lifted(std::size_t k) const
    {
        const piece_search& p = *searches_[k];
        const auto& seam = p.search->result().seam;
        if (!p.coarser) return {seam.begin(), seam.begin() + static_cast<std::ptrdiff_t>(p.facets.twin.size())};
        const auto price = fine_prices(k);
        return seam_lifting(*p.surface, p.facets, starting_sides(*p.surface), price).run(*p.rest, seam, p.origins);
    }

    /// What a seam along each side of a piece counts.
    std::vector<double> fine_prices(std::size_t k) const
    {
        return side_prices(*searches_[k]->surface, searches_[k]->facets, own(together_, k), own(factors_, k));
    }

    const mesh<triangle>& mesh_;
    const facet_table& facets_;
    cutting_params params_;
    budget& limits_;
    surface_part pieces_;        // that given seams leave
    std::vector<char> together_; // one per side of the pieces, or empty, like the next
    std::vector<double> factors_;
    std::vector<std::unique_ptr<piece_search>> searches_; // one a piece
    std::thread::id owner_;
    std::atomic<bool> stopped_{false};
};

} // namespace taut::impl
