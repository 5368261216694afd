// SPDX-License-Identifier: MIT
// Surfaces in space that bend and stretch.
#include <taut/deform.hpp>

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

struct shell_job
{
    thin_shell surface;
    shell_params params;
    run_limits limits;
    std::string device;
    std::shared_ptr<queue> queue_in_use;
};

nb::object shell(const array& V, const array& F, const nb::dict& keywords, const control_handle& watched)
{
    const options given(keywords);
    auto job = std::make_shared<shell_job>(shell_job{thin_shell(mesh_of<triangle>(V, F)), {}, {}, {}, {}});
    auto& params = job->params;
    params.constraints = constraints_of(job->surface.hinges(), given);
    if (double thickness = 0; given.read("thickness", thickness)) params.thickness = thickness;
    if (const auto a = given.rows("initial")) params.initial = points_of<3>(*a, "initial");
    read_solver(params, given);
    job->limits = limits_of(given, watched.shared, "shell");
    given.read("device", job->device);
    return told(run(watched.shared, given.progress(),
                    [job]
                    {
                        job->queue_in_use = borrow_queue(job->device);
                        return deform(*job->queue_in_use, job->surface, job->params, job->limits);
                    }),
                [](session_result<hinge> made) -> nb::object
                {
                    nb::dict d = dict_of(made.report);
                    d["x"] = array_of<3>(std::move(made.x));
                    return d;
                });
}

} // namespace

void add_shells(nb::module_& m)
{
    m.def("shell", &shell);
}

} // namespace taut::python
