// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <memory>

#include <taut/device_vectors.hpp>
#include <taut/impl/core/compute/reductions.hpp>

namespace taut
{

/// Workspace, shared by copies of the space; kernels are built when first used.
struct device_vectors::shared
{
    shared(const taut::queue& q, scalar_type real, impl::reduction_plan p)
        : queue(q), type(real), plan(p), reductions(impl::reductions_by(q, p))
    {
    }

    const kernel& get(kernel& k, const char* name);

    taut::queue queue;
    scalar_type type;
    impl::reduction_plan plan;
    taut::reductions reductions;
    kernel combine, step_float, step_double;
};

} // namespace taut

namespace taut::impl
{

/// Vectors whose sums have another partition than that of the device.
inline device_vectors vectors_by(const queue& q, scalar_type type, std::size_t n, const reduction_plan& plan)
{
    return device_vectors(std::make_shared<device_vectors::shared>(q, type, plan), n);
}

} // namespace taut::impl
