// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include <taut/arrays.hpp>
#include <taut/impl/charts/paste/rbf_field.hpp>
#include <taut/impl/core/compute/host/programs.hpp>
#include <taut/impl/core/compute/kernel.hpp>
#include <taut/impl/core/compute/kernels/rbf.hpp>
#include <taut/impl/core/mesh/arrays.hpp>
#include <taut/queue.hpp>

namespace taut::impl
{

/// Evaluates fields at many points on a device, one launch per field. The points are kept on the device; the fields
/// have one basis, origin and unit. In double where the device has it.
class rbf_evaluator
{
public:
    rbf_evaluator() = default; ///< at no point

    /// field: any of those to be evaluated, as returned by rbf::solve().
    rbf_evaluator(queue& q, const rbf_field& field, std::span<const vec3> points)
        : count_(points.size()), radius_(field.radius)
    {
        if (count_ == 0) return;
        type_ = q.device().has_fp64() ? scalar_type::f64 : scalar_type::f32;
        std::vector<vec3> y;
        for (const vec3& p : points) y.push_back((p - field.origin) / field.unit);
        x_ = {q, type_, numbers_of<3>(y)};
        centres_ = {q, type_, numbers_of<3>(field.centres)};
        weights_ = {q, type_, 3 * field.centres.size()};
        polynomial_ = {q, type_, 12};
        out_ = {q, type_, 3 * count_};
        evaluate_ =
            make_kernel(q,
                        own_program{.text = kernels::rbf,
                                    .host = host_rbf,
                                    .settings = {{"REAL", spelling(type_)}, {"PHI", static_cast<int>(field.basis)}},
                                    .real = type_},
                        "rbf_evaluate");
    }

    /// The field at each point. Throws parameter_error for a field with other centres, device_error.
    std::vector<vec3> operator()(const rbf_field& field)
    {
        std::vector<vec3> values(count_);
        if (count_ == 0) return values;
        if (3 * field.centres.size() != centres_.size())
            throw parameter_error("field", "has other centres than that which the evaluator was made for");
        weights_.upload(numbers_of<3>(field.weights));
        polynomial_.upload(numbers_of<3>(std::span<const vec3>(field.polynomial)));
        constexpr std::size_t group = 64;
        evaluate_({(count_ + group - 1) / group * group, group},
                  {{"count", static_cast<idx>(count_)},
                   {"centre_count", static_cast<idx>(field.centres.size())},
                   {"scale", 1 / radius_},
                   {"x", x_},
                   {"centres", centres_},
                   {"weights", weights_},
                   {"polynomial", polynomial_},
                   {"out", out_}});
        out_.download(std::span(&values[0].x, 3 * count_));
        return values;
    }

    std::size_t size() const { return count_; }

private:
    std::size_t count_ = 0;
    double radius_ = 1;
    scalar_type type_ = scalar_type::f64;
    real_buffer x_, centres_, weights_, polynomial_, out_;
    kernel evaluate_;
};

} // namespace taut::impl
