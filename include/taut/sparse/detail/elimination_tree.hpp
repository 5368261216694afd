// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include <taut/core/types.hpp>

namespace taut::detail
{

/// One dense step of a sparse elimination: `pivots` are eliminated together; what they touch later is `border`.
struct elimination_front
{
    std::vector<idx> pivots;
    std::vector<idx> border;
    std::vector<idx> children; ///< fronts whose border lies in this front's variables
};

/// Orders the elimination of a symmetric sparse pattern by approximate minimum degree on the quotient graph (Amestoy,
/// Davis, Duff 1996): an eliminated front is kept as one element, so that fill is never stored; variables with equal
/// neighbourhoods are merged. Returns fronts, children before parents and next to each other (postorder).
class elimination_tree
{
public:
    /// offset, column: CSR of the pattern, no diagonal, symmetric.
    elimination_tree(std::span<const idx> offset, std::span<const idx> column)
        : n_(offset.size() - 1),
          variables_(n_),
          elements_(n_),
          size_(n_, 1),
          degree_(n_),
          members_(n_),
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
            variables_[i].assign(column.begin() + offset[i], column.begin() + offset[i + 1]);
            members_[i] = {static_cast<idx>(i)};
            degree_[i] = variables_[i].size();
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

    const std::vector<elimination_front>& fronts() const { return fronts_; }

private:
    static std::size_t u(idx i) { return static_cast<std::size_t>(i); }

    void enqueue(std::size_t i)
    {
        auto& head = head_[degree_[i]];
        next_[i] = head;
        previous_[i] = -1;
        if (head >= 0) previous_[u(head)] = static_cast<idx>(i);
        head = static_cast<idx>(i);
    }

    void dequeue(std::size_t i)
    {
        if (next_[i] >= 0) previous_[u(next_[i])] = previous_[i];
        (previous_[i] >= 0 ? next_[u(previous_[i])] : head_[degree_[i]]) = next_[i];
    }

    /// Eliminates supervariable p; returns how many variables went, lowers `lowest` to the least new degree.
    std::size_t eliminate(std::size_t p, std::size_t left, std::size_t& lowest)
    {
        // The border: what p's own edges and the elements around it reach. Those elements are swallowed.
        elimination_front front;
        const auto self = static_cast<idx>(p);
        const idx stamp = ++stamp_;
        mark_[p] = stamp;
        std::vector<idx> border;
        const auto reach = [&](const std::vector<idx>& from)
        {
            for (const idx i : from)
                if (size_[u(i)] > 0 && mark_[u(i)] != stamp)
                {
                    mark_[u(i)] = stamp;
                    border.push_back(i);
                }
        };
        reach(variables_[p]);
        for (const idx e : elements_[p])
        {
            reach(fronts_[u(front_of_[u(e)])].border);
            swallow(front, e);
        }
        std::size_t border_size = 0;
        for (const idx i : border)
        {
            dequeue(u(i));
            border_size += size_[u(i)];
        }

        // outside_[e]: variables of element e that are not in the border, for every element that meets it.
        for (const idx i : border)
            for (const idx e : elements_[u(i)])
            {
                if (front_of_[u(e)] < 0) continue;
                if (outside_stamp_[u(e)] != stamp)
                {
                    outside_stamp_[u(e)] = stamp;
                    outside_[u(e)] = degree_[u(e)];
                }
                outside_[u(e)] -= size_[u(i)];
            }

        std::size_t gone = size_[p];
        size_[p] = 0;
        std::vector<std::pair<std::uint64_t, idx>> hashes;
        for (const idx i : border)
        {
            auto& near = variables_[u(i)];
            auto& around = elements_[u(i)];
            std::size_t outer = 0;
            std::uint64_t hash = static_cast<std::uint64_t>(p);
            std::size_t kept = 0;
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
                around[kept++] = e;
            }
            around.resize(kept);
            kept = 0;
            for (const idx j : near)
            {
                if (size_[u(j)] == 0 || mark_[u(j)] == stamp) continue;
                outer += size_[u(j)];
                hash += static_cast<std::uint64_t>(j);
                near[kept++] = j;
            }
            near.resize(kept);
            if (outer == 0) // nothing beyond this front: goes with it
            {
                gone += size_[u(i)];
                border_size -= size_[u(i)];
                size_[u(i)] = 0;
                take(members_[p], members_[u(i)]);
                continue;
            }
            around.push_back(self);
            degree_[u(i)] = std::min(degree_[u(i)], outer); // completed below, once the border's size is known
            hashes.emplace_back(hash, i);
        }
        merge_equal(hashes);

