// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <memory>
#include <utility>
#include <vector>

#include <taut/impl/charts/paste/pasted.hpp>
#include <taut/paste.hpp>

namespace taut
{

paste::paste(queue& q, mesh<triangle> target, feature part, idx onto, const paste_params& params,
             const run_limits& limits)
    : body_(std::make_unique<impl::pasted>(q, std::move(target), std::move(part), onto, params, limits))
{
}

paste::paste(paste&&) noexcept = default;
paste& paste::operator=(paste&&) noexcept = default;
paste::~paste() = default;

paste& paste::pose(const paste_pose& to)
{
    body_->pose(to);
    return *this;
}

paste& paste::refill(feature part)
{
    body_->refill(std::move(part));
    return *this;
}

const paste_pose& paste::pose() const
{
    return body_->pose();
}
const std::vector<vec3>& paste::points() const
{
    return body_->points();
}
const std::vector<paste::cell>& paste::cells() const
{
    return body_->cells();
}
mesh<triangle> paste::surface() const
{
    return body_->surface();
}
const mesh<triangle>& paste::target() const
{
    return body_->target();
}
const std::vector<idx>& paste::origins() const
{
    return body_->origins();
}
const std::vector<idx>& paste::kept_faces() const
{
    return body_->kept_faces();
}
const feature& paste::part() const
{
    return body_->part();
}
const std::vector<vec2>& paste::rim_uv() const
{
    return body_->rim_uv();
}
idx paste::first_gap() const
{
    return body_->first_gap();
}
idx paste::first_feature() const
{
    return body_->first_feature();
}
impl::similarity_transform paste::transform() const
{
    return body_->transform();
}
const impl::paste_report& paste::report() const
{
    return body_->report();
}
impl::seam_quality paste::measure_seam() const
{
    return impl::measure_seam(surface(), first_gap(), first_feature());
}
std::vector<std::array<idx, 2>> paste::self_intersections() const
{
    return body_->self_intersections();
}
std::vector<std::array<idx, 2>> paste::folds() const
{
    return body_->folds();
}
bool paste::unfold()
{
    return body_->unfold();
}

} // namespace taut
