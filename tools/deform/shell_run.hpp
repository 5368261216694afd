// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include <taut/constraints.hpp>
#include <taut/session.hpp>
#include <taut/surface_file.hpp>

#include "shared/command_run.hpp"
#include "shared/exit_codes.hpp"
#include "volume/shape_options.hpp"

namespace taut::tools
{

/// One run of `taut deform` on a surface in space.
class shell_run
{
public:
    /// All is referred to. Throws usage_error for options of volumes.
    shell_run(const shape_options& options, command_run& run);

    exit_code operator()();

private:
    /// Lengths of edges by those at rest.
    struct edge_changes
    {
        double mean_square = 0, largest = 0; ///< root of the mean square of what is above or below 1; and its extreme
    };

    shell_params params(const thin_shell& shell, const constraints<hinge>& pins);
    run_limits limits();
    void take(const session_result<hinge>& found, const mesh<triangle>& surface, const constraints<hinge>& pins);
    [[noreturn]] void refuse() const;
    /// Reads the mesh of --rest. Throws unsuitable_input for another mesh.
    mesh<triangle> shape_at_rest(const mesh<triangle>& surface) const;
    void write(const io::surface_file& file, const mesh<triangle>& rest);
    std::string picture(const mesh<triangle>& rest) const;
    edge_changes changes(const mesh<triangle>& surface) const;
    nlohmann::ordered_json json() const;
    std::string text() const;

    /// As command_run::write() asks for them.
    friend nlohmann::ordered_json to_json(const shell_run& run, const shape_options&) { return run.json(); }
    friend std::string text_of(const shell_run& run, const shape_options&) { return run.text(); }

    const shape_options& options_;
    command_run& command_;
    std::vector<vec3> points_; ///< of the result; empty if there is none
    session_report run_;
    edge_changes edges_;
    std::size_t vertices_ = 0, triangles_ = 0, pins_ = 0, springs_ = 0;
    double thickness_ = 0, read_ = 0, solve_ = 0, total_ = 0;
    std::string device_;
    exit_code code_ = exit_code::valid;
};

} // namespace taut::tools
