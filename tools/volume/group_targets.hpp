// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <map>
#include <string>
#include <vector>

#include <taut/impl/io/volume_file.hpp>
#include <taut/impl/measure/rigid_motion.hpp>

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

    /// On vertices that two groups have at places that differ by rounding alone; empty: there are none.
    std::string note() const;

private:
    const io::impl::volume_group& group(const std::string& name) const { return file_.find_group(name); }
    const vec3& point(idx v) const { return file_.points[static_cast<std::size_t>(v)]; }
    void transform(const std::string& name, std::size_t kind, const std::vector<double>& numbers);
    void take(idx v, const vec3& x, const std::string& name);

    const io::volume_file& file_;
    std::map<idx, vec3> targets_;
    std::map<idx, std::string> owner_;
    double rounding_ = 0; ///< distance of places that are the same
    std::vector<idx> settled_;
};

/// The motion of a group about its middle, by the numbers of :translate: (3) or :rotate: (4). Throws usage_error that
/// names the group where an axis has no length.
rigid_motion<3> motion_of(const std::string& group, const vec3& middle, const std::vector<double>& numbers);

/// The file of GROUP=FILE.csv; nothing for other moves.
std::string file_of_move(const std::string& text);

/// Numbers between commas; throws usage_error that begins with `option` unless there are `count`.
std::vector<double> numbers_of(const std::string& text, std::size_t count, const std::string& option);

} // namespace taut::tools
