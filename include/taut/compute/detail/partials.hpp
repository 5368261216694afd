// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstddef>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <taut/compute/kernel.hpp>

namespace taut::detail
{

/// The partial results of a round of reductions: double on the device, float where it has no fp64, double on the host.
class partials
{
public:
    explicit partials(const queue& q) : queue_(q), wide_(q.device().has_fp64()) {}

    bool wide() const noexcept { return wide_; }
    std::size_t used() const noexcept { return used_; }
    void clear() noexcept { used_ = 0; }

    /// The place of count more partials. Growing keeps what commands on their way will have written.
    std::size_t reserve(std::size_t count)
    {
        if (wide_)
            grow(doubles_, used_ + count);
        else
            grow(floats_, used_ + count);
        used_ += count;
        return used_ - count;
    }

    /// Blocks for all commands before it.
    std::span<const double> fetch()
    {
        host_.resize(used_);
        if (wide_)
            doubles_.download(std::span(host_));
        else
        {
            std::vector<float> narrow(used_);
            floats_.download(std::span(narrow));
            std::copy(narrow.begin(), narrow.end(), host_.begin());
        }
        return host_;
    }

    cl_mem native() const noexcept { return wide_ ? doubles_.native() : floats_.native(); }

private:
    template <class Sum>
    void grow(buffer<Sum>& present, std::size_t needed)
    {
        if (present.size() >= needed) return;
        buffer<Sum> larger(queue_, std::max<std::size_t>(2 * needed, 1024));
        larger.copy_from(present);
        present = std::move(larger);
    }

    queue queue_;
    bool wide_;
    buffer<double> doubles_;
    buffer<float> floats_;
    std::size_t used_ = 0;
    std::vector<double> host_;
};

inline void set_argument(const queue_state& state, cl_kernel kernel, const std::string& name, cl_uint i,
                         const partials& p)
{
    const cl_mem memory = p.native();
    if (clSetKernelArg(kernel, i, sizeof memory, &memory) != CL_SUCCESS)
        state.fail("argument " + std::to_string(i) + " of " + name, "the partials were refused");
}

} // namespace taut::detail
