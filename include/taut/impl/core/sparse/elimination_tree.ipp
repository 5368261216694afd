// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>

#include <taut/impl/core/sparse/elimination_tree.hpp>

namespace taut::impl
{

elimination_tree::elimination_tree(std::span<const idx> offset, std::span<const idx> column)
    : n_(offset.size() - 1),
      lists_(column.begin(), column.end()),
      offset_(offset),
      elements_(n_, 0),
      variables_(n_),
      size_(n_, 1),
      degree_(n_),
      next_member_(n_, -1),
      last_member_(n_),
      next_(n_, -1),
      previous_(n_, -1),
      head_(n_ + 1, -1),
      mark_(n_, 0),
      outside_(n_, 0),
      outside_stamp_(n_, 0),
      front_of_(n_, -1)
{
    for (std::size_t i = 0; i < n_; ++i)
    {
        variables_[i] = offset[i + 1] - offset[i];
        last_member_[i] = static_cast<idx>(i);
        degree_[i] = u(variables_[i]);
    }
    for (std::size_t i = n_; i-- > 0;) enqueue(i);
    for (std::size_t left = n_, lowest = 0; left > 0;)
    {
        while (head_[lowest] < 0) ++lowest;
        const auto p = static_cast<std::size_t>(head_[lowest]);
        dequeue(p);
        left -= eliminate(p, left, lowest);
    }
    postorder();
}

void elimination_tree::enqueue(std::size_t i)
{
    auto& head = head_[degree_[i]];
    next_[i] = head;
    previous_[i] = -1;
    if (head >= 0) previous_[u(head)] = static_cast<idx>(i);
    head = static_cast<idx>(i);
}

void elimination_tree::dequeue(std::size_t i)
{
    if (next_[i] >= 0) previous_[u(next_[i])] = previous_[i];
    (previous_[i] >= 0 ? next_[u(previous_[i])] : head_[degree_[i]]) = next_[i];
}

std::size_t elimination_tree::reach_border(std::size_t p, elimination_front& front)
{
    const idx stamp = ++stamp_;
    mark_[p] = stamp;
    border_.clear();
    const auto reach = [&](std::span<const idx> from)
    {
        for (const idx i : from)
            if (size_[u(i)] > 0 && mark_[u(i)] != stamp)
            {
                mark_[u(i)] = stamp;
                border_.push_back(i);
            }
    };
    reach(variables(p));
    for (const idx e : elements(p))
    {
        reach(fronts_[u(front_of_[u(e)])].border);
        swallow(front, e);
    }
    std::size_t border_size = 0;
    for (const idx i : border_)
    {
        dequeue(u(i));
        border_size += size_[u(i)];
    }
    return border_size;
}

void elimination_tree::count_outside()
{
    for (const idx i : border_)
        for (const idx e : elements(u(i)))
        {
            if (front_of_[u(e)] < 0) continue;
            if (outside_stamp_[u(e)] != stamp_)
            {
                outside_stamp_[u(e)] = stamp_;
                outside_[u(e)] = degree_[u(e)];
            }
            outside_[u(e)] -= size_[u(i)];
        }
}

std::pair<std::size_t, std::uint64_t> elimination_tree::prune(std::size_t i, std::size_t p, elimination_front& front)
{
    std::size_t outer = 0;
    std::uint64_t hash = static_cast<std::uint64_t>(p);
    const auto around = elements(i);
    idx kept = 0;
    for (const idx e : around)
    {
        if (front_of_[u(e)] < 0) continue;
        if (outside_[u(e)] == 0)
        {
            swallow(front, e); // it lies within the new element
            continue;
        }
        outer += outside_[u(e)];
        hash += static_cast<std::uint64_t>(e);
        around[u(kept++)] = e;
    }
    elements_[i] = kept;
    const auto near = variables(i);
    std::size_t first = near.size(); // of what is kept
    for (std::size_t k = near.size(); k-- > 0;)
    {
        const idx j = near[k];
        if (size_[u(j)] == 0 || mark_[u(j)] == stamp_) continue;
        outer += size_[u(j)];
        hash += static_cast<std::uint64_t>(j);
        near[--first] = j;
    }
    variables_[i] = static_cast<idx>(near.size() - first);
    return {outer, hash};
}

std::size_t elimination_tree::eliminate(std::size_t p, std::size_t left, std::size_t& lowest)
{
    elimination_front front;
    const auto self = static_cast<idx>(p);
    std::size_t border_size = reach_border(p, front);
    count_outside();

    std::size_t gone = size_[p];
    size_[p] = 0;
    hashes_.clear();
    for (const idx i : border_)
    {
        const auto [outer, hash] = prune(u(i), p, front);
        if (outer == 0) // nothing beyond this front: goes with it
        {
            gone += size_[u(i)];
            border_size -= size_[u(i)];
            size_[u(i)] = 0;
            take(p, u(i));
            continue;
        }
        lists_[u(offset_[u(i)] + elements_[u(i)]++)] = self;
        degree_[u(i)] = std::min(degree_[u(i)], outer); // completed below, once the border's size is known
        hashes_.emplace_back(hash, i);
    }
    merge_equal();

    front.border.reserve(border_size);
    for (const idx i : border_)
    {
        if (size_[u(i)] == 0) continue;
        append_members(front.border, i);
        degree_[u(i)] = std::min(degree_[u(i)] + border_size - size_[u(i)], left - gone - size_[u(i)]);
        lowest = std::min(lowest, degree_[u(i)]);
        enqueue(u(i));
    }
    degree_[p] = border_size;
    front.pivots.reserve(gone);
    append_members(front.pivots, self);
    front_of_[p] = static_cast<idx>(fronts_.size());
    fronts_.push_back(std::move(front));
    forget_neighbours(p);
    return gone;
}

void elimination_tree::swallow(elimination_front& front, idx e)
{
    front.children.push_back(front_of_[u(e)]);
    front_of_[u(e)] = -1;
}

void elimination_tree::take(std::size_t to, std::size_t from)
{
    next_member_[u(last_member_[to])] = static_cast<idx>(from);
    last_member_[to] = last_member_[from];
}

void elimination_tree::merge_equal()
{
    std::sort(hashes_.begin(), hashes_.end());
    for (std::size_t a = 0; a < hashes_.size(); ++a)
    {
        const std::size_t i = u(hashes_[a].second);
        if (size_[i] == 0) continue;
        bool marked = false;
        for (std::size_t b = a + 1; b < hashes_.size() && hashes_[b].first == hashes_[a].first; ++b)
        {
            const std::size_t j = u(hashes_[b].second);
            if (size_[j] == 0 || variables_[i] != variables_[j] || elements_[i] != elements_[j]) continue;
            if (!marked)
            {
                ++stamp_;
                for (const idx v : variables(i)) mark_[u(v)] = stamp_;
                for (const idx e : elements(i)) mark_[u(e)] = stamp_; // elements and variables: other names
                marked = true;
            }
            const auto all_marked = [this](std::span<const idx> names)
            { return std::all_of(names.begin(), names.end(), [this](idx k) { return mark_[u(k)] == stamp_; }); };
            if (!all_marked(variables(j)) || !all_marked(elements(j))) continue;
            size_[i] += size_[j];
            size_[j] = 0;
            take(i, j);
            forget_neighbours(j);
        }
    }
}

void elimination_tree::postorder()
{
    std::vector<char> is_child(fronts_.size(), 0);
    for (const auto& f : fronts_)
        for (const idx c : f.children) is_child[u(c)] = 1;
    std::vector<elimination_front> ordered;
    ordered.reserve(fronts_.size());
    std::vector<idx> place(fronts_.size(), -1);
    std::vector<std::pair<idx, std::size_t>> path;
    for (std::size_t root = 0; root < fronts_.size(); ++root)
    {
        if (is_child[root]) continue;
        path.emplace_back(static_cast<idx>(root), 0);
        while (!path.empty())
        {
            auto& [f, done] = path.back();
            auto& front = fronts_[u(f)];
            if (done < front.children.size())
            {
                path.emplace_back(front.children[done++], 0);
                continue;
            }
            for (idx& c : front.children) c = place[u(c)];
            place[u(f)] = static_cast<idx>(ordered.size());
            ordered.push_back(std::move(front));
            path.pop_back();
        }
    }
    fronts_ = std::move(ordered);
}

} // namespace taut::impl
