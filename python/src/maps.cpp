// SPDX-License-Identifier: MIT
// Maps of surfaces to the plane, and what any map is like.
#include <span>
#include <string>
#include <vector>

#include <taut/atlas.hpp>
#include <taut/impl/charts/atlas/chart_mesh.hpp>
#include <taut/impl/charts/atlas/cut_to_disk.hpp>
#include <taut/impl/core/constrain/constraint_error.hpp>
#include <taut/impl/core/exact/convex_polygons.hpp>
#include <taut/impl/core/mesh/validate.hpp>
#include <taut/mesh.hpp>
#include <taut/parameterize.hpp>
#include <taut/quality.hpp>

#include <taut/certify.hpp>
#include <taut/impl/charts/packing/settle_map.hpp>

#include "atlas_options.hpp"
#include "bindings.hpp"
#include "call.hpp"
#include "constraint_rows.hpp"
#include "queues.hpp"
#include "reports.hpp"
#include "shared_params.hpp"

namespace taut::python
{

parameterize_params map_params(const options& given, const mesh<triangle>& m)
{
    parameterize_params params;
    read_energy(params, given);
    params.constraints = constraints_of(m, given);
    if (const auto a = given.rows("polygons")) params.polygons = ids_of(*a);
    if (const auto a = given.rows("initial")) params.initial = points_of<2>(*a, "initial");
    given.read_word(
        "boundary", params.boundary,
        {{"free", boundary_mode::free}, {"circle", boundary_mode::fixed}, {"square", boundary_mode::square}});
    given.read_word("placement", params.placement,
                    {{"upright", placement::upright},
                     {"unit_square", placement::unit_square},
                     {"as_solved", placement::as_solved}});
    given.read("no_overlap", params.no_overlap);
    given.read("holes", params.holes);
    if (given.find("tolerance")) params.solve = {}; // which asks for that, not for what has settled
    read_solver(params, given);
    return params;
}

namespace
{

/// Everything that a run owns.
struct map_job
{
    mesh<triangle> surface;
    std::optional<chart_mesh> cut;
    parameterize_params params;
    run_limits limits;
    std::shared_ptr<queue> device;
    bool single = false;     ///< numbers are those that single precision holds
    std::vector<idx> pinned; ///< vertices that rounding alone moves then

    const mesh<triangle>& mapped() const { return cut ? cut->surface : surface; }

