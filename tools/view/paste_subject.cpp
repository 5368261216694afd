// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <taut/impl/files/surface/obj_output.hpp>
#include <taut/paste.hpp>
#include <taut/surface_file.hpp>

#include "paste/paste_check.hpp"
#include "view/floats.hpp"
#include "view/subjects.hpp"
#include "view/walk.hpp"

namespace taut::view
{

namespace
{

/// The text of a surface alone.
std::string obj_of(const std::vector<vec3>& points, const std::vector<mesh<triangle>::cell>& cells)
{
    std::string text;
    for (const vec3& p : points) io::impl::append_line(text, "v", {p.x, p.y, p.z});
    for (const auto& c : cells)
    {
        text += 'f';
        for (const idx v : c)
        {
            text += ' ';
            io::impl::append_number(text, v + 1);
        }
        text += '\n';
    }
    return text;
}

/// A feature that is moved over a surface. What has been kept is the next target.
class paste_subject final : public subject
{
public:
    paste_subject(queue& q, const source& from)
        : queue_(q),
          name_(std::filesystem::path(from.path).filename().string()),
          feature_(feature(geodesic_disk(io::read_surface(from.feature.source), from.feature.at, from.feature.radius))),
          target_(std::make_shared<const mesh<triangle>>(io::read_surface(from.path, from.format))),
          triangles_(from.feature.triangles),
          pose_{.scale = from.feature.scale}
    {
        put(target_, from.feature.onto, pose_);
    }

    view::model model() const override
    {
        return {3,
                showing::paste,
                name_,
                as_floats(points(), target_->points().front()),
                as_list(cells()),
                paste_ ? static_cast<std::uint32_t>(paste_->first_feature()) : 0xffffffffu};
    }

    void pose(const ask::pose& to) override
    {
        const paste_pose pose{.turn = to.turn, .scale = to.scale, .softness = to.softness};
        pose.validate();
        if (to.onto < 0)
        {
            if (!paste_) throw error("the feature is not placed: click on the surface");
            if (is_near(pose))
            {
                paste_->pose(pose);
                pose_ = pose;
            }
            else
                put(target_, onto_, pose);
            return;
        }
        if (static_cast<std::size_t>(to.onto) >= points().size())
            throw error("vertex " + std::to_string(to.onto) + " is not there");
        const idx onto = paste_ ? paste_->origins()[static_cast<std::size_t>(to.onto)] : to.onto;
        if (onto >= 0 && onto != onto_) put(target_, onto, pose); // else under the feature itself
    }

    void move(const ask::move& to) override
    {
        const idx from = paste_ ? onto_ : nearest_to(kept_at_);
        const idx onto = walk(*target_, from, {to.by[0], to.by[1], to.by[2]});
        if (onto == from && paste_) throw error("the surface does not go on in this direction");
        put(target_, onto, pose_);
    }

    void keep() override
    {
        if (!paste_) throw error("the feature is not placed: click on the surface");
        tools::require_sound(*paste_);
        auto kept = std::make_shared<const mesh<triangle>>(paste_->surface());
        kept_at_ = target_->points()[static_cast<std::size_t>(onto_)];
        paste_.reset();
        target_ = std::move(kept);
        onto_ = -1;
        ++revision_;
    }

    int revision() const override { return revision_; }

    void rehearse() override {}
    bool advance(std::chrono::duration<double>, const std::function<bool()>&) override { return false; }

    void describe(state& s) const override
    {
        s.converged = true;
        s.turn = pose_.turn;
        s.scale = pose_.scale;
        s.softness = pose_.softness;
        const vec3& origin = target_->points().front();
        for (int k = 0; k < 3; ++k) s.origin[k] = origin[k];
        s.positions = as_floats(points(), origin);
    }

    std::shared_ptr<const memory> remember() const override
    {
        const bool other = remembered_.lock() != target_;
        remembered_ = target_;
        return std::make_shared<moment>(target_, paste_ ? onto_ : -1, pose_, attached_, other);
    }

