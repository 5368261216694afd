// SPDX-License-Identifier: MIT
// Energy, gradient and Hessian of maps as numbers.
#include <taut/impl/core/objective/volume_objective.hpp>
#include <taut/solve.hpp>

#include "bindings.hpp"
#include "queues.hpp"
#include "reports.hpp"
#include "shared_params.hpp"

namespace taut::python
{

namespace
{

template <class Element>
class evaluator_of
{
public:
    static constexpr int D = Element::dimension;

    evaluator_of(const array& V, const array& C, const nb::dict& keywords)
        : queue_(borrow_queue(options(keywords).get<std::string>("device", "")))
    {
        const options given(keywords);
        any_energy energy = default_energy();
        given.read("energy", energy);
        if (const auto a = given.rows("parameters")) energy = energy.with_parameters(numbers_of(*a));
        auto weights = energy::weighting::measure;
        given.read_word("weighting", weights,
                        {{"area", energy::weighting::measure},
                         {"volume", energy::weighting::measure},
                         {"uniform", energy::weighting::uniform}});
        auto how = precision::fp64;
        given.read_word("precision", how,
                        {{"fp64", precision::fp64}, {"mixed", precision::mixed}, {"fp32", precision::fp32}});
        const auto m = mesh_of<Element>(V, C);
        const auto data = data_of(given);
        nb::gil_scoped_release unlocked;
        evaluator_ = std::make_unique<map_evaluator<Element>>(*queue_, m, energy, weights, how, data);
    }

    double value(const array& x)
    {
        const auto points = points_of<D>(x, "x");
        nb::gil_scoped_release unlocked;
        return evaluator_->value(points);
    }

    nb::tuple value_gradient(const array& x)
    {
        const auto points = points_of<D>(x, "x");
        std::vector<vec<D>> gradient(points.size());
        double value = 0;
        {
            nb::gil_scoped_release unlocked;
            value = evaluator_->value_gradient(points, gradient);
        }
        return nb::make_tuple(value, array_of<D>(std::move(gradient)));
    }

    /// Offsets, columns and the numbers of the blocks by rows.
    nb::tuple hessian(const array& x, bool projected)
    {
        const auto points = points_of<D>(x, "x");
        block_rows<D> found;
        {
            nb::gil_scoped_release unlocked;
            found = evaluator_->hessian(points, projected ? definiteness::projected : definiteness::indefinite);
        }
        std::vector<double> numbers;
        numbers.reserve(found.blocks.size() * D * D);
        for (const auto& block : found.blocks)
            for (int i = 0; i < D; ++i)
                for (int j = 0; j < D; ++j) numbers.push_back(block[j][i]);
        return nb::make_tuple(array_of(found.offsets), array_of(found.columns), array_of(std::move(numbers)));
    }

    double max_step(const array& x, const array& d)
    {
        const auto points = points_of<D>(x, "x"), direction = points_of<D>(d, "dx");
        nb::gil_scoped_release unlocked;
        return evaluator_->max_step(points, direction);
    }

private:
    std::shared_ptr<queue> queue_;
    std::unique_ptr<map_evaluator<Element>> evaluator_; // gone before its queue is anybody's
};

template <class Element>
void add_evaluator_of(nb::module_& m, const char* name)
{
    using evaluator = evaluator_of<Element>;
    nb::class_<evaluator>(m, name)
        .def(nb::init<const array&, const array&, const nb::dict&>())
        .def("value", &evaluator::value)
        .def("value_gradient", &evaluator::value_gradient)
        .def("hessian", &evaluator::hessian)
        .def("max_step", &evaluator::max_step);
}

} // namespace

void add_evaluator(nb::module_& m)
{
    add_evaluator_of<triangle>(m, "Evaluator2");
    add_evaluator_of<tetrahedron>(m, "Evaluator3");
}

} // namespace taut::python
