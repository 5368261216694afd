// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include <taut/constraints.hpp>
#include <taut/rigid_motion.hpp>
#include <taut/volume_file.hpp>

#include "volume/written_shape.hpp"

namespace taut::tools
{

/// Targets of the vertices of groups, by vertex: each group by itself, and an error where two disagree by more than
/// rounding.
class group_targets
{
public:
    /// The file is referred to.
    explicit group_targets(const io::volume_file& file);

    /// Leaves a group where it is. Throws group_error, unsuitable_input.
    void fix(const std::string& name);

    /// GROUP=FILE.csv, GROUP:translate:x,y,z, GROUP:rotate:ax,ay,az,degrees or GROUP:scale:factor; about the middle of
    /// the group. Throws usage_error too.
    void move(const std::string& text);

    const std::map<idx, vec3>& all() const { return targets_; }

    /// Pins them all, at the places that the file can hold.
    template <class Element>
    void pin(constraints<Element>& pins, held_by_file& held) const
    {
        constexpr int D = Element::dimension;
        for (const auto& [v, x] : targets_) pins.pin(v, held(v, vec<D>(x)));
        for (const auto& [vertices, motion] : rotations_)
        {
            std::vector<vec<D>> from;
            for (const idx v : vertices) from.emplace_back(point(v));
            rigid_motion<D> by{.from = vec<D>(motion.from), .to = vec<D>(motion.to), .angle = motion.angle};
            if constexpr (D == 3)
                by.axis = motion.axis;
            else if (motion.axis.z < 0)
                by.angle = -by.angle;
            pins.rotate(vertices, from, by);
        }
    }

    /// On vertices that two groups have at places that differ by rounding alone; empty: there are none.
    std::string note() const;

private:
    const io::volume_group& group(const std::string& name) const { return file_.find_group(name); }
    const vec3& point(idx v) const { return file_.points[static_cast<std::size_t>(v)]; }
    void transform(const std::string& name, std::size_t kind, const std::vector<double>& numbers);
    void take(idx v, const vec3& x, const std::string& name);

    const io::volume_file& file_;
    std::map<idx, vec3> targets_;
    std::map<idx, std::string> owner_;
    std::vector<std::pair<std::vector<idx>, rigid_motion<3>>> rotations_;
    double rounding_ = 0; ///< distance of places that are the same
    std::vector<idx> settled_;
};

/// The motion of a group about its middle, by the numbers of :translate: (3) or :rotate: (4). Throws usage_error that
/// names the group where an axis has no length.
rigid_motion<3> motion_of(const std::string& group, const vec3& middle, const std::vector<double>& numbers);

/// Throws usage_error for rotations of more than 180 degrees, where a command sees their ends alone.
void require_half_turns(const std::vector<std::string>& moves);

/// The file of GROUP=FILE.csv; nothing for other moves.
std::string file_of_move(const std::string& text);

/// Numbers between commas; throws usage_error that begins with `option` unless there are `count`.
std::vector<double> numbers_of(const std::string& text, std::size_t count, const std::string& option);

} // namespace taut::tools