    void go_back(const memory& before) override
    {
        const auto& m = static_cast<const moment&>(before);
        const auto same = [](const paste_pose& a, const paste_pose& b)
        { return a.turn == b.turn && a.scale == b.scale && a.softness == b.softness; };
        if (m.target != target_ || !paste_ || m.onto != onto_ || !same(m.attached, attached_))
            put(m.target, m.onto, m.attached);
        if (paste_ && !same(m.pose, pose_)) paste_->pose(m.pose);
        pose_ = m.pose;
    }

    saved write() const override
    {
        saved file{std::filesystem::path(name_).stem().string() + "-pasted.obj", obj_of(points(), cells()), {}};
        if (paste_) file.notes = tools::notes_of(tools::require_sound(*paste_), paste_->self_intersections());
        return file;
    }

    void pin(std::span<const place>) override { throw error(no_pins); }
    void release(std::span<const std::int32_t>) override { throw error(no_pins); }
    void focus(std::span<const std::int32_t>) override { throw error(no_pins); }
    void align(int, std::span<const std::int32_t>) override { throw error(no_pins); }
    void start_afresh() override {}

private:
    struct moment : memory
    {
        moment(std::shared_ptr<const mesh<triangle>> t, idx o, const paste_pose& p, const paste_pose& a, bool other)
            : target(std::move(t)), onto(o), pose(p), attached(a), other_target(other)
        {
        }
        std::size_t bytes() const override
        {
            if (!other_target) return 0;
            return target->points().size() * sizeof(vec3) + target->cells().size() * sizeof(mesh<triangle>::cell);
        }
        std::shared_ptr<const mesh<triangle>> target;
        idx onto; ///< -1: the feature is nowhere
        paste_pose pose, attached;
        bool other_target; ///< than that of the moment before
    };

    static constexpr const char* no_pins = "a feature is being pasted; there are no pins";

    const std::vector<mesh<triangle>::cell>& cells() const { return paste_ ? paste_->cells() : target_->cells(); }
    const std::vector<vec3>& points() const { return paste_ ? paste_->points() : target_->points(); }

    /// Returns whether the rim may stay attached to what it is attached to.
    bool is_near(const paste_pose& pose) const
    {
        constexpr double turn = 0.25, scale = 0.2;
        return std::abs(pose.turn - attached_.turn) < turn && std::abs(std::log(pose.scale / attached_.scale)) < scale;
    }

    idx nearest_to(const vec3& place) const
    {
        const auto& x = target_->points();
        const auto nearer = [&](const vec3& a, const vec3& b) { return distance(a, place) < distance(b, place); };
        return static_cast<idx>(std::min_element(x.begin(), x.end(), nearer) - x.begin());
    }

    /// Remeshes the feature from its map, which the device samples.
    void refill(paste& there) const
    {
        const auto uv = there.parameterize_feature(queue_);
        if (!uv) throw error("the feature has no map with its rim where it meets the target: " + uv.reason());
        const auto map = there.part().rasterize(queue_, uv.uv);
        there.refill(there.part().tessellate(queue_, map, uv.uv, triangles_));
    }

    /// onto: a vertex of the target, or -1.
    void put(std::shared_ptr<const mesh<triangle>> target, idx onto, const paste_pose& pose)
    {
        std::optional<paste> there;
        if (onto >= 0) there.emplace(queue_, *target, feature_, onto, paste_params{.pose = pose});
        if (there && triangles_ > 0) refill(*there);
        paste_ = std::move(there);
        target_ = std::move(target);
        onto_ = onto;
        pose_ = attached_ = pose;
        ++revision_;
    }

    queue& queue_;
    std::string name_;
    feature feature_;
    std::shared_ptr<const mesh<triangle>> target_;
    std::optional<paste> paste_;
    idx onto_ = -1;
    vec3 kept_at_{0.0};                                      ///< where the feature was before it was kept
    idx triangles_ = 0;                                      ///< of the feature's tessellation; 0: it stays as it is
    paste_pose pose_, attached_;                             ///< now, and when the rim was attached
    mutable std::weak_ptr<const mesh<triangle>> remembered_; ///< the target of the last moment
    int revision_ = 0;
};

} // namespace

std::unique_ptr<subject> make_paste_subject(queue& q, const source& from)
{
    return std::make_unique<paste_subject>(q, from);
}

} // namespace taut::view