        for (const idx i : border)
        {
            if (size_[u(i)] == 0) continue;
            front.border.insert(front.border.end(), members_[u(i)].begin(), members_[u(i)].end());
            degree_[u(i)] = std::min(degree_[u(i)] + border_size - size_[u(i)], left - gone - size_[u(i)]);
            lowest = std::min(lowest, degree_[u(i)]);
            enqueue(u(i));
        }
        degree_[p] = border_size;
        front.pivots = std::move(members_[p]);
        front_of_[p] = static_cast<idx>(fronts_.size());
        fronts_.push_back(std::move(front));
        variables_[p] = {};
        elements_[p] = {};
        return gone;
    }

    void swallow(elimination_front& front, idx e)
    {
        front.children.push_back(front_of_[u(e)]);
        front_of_[u(e)] = -1;
    }

    static void take(std::vector<idx>& to, std::vector<idx>& from)
    {
        to.insert(to.end(), from.begin(), from.end());
        from = {};
    }

    /// Merges variables of the border whose remaining neighbourhoods are the same set.
    void merge_equal(std::vector<std::pair<std::uint64_t, idx>>& hashes)
    {
        std::sort(hashes.begin(), hashes.end());
        for (std::size_t a = 0; a < hashes.size(); ++a)
        {
            const idx i = hashes[a].second;
            if (size_[u(i)] == 0) continue;
            bool marked = false;
            for (std::size_t b = a + 1; b < hashes.size() && hashes[b].first == hashes[a].first; ++b)
            {
                const idx j = hashes[b].second;
                if (size_[u(j)] == 0 || variables_[u(i)].size() != variables_[u(j)].size() ||
                    elements_[u(i)].size() != elements_[u(j)].size())
                    continue;
                if (!marked)
                {
                    ++stamp_;
                    for (const idx v : variables_[u(i)]) mark_[u(v)] = stamp_;
                    for (const idx e : elements_[u(i)]) mark_[u(e)] = stamp_; // elements and variables: other names
                    marked = true;
                }
                const auto same = [this](idx k) { return mark_[u(k)] == stamp_; };
                if (!std::all_of(variables_[u(j)].begin(), variables_[u(j)].end(), same) ||
                    !std::all_of(elements_[u(j)].begin(), elements_[u(j)].end(), same))
                    continue;
                size_[u(i)] += size_[u(j)];
                size_[u(j)] = 0;
                take(members_[u(i)], members_[u(j)]);
                variables_[u(j)] = {};
                elements_[u(j)] = {};
            }
        }
    }

    void postorder()
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

    std::size_t n_;
    std::vector<std::vector<idx>> variables_; // remaining original neighbours
    std::vector<std::vector<idx>> elements_;  // eliminated fronts that hold the variable, by their pivot's name
    std::vector<std::size_t> size_;           // members of a supervariable; 0: merged or eliminated
    std::vector<std::size_t> degree_;         // of a variable: bound on its border; of an element: its border's size
    std::vector<std::vector<idx>> members_;
    std::vector<idx> next_, previous_, head_; // doubly linked lists of variables by degree
    std::vector<idx> mark_;
    std::vector<std::size_t> outside_;
    std::vector<idx> outside_stamp_;
    std::vector<idx> front_of_; // live element -> its front
    std::vector<elimination_front> fronts_;
    idx stamp_ = 0;
};

} // namespace taut::detail
