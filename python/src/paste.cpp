// SPDX-License-Identifier: MIT
// Cut and paste: a part of one surface on another one.
#include <taut/paste.hpp>

#include "bindings.hpp"
#include "call.hpp"
#include "queues.hpp"
#include "reports.hpp"

namespace taut::python
{

namespace
{

struct paste_job
{
    mesh<triangle> target, source;
    std::vector<idx> faces; ///< of the feature; or none
    idx at = 0, onto = 0;
    double radius = 0; ///< around `at`, where there are no faces
    bool unfold = false;
    paste_params params;
    run_limits limits;
    std::string device;
    std::shared_ptr<queue> queue_in_use;
};

struct pasted
{
    std::vector<vec3> points;
    std::vector<std::array<idx, 3>> cells;
    std::vector<idx> origins, kept_faces;
    idx first_gap = 0, first_feature = 0;
    impl::paste_report report;
    impl::seam_quality seam;
    bool unfolded = true;
};

pasted make(paste_job& job)
{
    job.queue_in_use = borrow_queue(job.device);
    auto region =
        job.faces.empty() ? geodesic_disk(job.source, job.at, job.radius) : region_of_faces(job.source, job.faces);
    paste p(*job.queue_in_use, job.target, feature(std::move(region)), job.onto, job.params, job.limits);
    pasted made;
    if (job.unfold) made.unfolded = p.unfold();
    made.points = p.points();
    made.cells = p.cells();
    made.origins = p.origins();
    made.kept_faces = p.kept_faces();
    made.first_gap = p.first_gap();
    made.first_feature = p.first_feature();
    made.report = p.report();
    made.seam = p.measure_seam();
    return made;
}

nb::dict dict_of(pasted made)
{
    nb::dict d;
    d["V"] = array_of<3>(std::move(made.points));
    d["F"] = array_of(made.cells);
    d["vmapping"] = array_of(made.origins);
    d["kept_faces"] = array_of(made.kept_faces);
    d["first_gap"] = made.first_gap;
    d["first_feature"] = made.first_feature;
    d["way"] = text(made.report.way);
    d["removed_triangles"] = made.report.removed_triangles;
    d["manifold"] = made.seam.manifold;
    d["boundary_edges"] = made.seam.boundary_edges;
    d["folded"] = made.seam.folded;
    d["unfolded"] = made.unfolded;
    return d;
}

nb::object paste_of(const array& V, const array& F, const array& source_V, const array& source_F,
                    const nb::dict& keywords, const control_handle& watched)
{
    const options given(keywords);
    auto job = std::make_shared<paste_job>(paste_job{mesh_of<triangle>(V, F),
                                                     mesh_of<triangle>(source_V, source_F),
                                                     {},
                                                     0,
                                                     0,
                                                     0,
                                                     false,
                                                     {},
                                                     {.time_limit = std::chrono::seconds(20)},
                                                     {},
                                                     {}});
    given.read("onto", job->onto);
    given.read("at", job->at);
    given.read("radius", job->radius);
    if (const auto a = given.rows("faces")) job->faces = ids_of(*a);
    given.read("unfold", job->unfold);
    given.read("turn", job->params.pose.turn);
    given.read("scale", job->params.pose.scale);
    given.read("softness", job->params.pose.softness);
    if (const auto a = given.rows("shift"))
    {
        const auto numbers = numbers_of(*a);
        if (numbers.size() != 3) throw parameter_error("shift", "must be 3 numbers");
        job->params.pose.shift = vec3(numbers[0], numbers[1], numbers[2]);
    }
    given.read("reach", job->params.reach);
    given.read_seconds("time_limit", job->limits.time_limit);
    given.read("device", job->device);
    return told(run(watched.shared, given.progress(), [job] { return make(*job); }),
                [](pasted made) -> nb::object { return dict_of(std::move(made)); });
}

} // namespace

void add_paste(nb::module_& m)
{
    m.def("paste", &paste_of);
}

} // namespace taut::python
