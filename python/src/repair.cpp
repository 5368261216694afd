// SPDX-License-Identifier: MIT
// Surfaces made of triangles as files have them.
#include <taut/repair.hpp>

#include "bindings.hpp"
#include "reports.hpp"

namespace taut::python
{

namespace
{

nb::dict repair(const array& V, const array& F, const nb::dict& keywords)
{
    const options given(keywords);
    const auto points = places_of(V, "V");
    const auto triangles = cells_of<3>(F, "F");
    repair_params params;
    std::vector<idx> polygons;
    if (const auto a = given.rows("polygons")) polygons = ids_of(*a);
    params.polygons = polygons;
    if (given.get("usual_weld", false)) params.weld_tolerance = repair_params::usual_tolerance(points, triangles);
    given.read("weld", params.weld_tolerance);
    std::optional<repaired_surface> made;
    {
        nb::gil_scoped_release unlocked;
        made.emplace(repair_surface(points, triangles, params));
    }
    nb::dict d;
    d["V"] = array_of<3>(made->surface.points());
    d["F"] = array_of(made->surface.cells());
    d["vmap"] = array_of(made->vertex_origins);
    d["fmap"] = array_of(made->cell_origins);
    std::vector<idx> turned;
    for (std::size_t c = 0; c < made->turned.size(); ++c)
        if (made->turned[c]) turned.push_back(static_cast<idx>(c));
    d["turned"] = array_of(turned);
    nb::list notes;
    nb::dict ids;
    for (const auto& f : made->findings)
    {
        notes.append(text(f.message()));
        ids[text(to_string(f.kind))] = array_of(f.ids);
    }
    d["notes"] = notes;
    d["findings"] = ids;
    return d;
}

} // namespace

void add_repair(nb::module_& m)
{
    m.def("repair", &repair);
}

} // namespace taut::python