    map_result make()
    {
        map_result made = parameterize(*device, mapped(), params, limits);
        if (made && single) round(made);
        return made;
    }

private:
    /// Rounds a map to single precision, and moves what that flattens or turns over by as little as it takes. A map of
    /// which more cannot be saved is none.
    void round(map_result& made) const
    {
        const mesh<triangle>& m = mapped();
        std::vector<vec2>& x = made.uv;
        std::vector<char> held(x.size(), 0);
        for (const idx v : pinned)
        {
            held[static_cast<std::size_t>(v)] = 1;
            x[static_cast<std::size_t>(v)] = in_float(x[static_cast<std::size_t>(v)]);
        }
        impl::convex_polygons polygons;
        if (!params.polygons.empty()) polygons = impl::find_convex_polygons(m.cells(), params.polygons, m.points());
        impl::settle_piece(m.cells(), polygons.corners, 0, static_cast<idx>(x.size()), x,
                           {.stored = in_float, .held = held, .apart = params.no_overlap});
        map_report& r = made.report;
        r.flips = certify<2>(m.cells(), std::span<const vec2>(x), {}, m.cells().size());
        const std::size_t crossings = params.no_overlap ? boundary_crossings(boundary_loops(m), x) : 0;
        r.concave.clear();
        for (const idx k : impl::find_concave(polygons, x))
            r.concave.push_back(polygons.numbers[static_cast<std::size_t>(k)]);
        if (r.flips && crossings == 0) return;
        r.outcome = outcome::gave_up;
        r.ids = r.flips.ids;
        r.reason = r.flips.flipped > 0 ? std::to_string(r.flips.flipped) +
                                             " triangles are too thin for single precision; leave out `single`"
                                       : "the border is too narrow for single precision; leave out `single`";
    }
};

/// The surface cut along seams that make it one disk; nothing if it is one.
std::optional<chart_mesh> cut_if_needed(const mesh<triangle>& m)
{
    const auto f = impl::facets(m);
    validate(m, f, {.referenced = false, .open = false, .one_boundary = false, .no_handles = false});
    if (check(m, f, {.referenced = false}).empty()) return std::nullopt;
    return cut_charts(m, f, cut_to_disk(m, f));
}

/// The options for a surface that was cut, whose vertices have other numbers. Throws constraint_error for pins and
/// springs of vertices that a seam divides.
nb::dict for_cut_surface(const nb::dict& given, const mesh<triangle>& whole, const chart_mesh& cut)
{
    std::vector<idx> place(whole.points().size(), -1), sheets(place.size(), 0);
    for (std::size_t i = 0; i < cut.vertex_origins.size(); ++i)
    {
        const auto v = static_cast<std::size_t>(cut.vertex_origins[i]);
        place[v] = static_cast<idx>(i);
        ++sheets[v];
    }
    nb::dict changed;
    for (const auto& [name, value] : given) changed[name] = value;
    std::vector<idx> divided;
    for (const char* name : {"b", "spring_b"})
    {
        if (!given.contains(name)) continue;
        auto ids = ids_of(nb::cast<array>(given[name]));
        for (idx& v : ids)
        {
            const auto old = static_cast<std::size_t>(v);
            if (sheets[old] > 1) divided.push_back(v);
            v = place[old] < 0 ? 0 : place[old];
        }
        changed[name] = array_of(ids);
    }
    impl::refuse_vertices(constraint_error::contradictory, std::move(divided),
                          "on the seam, which divides them into several; pin vertices beside it");
    return changed;
}

nb::object unwrap(const array& V, const array& F, const nb::dict& keywords, const control_handle& watched)
{
    options given(keywords);
    auto job = std::make_shared<map_job>(map_job{mesh_of<triangle>(V, F), {}, {}, {}, {}, false, {}});
    if (given.get("cut", false)) job->cut = cut_if_needed(job->surface);
    if (job->cut) given = options(for_cut_surface(keywords, job->surface, *job->cut));
    job->params = map_params(given, job->mapped());
    given.read("single", job->single);
    if (const auto b = given.rows("b")) job->pinned = ids_of(*b);
    job->limits = limits_of(given, watched.shared, "map");
    const auto device = given.get<std::string>("device", "");
    return told(run(watched.shared, given.progress(),
                    [job, device]
                    {
                        job->device = borrow_queue(device);
                        return job->make();
                    }),
                [job](map_result result) -> nb::object
                {
                    nb::dict d = dict_of(result.report);
                    d["x"] = array_of<2>(std::move(result.uv));
                    if (job->cut)
                    {
                        const auto& c = *job->cut;
                        std::vector<std::array<idx, 3>> faces(c.surface.cells().size());
                        for (std::size_t i = 0; i < faces.size(); ++i)
                            faces[static_cast<std::size_t>(c.cell_origins[i])] = c.surface.cells()[i];
                        d["faces"] = array_of(faces);
                        d["vmapping"] = array_of(c.vertex_origins);
                    }
                    return d;
                });
}

template <class Element>
nb::dict certify_of(const array& C, const array& x)
{
    constexpr int D = Element::dimension;
    const auto cells = cells_of<Element::corners>(C, "C");
    const auto points = points_of<D>(x, "x");
    certificate found;
    {
        nb::gil_scoped_release unlocked;
        found = certify<D>(cells, std::span<const vec<D>>(points), {}, cells.size());
    }
    return dict_of(found);
}

template <class Element>
nb::object distortion_of(const array& V, const array& C, const array& x)
{
    constexpr int D = Element::dimension;
    const auto m = mesh_of<Element>(V, C);
    const auto points = points_of<D>(x, "x");
    std::vector<double> values;
    {
        nb::gil_scoped_release unlocked;
        values = distortion(m, std::span<const vec<D>>(points));
    }
    return array_of(std::move(values));
}

nb::dict dict_of(const impl::means& m)
{
    nb::dict d;
    d["uniform"] = m.uniform;
    d["measure"] = m.measure;
    return d;
}

nb::dict dict_of(const spread& s)
{
    nb::dict d;
    d["min"] = s.min;
    d["max"] = s.max;
    d["rms"] = s.rms;
    return d;
}

template <class Element>
nb::dict quality_of(const array& V, const array& C, const array& x)
{
    constexpr int D = Element::dimension;
    const auto m = mesh_of<Element>(V, C);
    const auto points = points_of<D>(x, "x");
    quality q;
    {
        nb::gil_scoped_release unlocked;
        q = measure_quality(m, std::span<const vec<D>>(points));
    }
    nb::dict d;
    d["isometric"] = dict_of(q.isometric);
    d["shape"] = dict_of(q.shape);
    d["area"] = dict_of(q.area);
    d["scale"] = q.scale;
    d["stretch_l2"] = dict_of(q.stretch_l2);
    d["stretch_linf"] = dict_of(q.stretch_linf);
    d["stretch_l2_total"] = q.stretch_l2_total;
    d["area_ratio"] = dict_of(q.area_ratio);
    d["angular"] = q.angular;
    d["flips"] = python::dict_of(q.flips);
    return d;
}

} // namespace

void add_maps(nb::module_& m)
{
    m.def("unwrap", &unwrap);
    m.def("certify2", &certify_of<triangle>);
    m.def("certify3", &certify_of<tetrahedron>);
    m.def("distortion2", &distortion_of<triangle>);
    m.def("distortion3", &distortion_of<tetrahedron>);
    m.def("quality2", &quality_of<triangle>);
    m.def("quality3", &quality_of<tetrahedron>);
}

} // namespace taut::python
