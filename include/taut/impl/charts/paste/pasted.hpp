// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <chrono>
#include <cstddef>
#include <limits>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include <taut/impl/charts/paste/attach/bending.hpp>
#include <taut/impl/charts/paste/attach/choose_place.hpp>
#include <taut/impl/charts/paste/attach/laid_feature.hpp>
#include <taut/impl/charts/paste/geodesic_distances.hpp>
#include <taut/impl/charts/paste/paste_report.hpp>
#include <taut/impl/charts/paste/rbf_error.hpp>
#include <taut/impl/charts/paste/self_intersections.hpp>
#include <taut/paste.hpp>

namespace taut::impl
{

/// Implementation of taut::paste.
class pasted
{
public:
    using cell = mesh<triangle>::cell;

    /// Throws region_error where the surroundings of vertex `onto` are no disk, paste_error where the rim does not fit
    /// there, parameter_error, mesh_error, device_error.
    pasted(queue& q, mesh<triangle> target, feature part, idx onto, const paste_params& params,
           const run_limits& limits)
        : queue_(q),
          target_(std::move(target)),
          part_(std::move(part)),
          params_(valid(params)),
          limits_(limits),
          first_turn_(params.pose.turn),
          site_(choose_site(q, target_, part_, onto, params_, report_))
    {
        limits_.validate();
        report_.way = site_.rim.way;
        stitch();
        timed(report_.seconds.factor, [&] { interpolated([&] { factor(); }); });
        pose(params_.pose);
    }

    /// Puts the feature elsewhere. What it is attached to stays: for a way across the surface that is longer than some
    /// edges, and for a turn of more than some twenty degrees, paste anew. The first soft one maps the feature. Throws
    /// paste_error where that fails.
    void pose(const paste_pose& to)
    {
        to.validate();
        timed(report_.seconds.transform, [&] { interpolated([&] { bend(to); }); });
        params_.pose = to;
    }
    /// Puts another surface within the same rim, say a tessellation of the feature's map. Throws parameter_error for
    /// another rim.
    void refill(feature part)
    {
        const auto rim_points = [](const feature& f)
        {
            std::vector<vec3> points;
            for (const idx v : f.region.rim) points.push_back(f.region.surface.points()[at(v)]);
            return points;
        };
        if (rim_points(part) != rim_points(part_))
            throw parameter_error("part", "has another rim than the feature; paste it as one of its own");
        part_ = std::move(part);
        stitch();
        timed(report_.seconds.factor, [&] { interpolated([&] { factor(); }); });
        pose(params_.pose);
    }

    const paste_pose& pose() const { return params_.pose; }

    const std::vector<vec3>& points() const { return points_; } ///< of the result; pose() changes them
    const std::vector<cell>& cells() const { return cells_; }   ///< of the result; they stay
    mesh<triangle> surface() const { return {points_, cells_}; }

    const mesh<triangle>& target() const { return target_; } ///< as it was

    /// The vertex of the target that vertex v of the result was, or -1: it is one of the feature.
    const std::vector<idx>& origins() const { return origins_; }
    const std::vector<idx>& kept_faces() const
    {
        return kept_faces_;
    } ///< of the target: triangle f was kept_faces()[f]
    const feature& part() const { return part_; }
    const std::vector<vec2>& rim_uv() const { return site_.rim.uv; } ///< of its rim, in the map of the target
    idx first_gap() const { return first_gap_; }         ///< triangle of the gap; those before are of the target
    idx first_feature() const { return first_feature_; } ///< triangle of the feature; the rest is, too

    /// Similarity transform of the pose, without softness.
    similarity_transform transform() const { return transform_of(params_.pose); }

    const paste_report& report() const { return report_; }

    /// Pairs of triangles of the result that meet elsewhere than in what they share, but for those that did so in the
    /// target or in the feature; exact (see taut::self_intersections).
    std::vector<std::array<idx, 2>> self_intersections() const
    {
        auto pairs = taut::impl::self_intersections(surface());
        std::erase_if(pairs,
                      [&](const std::array<idx, 2>& pair)
                      {
                          const auto met = [&](const mesh<triangle>& m, idx f, idx g)
                          { return triangles_meet(m.points(), m.cells()[at(f)], m.cells()[at(g)]); };
                          if (pair[1] < first_gap_)
                              return met(target_, kept_faces_[at(pair[0])], kept_faces_[at(pair[1])]);
                          return pair[0] >= first_feature_ &&
                                 met(part_.region.surface, pair[0] - first_feature_, pair[1] - first_feature_);
                      });
        return pairs;
    }

