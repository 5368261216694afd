// SPDX-License-Identifier: MIT
#pragma once

#include <taut/solve_params.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <functional>
#include <vector>

namespace taut::solve::impl
{

/// H0 of an objective: out = H0 v. Empty stands for the identity.
template <class Vector>
using preconditioner = std::function<void(const Vector& v, Vector& out)>;

/// A direction as the line search needs it.
struct direction_info
{
    double slope = 0;  ///< d'g
    double length = 0; ///< |d|
};

/// Inner products of a pair.
struct pair_products
{
    double sy = 0, yy = 0, ss = 0;
    double yhy = 0; ///< y'H0 y, which is y'y without a preconditioner
};

/// The pairs of L-BFGS in slots, one more than are kept: a trial pair is written to the spare slot and either becomes
/// the newest or is overwritten by the next.
template <vector_space Space>
class pair_memory
{
public:
    using vector = typename Space::vector;

    struct slot
    {
        vector s, y;
        pair_products products;
    };

    pair_memory(Space& space, const memory_params& params);

    int slots() const noexcept { return int(slots_.size()); }
    slot& operator[](int i) { return slots_[std::size_t(i)]; }
    const slot& operator[](int i) const { return slots_[std::size_t(i)]; }

    int spare() const noexcept { return spare_; }
    bool empty() const noexcept { return order_.empty(); }

    /// Slot numbers, oldest first.
    const std::vector<int>& order() const noexcept { return order_; }

    /// Those that the update formula uses: none where m = 0.
    const std::vector<int>& used() const noexcept { return params_.pairs == 0 ? none_ : order_; }

    void forget();

    /// The spare pair becomes the newest, unless its curvature is too small.
    bool keep(const pair_products& p);

    /// gamma; not for an empty memory.
    double scale() const;

private:
    memory_params params_;
    std::vector<slot> slots_;
    std::vector<int> order_, none_;
    int spare_ = 0;
};

template <vector_space Space>
pair_memory<Space>::pair_memory(Space& space, const memory_params& params) : params_(params)
{
    // The newest pair scales H0 even where none is kept (m = 0).
    const int count = std::max(params.pairs, 1) + 1;
    for (int i = 0; i < count; ++i) slots_.push_back({space.make(), space.make(), {}});
    forget();
}

template <vector_space Space>
void pair_memory<Space>::forget()
{
    order_.clear();
    spare_ = 0;
}

template <vector_space Space>
bool pair_memory<Space>::keep(const pair_products& p)
{
    if (!(p.sy > params_.cautious * std::sqrt(p.ss) * std::sqrt(p.yy)) || !(p.yhy > 0) || !std::isfinite(p.yhy))
        return false;
    slots_[std::size_t(spare_)].products = p;
    order_.push_back(spare_);
    if (int(order_.size()) < slots())
    {
        spare_ = int(order_.size()); // slots fill up in order after forget()
        return true;
    }
    spare_ = order_.front();
    order_.erase(order_.begin());
    return true;
}

template <vector_space Space>
double pair_memory<Space>::scale() const
{
    const auto of = [&](int i) { return (*this)[i].products.sy / (*this)[i].products.yhy; };
    const double newest = of(order_.back());
    return params_.scaling == scaling::newest ? newest : std::max(newest, of(order_.front()));
}

} // namespace taut::solve::impl
