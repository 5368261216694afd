// SPDX-License-Identifier: MIT
#include "shared/other_way.hpp"

#include <taut/gltf.hpp>

namespace taut::tools
{

std::string other_way(mesh_error::fault_type fault, std::string_view name)
{
    const bool view = name == "view";
    if (name != "unwrap" && !view) return {};
    switch (fault)
    {
    case mesh_error::several_boundaries:
        return view ? "or take it as it is with --holes" : "or take it as it is with --holes, or let --cut join them";
    case mesh_error::closed_surface:
    case mesh_error::handles:
        return view ? "or deform it in space with --shell" : "or let --cut do so, or `taut atlas` make charts of it";
    case mesh_error::several_components:
        return view ? "or let `taut atlas` make charts of it, which are looked at with its --report"
                    : "or let `taut atlas` make charts of it";
    case mesh_error::empty:
    case mesh_error::too_large:
        return {};
    default:
        return view ? std::string() : "`taut atlas --repair` repairs the surface";
    }
}

std::string other_way(const io::io_error& error, std::string_view name)
{
    if (name == "atlas" || name == "bake" || !io::is_gltf(error.path())) return {};
    return "models of glTF are for `taut atlas`, which writes .glb and .gltf; convert it for other commands";
}

} // namespace taut::tools
