// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "volume/volume_case.hpp"

namespace taut::tools
{

/// One state of a mesh, and what its cells are coloured by.
struct drawn_state
{
    std::string title;
    std::vector<vec3> points; ///< one per point of the file
    std::vector<double> distortion;
    std::vector<idx> inverted; ///< cells
};

/// Options of pictures of a mesh.
struct drawing_options
{
    std::string path;      ///< whose extension says what it is
    std::string clip;      ///< as parse_clip() takes it
    bool by_shape = false; ///< distortion is 1 / mean ratio
};

/// Throws usage_error for options that do not fit the mesh: SVG or a cut plane.
void require_drawable(const io::volume_file& file, const drawing_options& options);

/// The bytes of a picture: states side by side, the skin of volumes or layouts of planar meshes, coloured by
/// distortion. The same cells are cut away in all of them, by where their centres are at rest; without a shape at rest,
/// in the last state if it is drawn by shape, else in the first.
std::string draw_states(const io::volume_file& file, const std::vector<drawn_state>& states,
                        const drawing_options& options);

/// A state as the file will have it. by_shape: towards regular elements, not to the shape at rest.
template <class Element>
drawn_state state_to_draw(const volume_case<Element>& input, std::string title,
                          const std::vector<vec<Element::dimension>>& x, bool by_shape)
{
    return {std::move(title), input.in_file(x), by_shape ? input.shape_distortion(x) : input.distortion(x),
            input.look(x).inverted};
}

} // namespace taut::tools