    /// Edges of gap and feature where triangles of the result turn back by more than 150 degrees, and not by nearly as
    /// much in the feature: the two triangles of each.
    std::vector<std::array<idx, 2>> folds() const
    {
        constexpr double nearly = 30; // degrees that bending may add to a crease
        auto pairs = folded_edges(surface(), first_gap_, fold_angle);
        std::erase_if(pairs,
                      [&](const std::array<idx, 2>& pair)
                      {
                          return pair[0] >= first_feature_ &&
                                 turned_back(part_.region.surface, pair[0] - first_feature_, pair[1] - first_feature_) >
                                     fold_angle - nearly;
                      });
        return pairs;
    }

    /// Removes folds() of the pose: takes the nearest softness without, of those below it in quarters, then of those
    /// above. Returns false, and keeps the pose, if each has folds.
    bool unfold()
    {
        const paste_pose wanted = params_.pose;
        const double soft = wanted.softness;
        std::vector<double> tries{soft};
        for (const double part : {0.75, 0.5, 0.25, 0.0})
            if (soft > 0) tries.push_back(part * soft);
        for (const double part : {0.25, 0.5, 0.75, 1.0})
            if (soft < 1) tries.push_back(soft + part * (1 - soft));
        for (const double softness : tries)
        {
            paste_pose to = wanted;
            to.softness = softness;
            try
            {
                if (softness != params_.pose.softness) pose(to);
            }
            catch (const paste_error&) // it cannot be soft at all
            {
                return false;
            }
            if (folds().empty()) return true;
        }
        pose(wanted);
        return false;
    }

private:
    static const paste_params& valid(const paste_params& params)
    {
        params.validate();
        return params;
    }

    /// Throws paste_error where points are too near to each other to interpolate between them.
    template <class Work>
    static void interpolated(const Work& work)
    {
        try
        {
            work();
        }
        catch (const rbf_error&)
        {
            throw paste_error("points of the feature's rim are at one place on the target, as coordinates there are "
                              "too coarse for it; choose a larger scale");
        }
    }

    template <class Work>
    static void timed(double& seconds, const Work& work)
    {
        const auto start = std::chrono::steady_clock::now();
        work();
        seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    }

    static std::size_t at(idx i) { return static_cast<std::size_t>(i); }

    similarity_transform transform_of(const paste_pose& to) const
    {
        similarity_transform t = site_.rim.transform;
        t.rotation = rotation_about(site_.place.normal, to.turn - first_turn_) * t.rotation;
        t.scale = to.scale;
        t.to += to.shift;
        return t;
    }

    /// Cells and numbering of the result.
    void stitch()
    {
        const auto& region = site_.place.region;
        const auto& s = site_.room;
        points_.clear();
        cells_.clear();
        origins_.clear();
        kept_faces_.clear();
        bent_.clear();
        report_.removed_triangles = 0;
        std::vector<char> gone_face(target_.cells().size(), 0), gone(target_.points().size(), 0);
        for (std::size_t f = 0; f < s.removed.size(); ++f)
            if (s.removed[f])
            {
                gone_face[at(region.faces[f])] = 1;
                for (const idx v : region.surface.cells()[f]) gone[at(region.vertices[at(v)])] = 1;
                ++report_.removed_triangles;
            }
        for (std::size_t f = 0; f < gone_face.size(); ++f)
            if (!gone_face[f])
                for (const idx v : target_.cells()[f]) gone[at(v)] = 0;
        std::vector<idx> number(gone.size(), -1);
        for (std::size_t v = 0; v < gone.size(); ++v)
            if (!gone[v])
            {
                number[v] = static_cast<idx>(origins_.size());
                origins_.push_back(static_cast<idx>(v));
                points_.push_back(target_.points()[v]);
            }
        feature_begin_ = origins_.size();
        origins_.resize(feature_begin_ + part_.region.surface.points().size(), -1);
        points_.resize(origins_.size());
        const auto of_feature = [&](idx v) { return static_cast<idx>(feature_begin_) + v; };

        for (std::size_t f = 0; f < gone_face.size(); ++f)
        {
            if (gone_face[f]) continue;
            kept_faces_.push_back(static_cast<idx>(f));
            cell c = target_.cells()[f];
            for (idx& v : c) v = number[at(v)];
            cells_.push_back(c);
        }
        first_gap_ = static_cast<idx>(cells_.size());
        const idx own = region.surface.vertex_count();
        for (cell c : s.filling)
        {
            for (idx& v : c)
                v = v < own ? number[at(region.vertices[at(v)])] : of_feature(part_.region.rim[at(v - own)]);
            cells_.push_back(c);
        }
        first_feature_ = static_cast<idx>(cells_.size());
        for (cell c : part_.region.surface.cells())
        {
            for (idx& v : c) v = of_feature(v);
            cells_.push_back(c);
        }
        report_.gap_triangles = first_feature_ - first_gap_;
        report_.feature_triangles = part_.region.surface.cell_count();

        // What bends: the rest of the place, but for its rim.
        std::vector<char> on_rim(region.surface.points().size(), 0);
        for (const idx v : region.rim) on_rim[at(v)] = 1;
        for (std::size_t v = 0; v < on_rim.size(); ++v)
            if (!on_rim[v] && number[at(region.vertices[v])] >= 0) bent_.push_back(number[at(region.vertices[v])]);
        report_.bent_vertices = static_cast<idx>(bent_.size());
    }

