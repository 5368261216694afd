// SPDX-License-Identifier: MIT
#pragma once

#include <taut/impl/core/compute/kernel.hpp>

#include "measure.hpp"

namespace bench
{

/// Bytes of an array that no cache holds: a GPU's second level has tens of MiB, and a launch must not count.
inline std::size_t stream_bytes(const taut::device& d)
{
    return std::size_t{d.is_cpu() ? 64u : 512u} << 20;
}

/// What the device's commands cost the host.
struct command_seconds
{
    double launch; ///< of one kernel that does nothing, of a thousand in a row
    double wait;   ///< of one such kernel and a wait for its end
    double read;   ///< of one such kernel and a read of one number
};

inline command_seconds measure_commands(taut::queue& q)
{
    const auto nothing =
        q.kernel<taut::buffer<float>>("__kernel void nothing(__global float* a) { a[0] = 0; }", "nothing");
    taut::buffer<float> a(q, 64);
    const auto median = [&](int runs, auto&& work)
    {
        std::vector<double> times;
        for (int r = 0; r <= runs; ++r)
        {
            q.finish();
            times.push_back(seconds(work));
        }
        std::nth_element(times.begin(), times.begin() + runs / 2, times.end());
        return times[static_cast<std::size_t>(runs / 2)];
    };
    const auto launch = [&] { nothing(taut::range(1, 1), a); };
    constexpr int many = 1000;
    return {median(5,
                   [&]
                   {
                       for (int i = 0; i < many; ++i) launch();
                       q.finish();
                   }) /
                many,
            median(100,
                   [&]
                   {
                       launch();
                       q.finish();
                   }),
            median(100,
                   [&]
                   {
                       launch();
                       a.download();
                   })};
}

/// The bandwidth of the device's memory in bytes a second: STREAM's triad on arrays of 64 MiB, the best of some runs,
/// as STREAM has it. In float, which every device has: a byte is a byte.
inline double device_triad(taut::queue& q, std::size_t bytes, int runs = 10)
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

inline double device_triad(taut::queue& q)
{
    return device_triad(q, stream_bytes(q.device()));
}

} // namespace bench
