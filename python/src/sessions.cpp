// SPDX-License-Identifier: MIT
// Interactive sessions.
#include <atomic>
#include <memory>

#include <taut/session.hpp>

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

/// Asks whoever watches the call of the moment.
struct relay
{
    std::mutex mutex;
    std::shared_ptr<control> watched;

    taut::observer observer(const std::shared_ptr<relay>& self) const
    {
        return [self](const progress& p)
        {
            std::shared_ptr<control> now;
            {
                const std::lock_guard lock(self->mutex);
                now = self->watched;
            }
            return !now || now->observer("session")(p);
        };
    }
};

/// All that a session has, for the thread that works on it.
template <class Element>
struct session_state
{
    std::shared_ptr<relay> asked = std::make_shared<relay>();
    std::shared_ptr<queue> queue_in_use;
    std::optional<mesh<Element>> cells;
    std::optional<thin_shell> shell;
    std::optional<session<Element>> open; // gone before what it uses
    std::atomic<bool> busy{false};
};

template <class Element>
struct session_snapshot
{
    constraints<Element> asked;
    std::vector<vec<Element::dimension>> x;
    std::shared_ptr<session_state<Element>> of;
};

/// Marks a session as being worked on, while it lives.
struct at_work
{
    explicit at_work(std::atomic<bool>& mark) : busy(mark) {}
    ~at_work() { busy = false; }
    std::atomic<bool>& busy;
};

template <class Element>
class open_session
{
public:
    static constexpr int D = Element::dimension;
    using state = session_state<Element>;

    open_session(const array& V, const array& C, const nb::dict& keywords) : state_(std::make_shared<state>())
    {
        const options given(keywords);
        run_limits limits;
        given.read_seconds("time_limit", limits.time_limit);
        const auto device = given.get<std::string>("device", "");
        if constexpr (std::is_same_v<Element, hinge>)
        {
            state_->shell.emplace(mesh_of<triangle>(V, C));
            shell_params params;
            params.constraints = constraints_of(state_->shell->hinges(), given);
            if (double thickness = 0; given.read("thickness", thickness)) params.thickness = thickness;
            read_solver(params, given);
            begin(device, params, std::move(limits),
                  [](state& s, const auto& p, const auto& l) { s.open.emplace(*s.queue_in_use, *s.shell, p, l); });
        }
        else
        {
            state_->cells.emplace(mesh_of<Element>(V, C));
            if (std::is_same_v<Element, tetrahedron> || given.get("planar", false))
            {
                deform_params<Element> params;
                read_energy(params, given);
                params.constraints = constraints_of(*state_->cells, given);
                if (const auto a = given.rows("initial")) params.initial = points_of<D>(*a, "initial");
                read_solver(params, given);
                begin(device, params, std::move(limits),
                      [](state& s, const auto& p, const auto& l) { s.open.emplace(*s.queue_in_use, *s.cells, p, l); });
            }
            else if constexpr (std::is_same_v<Element, triangle>)
                begin(device, map_params(given, *state_->cells), std::move(limits),
                      [](state& s, const auto& p, const auto& l) { s.open.emplace(*s.queue_in_use, *s.cells, p, l); });
        }
    }

    void pin(idx v, const array& x)
    {
        const auto numbers = numbers_of(x);
        if (numbers.size() != D) throw parameter_error("x", "must be " + std::to_string(D) + " numbers");
        at_rest().pin(v, point_of(numbers));
    }
    void pin_coordinate(idx v, int k, double value) { at_rest().pin(v, k, value); }
    void move(const array& vertices, const array& places)
    {
        const auto ids = ids_of(vertices);
        const auto points = points_of<D>(places, "places");
        at_rest().move(std::span<const idx>(ids), std::span<const vec<D>>(points));
    }
    void spring(idx v, const array& x, double weight)
    {
        const auto numbers = numbers_of(x);
        if (numbers.size() != D) throw parameter_error("x", "must be " + std::to_string(D) + " numbers");
        at_rest().spring(v, point_of(numbers), weight);
    }
    void release(idx v) { at_rest().release(v); }

    void release_all()
    {
        auto& s = at_rest();
        std::vector<idx> ids;
        for (const auto& [v, p] : s.constraints().pins()) ids.push_back(v);
        for (const auto& p : s.constraints().springs()) ids.push_back(p.vertex);
        for (const idx v : ids) s.release(v);
    }

    nb::object pins()
    {
        std::vector<idx> ids;
        for (const auto& [v, p] : at_rest().constraints().pins()) ids.push_back(v);
        return array_of(ids);
    }

    session_snapshot<Element> snapshot()
    {
        auto& s = at_rest();
        return {s.constraints(), s.x(), state_};
    }
    void restore(const session_snapshot<Element>& earlier) { at_rest().restore(earlier.asked, earlier.x); }

    nb::object x() { return array_of<D>(at_rest().x()); }

    nb::object solve(double seconds, int steps, nb::handle progress, const control_handle& watched)
    {
        at_rest();
        session_budget budget;
        budget.time = std::chrono::duration<double>(seconds);
        if (steps > 0) budget.steps = steps;
        budget.validate();
        {
            const std::lock_guard lock(state_->asked->mutex);
            state_->asked->watched = watched.shared;
        }
        state_->busy = true;
        return told(run(watched.shared, progress,
                        [s = state_, budget]
                        {
                            const at_work mark(s->busy);
                            return s->open->solve(budget);
                        }),
                    [](session_result<Element> made) -> nb::object
                    {
                        nb::dict d = dict_of(made.report);
                        d["x"] = array_of<D>(std::move(made.x));
                        return d;
                    });
    }

private:
    static vec<D> point_of(const std::vector<double>& numbers)
    {
        vec<D> p;
        for (int k = 0; k < D; ++k) p[k] = numbers[static_cast<std::size_t>(k)];
        return p;
    }

    template <class Params, class Open>
    void begin(const std::string& device, const Params& params, run_limits limits, const Open& open)
    {
        limits.observer = state_->asked->observer(state_->asked);
        nb::gil_scoped_release unlocked;
        state_->queue_in_use = borrow_queue(device);
        open(*state_, params, limits);
    }

    /// Throws device_error while another thread, or a call that Ctrl-C has left, works on it.
    session<Element>& at_rest()
    {
        if (state_->busy)
            throw device_error("session", "another call is at work on it; wait for that, or open another session",
                               state_->queue_in_use->device().label());
        return *state_->open;
    }

    std::shared_ptr<state> state_;
};

template <class Element>
void add_session(nb::module_& m, const char* name, const char* snapshot)
{
    using open = open_session<Element>;
    nb::class_<session_snapshot<Element>>(m, snapshot);
    nb::class_<open>(m, name)
        .def(nb::init<const array&, const array&, const nb::dict&>())
        .def("pin", &open::pin)
        .def("pin_coordinate", &open::pin_coordinate)
        .def("move", &open::move)
        .def("spring", &open::spring)
        .def("release", &open::release)
        .def("release_all", &open::release_all)
        .def("pins", &open::pins)
        .def("snapshot", &open::snapshot)
        .def("restore", &open::restore)
        .def("x", &open::x)
        .def("solve", &open::solve, nb::arg("seconds"), nb::arg("steps"), nb::arg("progress").none(),
             nb::arg("watched"));
}

} // namespace

void add_sessions(nb::module_& m)
{
    add_session<triangle>(m, "MapSession", "MapSnapshot");
    add_session<tetrahedron>(m, "VolumeSession", "VolumeSnapshot");
    add_session<hinge>(m, "ShellSession", "ShellSnapshot");
}

} // namespace taut::python
