// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstddef>
#include <span>
#include <utility>
#include <vector>

#include <taut/queue.hpp>

namespace taut::impl
{

/// The partial results of a round of reductions: double on the device, float where it has no fp64, double on the host.
class partials
{
public:
    explicit partials(const queue& q)
        : queue_(q), type_(q.device().has_fp64() ? scalar_type::f64 : scalar_type::f32), data_(queue_, type_, 0)
    {
    }

    std::size_t used() const noexcept { return used_; }
    void clear() noexcept { used_ = 0; }

    /// The place of count more partials. Growing keeps what commands on their way will have written.
    std::size_t reserve(std::size_t count)
    {
        if (data_.size() < used_ + count)
        {
            real_buffer larger(queue_, type_, std::max<std::size_t>(2 * (used_ + count), 1024));
            larger.copy_from(data_);
            data_ = std::move(larger);
        }
        used_ += count;
        return used_ - count;
    }

    /// Blocks for all commands before it.
    std::span<const double> fetch()
    {
        host_.resize(used_);
        data_.download(std::span(host_));
        return host_;
    }

    const real_buffer& data() const noexcept { return data_; }

private:
    queue queue_;
    scalar_type type_;
    real_buffer data_;
    std::size_t used_ = 0;
    std::vector<double> host_;
};

} // namespace taut::impl
