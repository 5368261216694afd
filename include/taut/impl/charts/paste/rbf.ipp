// SPDX-License-Identifier: MIT
#pragma once

#include <taut/impl/charts/paste/rbf.hpp>
#include <taut/impl/charts/paste/rbf_system.hpp>

namespace taut::impl
{

rbf::rbf(std::span<const vec3> points, const rbf_params& params)
    : system_(std::make_shared<const rbf_system>(points, params))
{
}

rbf_field rbf::solve(std::span<const vec3> values) const
{
    return system_->solve(values);
}
idx rbf::size() const
{
    return system_->size();
}
idx rbf::duplicates() const
{
    return system_->duplicates();
}
int rbf::polynomial_terms() const
{
    return system_->polynomial_terms();
}
double rbf::reciprocal_condition() const
{
    return system_->reciprocal_condition();
}
bool rbf::is_sparse() const
{
    return system_->is_sparse();
}

} // namespace taut::impl
