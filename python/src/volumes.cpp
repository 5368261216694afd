// SPDX-License-Identifier: MIT
// Volumes and meshes of the plane: deformed, smoothed, untangled.
#include <optional>
#include <utility>

#include <taut/deform.hpp>
#include <taut/smooth.hpp>
#include <taut/untangle.hpp>
#include <taut/volume_file.hpp>

#include "bindings.hpp"
#include "call.hpp"
#include "constraint_rows.hpp"
#include "queues.hpp"
#include "reports.hpp"
#include "shared_params.hpp"

namespace taut::python
{

namespace
{

/// Cells of any kinds as simplices.
template <class Element>
io::impl::corner_simplices<Element> simplices_of(const array& V, const nb::list& blocks)
{
    io::volume_file file;
    file.dimension = Element::dimension;
    file.points = places_of(V, "V");
    for (const nb::handle block : blocks)
    {
        const auto cells = nb::cast<array>(block);
        const std::size_t corners = cells.shape(1);
        io::cell_kind kind = io::cell_kind::triangle;
        switch (corners)
        {
        case 3:
            kind = io::cell_kind::triangle;
            break;
        case 4:
            kind = Element::dimension == 2 ? io::cell_kind::quad : io::cell_kind::tetrahedron;
            break;
        case 5:
            kind = io::cell_kind::pyramid;
            break;
        case 6:
            kind = io::cell_kind::wedge;
            break;
        case 8:
            kind = io::cell_kind::hexahedron;
            break;
        default:
            throw parameter_error("C",
                                  "has cells of " + std::to_string(corners) + " corners; 3, 4, 5, 6 and 8 are known");
        }
        file.cells.push_back({kind, ids_of(cells)});
        for (const idx v : file.cells.back().corners)
            if (v < 0 || static_cast<std::size_t>(v) >= file.points.size())
                throw parameter_error("C", "names vertex " + std::to_string(v) + " of " +
                                               std::to_string(file.points.size()));
    }
    return file.corner_simplices<Element>();
}

template <class Element>
std::vector<vec<Element::dimension>> positions_of(const mesh<Element>& m)
{
    std::vector<vec<Element::dimension>> x;
    for (const vec3& p : m.points()) x.emplace_back(p);
    return x;
}

template <class Element>
struct shape_job
{
    io::impl::corner_simplices<Element> cells;
    deform_params<Element> deforming;
    smooth_params<Element> smoothing;
    run_limits limits;
    bool refine = false;
    std::string device;
    std::shared_ptr<queue> queue_in_use;

