// SPDX-License-Identifier: MIT
#pragma once

#include <taut/impl/compute/kernel.hpp>

#include "measure.hpp"

namespace bench
{

/// The bandwidth of the device's memory in bytes a second: STREAM's triad on arrays of 64 MiB, the best of some runs,
/// as STREAM has it. In float, which every device has: a byte is a byte.
inline double device_triad(taut::queue& q, std::size_t bytes = std::size_t{64} << 20, int runs = 10)
{
    const std::size_t n = bytes / (4 * sizeof(float)), group = 64;
    const auto triad = q.kernel<taut::buffer<float>, const taut::buffer<float>, float, const taut::buffer<float>>(
        "__kernel void triad(__global float4* a, __global const float4* b, float s, __global const float4* c)\n"
        "{ const size_t i = get_global_id(0); a[i] = b[i] + s * c[i]; }\n",
        "triad");
    taut::buffer<float> a(q, 4 * n), b(q, 4 * n), c(q, 4 * n);
    for (auto* x : {&a, &b, &c}) x->fill(1.0f);
    double least = std::numeric_limits<double>::infinity();
    for (int r = 0; r <= runs; ++r)
    {
        q.finish();
        const double t = seconds(
            [&]
            {
                triad(taut::range(n, group), a, b, 3.0f, c);
                q.finish();
            });
        if (r > 0) least = std::min(least, t);
    }
    return 3.0 * 4 * sizeof(float) * static_cast<double>(n) / least;
}

} // namespace bench