    void factor()
    {
        const auto pick = [](const std::vector<idx>& ids, const std::vector<vec3>& x)
        {
            std::vector<vec3> picked;
            for (const idx v : ids) picked.push_back(x[at(v)]);
            return picked;
        };
        std::vector<idx> rim(site_.rim.uv.size());
        for (std::size_t i = 0; i < rim.size(); ++i) rim[i] = static_cast<idx>(i);
        moving_ = some_of(rim, params_.tuning.controls);

        // The target bends between the rim of the feature and a band along the rim of the place.
        const auto& region = site_.place.region;
        const auto staying = some_of(band(rim_distances(region), 0.0, 0.12), params_.tuning.controls);
        base_ = {queue_, pick(moving_, site_.rim.on_target), pick(staying, region.surface.points()),
                 pick(bent_, points_), params_.tuning.basis};
        report_.controls = base_.solver().size();
        report_.reciprocal_condition = base_.solver().reciprocal_condition();

        // The feature bends between its rim and what is far from it.
        const auto& own = part_.region;
        from_rim_ = rim_distances(own);
        const auto far = some_of(band(from_rim_, soft_band, 1.0), params_.tuning.controls);
        std::vector<vec3> on_rim;
        for (const idx i : moving_) on_rim.push_back(own.surface.points()[at(own.rim[at(i)])]);
        soft_ = {queue_, on_rim, pick(far, own.surface.points()), own.surface.points(), params_.tuning.basis};
        laid_.reset();
    }

    static constexpr double soft_band = 0.5; ///< how far from its rim a feature bends, by the largest distance

    static std::vector<double> rim_distances(const surface_region& region)
    {
        return geodesic_distances(region.surface, vertex_cells(region.surface), region.rim);
    }

    /// Vertices whose distance from the rim is from low to high times the largest one.
    static std::vector<idx> band(std::span<const double> d, double low, double high)
    {
        const double far = *std::max_element(d.begin(), d.end());
        std::vector<idx> ids;
        for (std::size_t v = 0; v < d.size(); ++v)
            if (d[v] >= low * far && d[v] <= high * far) ids.push_back(static_cast<idx>(v));
        return ids;
    }

    /// Means of neighbours along a closed loop, again and again.
    static std::vector<vec3> smooth_along(std::vector<vec3> values)
    {
        const std::size_t n = values.size();
        for (int round = 0; round < 8; ++round)
        {
            const auto before = values;
            for (std::size_t i = 0; i < n; ++i)
                values[i] = 0.5 * before[i] + 0.25 * (before[(i + n - 1) % n] + before[(i + 1) % n]);
        }
        return values;
    }