    const mesh<Element>& simplices() const { return cells.simplices; }
    std::vector<idx> owners() const { return cells.overlapping ? cells.cells : std::vector<idx>(); }
};

template <class Element>
std::shared_ptr<shape_job<Element>> job_of(const array& V, const nb::list& C, const options& given)
{
    auto job = std::make_shared<shape_job<Element>>(
        shape_job<Element>{simplices_of<Element>(V, C), {}, {}, {}, false, {}, {}});
    given.read("device", job->device);
    given.read("refine", job->refine);
    return job;
}

template <class Element>
void read_slides(deform_params<Element>& params, const options& given)
{
    constexpr int D = Element::dimension;
    const auto vertices = given.rows("slide_b");
    if (!vertices) return;
    const auto ids = ids_of(*vertices);
    const auto across = points_of<D>(*given.rows("slide_normals"), "slides");
    for (std::size_t i = 0; i < ids.size(); ++i) params.slides.push_back(slide<D>::across(ids[i], across[i]));
}

/// Of a refined mesh: its cells and what they are parts of.
template <class Element>
void add_refined(nb::dict& d, const mesh<Element>& refined, const std::vector<idx>& cells, int rounds)
{
    d["C"] = array_of(refined.cells());
    d["V"] = array_of<3>(refined.points());
    d["cell_origins"] = array_of(cells);
    d["rounds"] = rounds;
}

template <class Element>
nb::object deform_of(const array& V, const nb::list& C, const nb::dict& keywords, const control_handle& watched)
{
    constexpr int D = Element::dimension;
    const options given(keywords);
    auto job = job_of<Element>(V, C, given);
    auto& params = job->deforming;
    read_energy(params, given);
    params.constraints = constraints_of(job->simplices(), given);
    params.owners = job->owners();
    if (job->cells.overlapping && params.data.weights.empty()) params.data.weights = job->cells.weights;
    if (const auto a = given.rows("rest")) // the mesh at rest then, which begins as V
    {
        params.initial = positions_of(job->simplices());
        job->cells.simplices = mesh<Element>(places_of(*a, "rest"), job->simplices().cells());
    }
    if (const auto a = given.rows("initial")) params.initial = points_of<D>(*a, "initial");
    given.read_word("shapes", params.regular, {{"rest", false}, {"regular", true}});
    read_slides(params, given);
    read_solver(params, given);
    job->limits = limits_of(given, watched.shared, "deform");
    return told(run(watched.shared, given.progress(),
                    [job]
                    {
                        job->queue_in_use = borrow_queue(job->device);
                        if (job->refine)
                            return deform(*job->queue_in_use, job->simplices(), job->deforming, job->limits, {});
                        return refined_deformation<Element>{
                            deform(*job->queue_in_use, job->simplices(), job->deforming, job->limits),
                            job->simplices(),
                            {},
                            {},
                            0};
                    }),
                [job](refined_deformation<Element> made) -> nb::object
                {
                    nb::dict d = dict_of(made.result.report);
                    d["x"] = array_of<D>(std::move(made.result.x));
                    if (job->refine) add_refined(d, made.refined, made.cells, made.rounds);
                    return d;
                });
}

template <class Element>
nb::object smooth_of(const array& V, const nb::list& C, const nb::dict& keywords, const control_handle& watched)
{
    const options given(keywords);
    auto job = job_of<Element>(V, C, given);
    auto& params = job->smoothing;
    given.read_word(
        "boundary", params.boundary,
        {{"fixed", smooth_boundary::fixed}, {"sliding", smooth_boundary::sliding}, {"free", smooth_boundary::free}});
    bool regular = true;
    given.read_word("shapes", regular, {{"rest", false}, {"regular", true}});
    const auto rest = given.rows("rest");
    if (!regular) params.rest = rest ? places_of(*rest, "rest") : job->simplices().points();
    given.read("worst_exponent", params.worst_exponent);
    if (const auto a = given.rows("fixed")) params.fixed = ids_of(*a);
    params.owners = job->owners();
    if (job->cells.overlapping) params.targets = job->cells.regular;
    read_solver(params, given);
    job->limits = limits_of(given, watched.shared, "smooth");
    return told(run(watched.shared, given.progress(),
                    [job]
                    {
                        job->queue_in_use = borrow_queue(job->device);
                        return smooth(*job->queue_in_use, job->simplices(), job->smoothing, job->limits);
                    }),
                [](smooth_result<Element> made) -> nb::object
                {
                    nb::dict d = dict_of(made.report);
                    d["before"] = dict_of(made.before);
                    d["after"] = dict_of(made.after);
                    d["x"] = array_of<Element::dimension>(std::move(made.x));
                    return d;
                });
}

template <class Element>
struct untangle_job
{
    untangle_problem<Element> problem;
    untangle_params params;
    run_limits limits;
    bool refine = false;
    std::string device;
    std::shared_ptr<queue> queue_in_use;
};

template <class Element>
nb::object untangle_of(const array& X, const nb::list& C, const nb::dict& keywords, const control_handle& watched)
{
    constexpr int D = Element::dimension;
    const options given(keywords);
    const auto found = job_of<Element>(X, C, given);
    auto initial = positions_of(found->simplices());
    const auto rest = given.rows("rest");
    mesh<Element> at_rest(rest ? places_of(*rest, "rest") : found->simplices().points(), found->simplices().cells());
    constraints<Element> pins(at_rest);
    if (const auto b = given.rows("b"))
        for (const idx v : ids_of(*b))
            pins.pin(v, v >= 0 && static_cast<std::size_t>(v) < initial.size() ? initial[static_cast<std::size_t>(v)]
                                                                               : vec<D>(0.0));
    auto job = std::make_shared<untangle_job<Element>>(
        untangle_job<Element>{make_untangle_problem(at_rest, std::move(initial), pins),
                              {},
                              limits_of(given, watched.shared, "untangle"),
                              found->refine,
                              found->device,
                              {}});
    if (!rest) job->problem.wanted = found->cells.regular;
    job->problem.owners = found->owners();
    given.read("stages", job->params.stages);
    given.read("rounds", job->params.rounds);
    return told(run(watched.shared, given.progress(),
                    [job]
                    {
                        job->queue_in_use = borrow_queue(job->device);
                        if (job->refine)
                            return untangle(*job->queue_in_use, job->problem, job->params, job->limits, {});
                        return refined_untangling<Element>{
                            untangle(*job->queue_in_use, job->problem, job->params, job->limits), {job->problem}};
                    }),
                [job](refined_untangling<Element> made) -> nb::object
                {
                    nb::dict d = dict_of(std::move(made.result));
                    if (job->refine) add_refined(d, made.refined.problem.rest, made.refined.cells, made.refined.rounds);
                    return d;
                });
}

} // namespace

void add_volumes(nb::module_& m)
{
    m.def("deform2", &deform_of<triangle>);
    m.def("deform3", &deform_of<tetrahedron>);
    m.def("smooth2", &smooth_of<triangle>);
    m.def("smooth3", &smooth_of<tetrahedron>);
    m.def("untangle2", &untangle_of<triangle>);
    m.def("untangle3", &untangle_of<tetrahedron>);
}

} // namespace taut::python