    /// The feature laid on the target, and the width of the band that follows it: of a few, that which folds least.
    void lay(const paste_pose& to)
    {
        const double far = *std::max_element(from_rim_.begin(), from_rim_.end());
        auto laid = lay_feature(queue_, part_.region, from_rim_, 0.4 * far, site_.place, site_.rim.uv, limits_);
        bend_laid_ = {queue_, base_.field(std::vector<vec3>(moving_.size(), vec3(0.0))), laid.on_target};
        laid_ = std::move(laid);
        paste_pose soft = to;
        soft.softness = 1;
        idx fewest = std::numeric_limits<idx>::max();
        double best = 0;
        for (const double width : {0.25, 0.15, 0.4, 0.08})
        {
            laid_width_ = width * far;
            bend(soft);
            const std::vector<vec3> points(points_.begin() + static_cast<std::ptrdiff_t>(feature_begin_),
                                           points_.end());
            const auto seam = measure_seam({points, part_.region.surface.cells()}, 0, 0);
            if (seam.folded >= fewest) continue;
            fewest = seam.folded;
            best = laid_width_;
            if (fewest == 0) break;
        }
        laid_width_ = best;
    }

    void bend(const paste_pose& to)
    {
        if (to.softness > 0 && !laid_) lay(to);
        const auto transform = transform_of(to);
        const auto& own = part_.region;
        // Where both sides meet.
        std::vector<vec3> meeting;
        for (std::size_t i = 0; i < own.rim.size(); ++i)
        {
            const vec3 rigid = transform(own.surface.points()[at(own.rim[i])]);
            meeting.push_back(rigid + to.softness * (site_.rim.on_target[i] - rigid));
        }
        std::vector<vec3> by_target, by_feature;
        for (std::size_t i = 0; i < meeting.size(); ++i)
        {
            by_target.push_back(meeting[i] - site_.rim.on_target[i]);
            by_feature.push_back(meeting[i] - transform(own.surface.points()[at(own.rim[i])]));
        }
        // What is jagged in the rim is the matter of the gap and of the first triangles, not of all around.
        by_target = smooth_along(std::move(by_target));
        by_feature = smooth_along(std::move(by_feature));
        std::vector<vec3> base_moves, soft_moves;
        for (const idx i : moving_)
        {
            base_moves.push_back(by_target[at(i)]);
            soft_moves.push_back(by_feature[at(i)]);
        }
        const auto field = base_.field(base_moves);
        const auto by = base_(field);
        for (std::size_t i = 0; i < bent_.size(); ++i)
            points_[at(bent_[i])] = target_.points()[at(origins_[at(bent_[i])])] + by[i];
        for (std::size_t v = 0; v < own.surface.points().size(); ++v)
            points_[feature_begin_ + v] = transform(own.surface.points()[v]);
        if (to.softness > 0)
        {
            const auto soft_by = soft_(soft_.field(soft_moves));
            for (std::size_t v = 0; v < soft_by.size(); ++v) points_[feature_begin_ + v] += soft_by[v];
            follow_target(to.softness, field);
        }
        for (std::size_t i = 0; i < own.rim.size(); ++i) points_[feature_begin_ + at(own.rim[i])] = meeting[i];
    }

    /// Near its rim the feature follows the bent target, so that both sides have one tangent plane at softness 1.
    void follow_target(double softness, const rbf_field& of_target)
    {
        const auto by = bend_laid_(of_target);
        for (std::size_t i = 0; i < by.size(); ++i)
        {
            vec3& p = points_[feature_begin_ + at(laid_->vertices[i])];
            p += softness * laid_->share(i, laid_width_) * (laid_->on_target[i] + by[i] - p);
        }
    }

    queue queue_;
    mesh<triangle> target_;
    feature part_;
    paste_params params_;
    run_limits limits_;
    double first_turn_; ///< of the pose that the landing is for
    paste_report report_;
    site site_;
    bending base_, soft_;
    std::vector<double> from_rim_;     ///< of vertices of the feature
    std::optional<laid_feature> laid_; ///< from the first soft pose on
    double laid_width_ = 0;            ///< of the band that follows it
    rbf_evaluator bend_laid_;          ///< of the field of the target, there
    std::vector<idx> moving_;          ///< controls, of the rim
    std::vector<idx> bent_;            ///< vertices of the result
    std::vector<vec3> points_;
    std::vector<cell> cells_;
    std::vector<idx> origins_, kept_faces_;
    std::size_t feature_begin_ = 0;
    idx first_gap_ = 0, first_feature_ = 0;
};

} // namespace taut::impl
