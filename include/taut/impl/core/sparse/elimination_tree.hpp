// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include <taut/types.hpp>

namespace taut::impl
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
    elimination_tree(std::span<const idx> offset, std::span<const idx> column);

    const std::vector<elimination_front>& fronts() const { return fronts_; }

private:
    static std::size_t u(idx i) { return static_cast<std::size_t>(i); }

    /// Eliminated fronts that hold a variable, by their pivot's name. They and its variables share what its neighbours
    /// took in the beginning: with each front that comes a variable goes, or another front.
    std::span<idx> elements(std::size_t i) { return {lists_.data() + offset_[i], u(elements_[i])}; }
    /// The remaining original neighbours of a variable.
    std::span<idx> variables(std::size_t i)
    {
        return {lists_.data() + offset_[i + 1] - variables_[i], u(variables_[i])};
    }
    void forget_neighbours(std::size_t i) { elements_[i] = variables_[i] = 0; }

    void enqueue(std::size_t i);

    void dequeue(std::size_t i);

    /// Eliminates supervariable p; returns how many variables went, lowers `lowest` to the least new degree.
    std::size_t eliminate(std::size_t p, std::size_t left, std::size_t& lowest);

    /// The border of a front: what p's own edges and the elements around it reach. Those elements are swallowed.
    /// Returns the number of its variables.
    std::size_t reach_border(std::size_t p, elimination_front& front);

    /// outside_[e]: variables of element e that are not in the border, for every element that meets it.
    void count_outside();

    /// Leaves of the neighbours of a variable of the border those beyond it. Returns how many variables these are, and
    /// a hash of the neighbourhood.
    std::pair<std::size_t, std::uint64_t> prune(std::size_t i, std::size_t p, elimination_front& front);

    void swallow(elimination_front& front, idx e);

    /// Puts the members of one supervariable behind those of another.
    void take(std::size_t to, std::size_t from);

    void append_members(std::vector<idx>& to, idx i) const
    {
        for (; i >= 0; i = next_member_[u(i)]) to.push_back(i);
    }

    /// Merges variables of the border whose remaining neighbourhoods are the same set.
    void merge_equal();

    void postorder();

    std::size_t n_;
    std::vector<idx> lists_;                     // of each variable, at its offset: elements, and at the end variables
    std::span<const idx> offset_;                // of the constructor, and not read after it
    std::vector<idx> elements_, variables_;      // how many there are
    std::vector<std::size_t> size_;              // members of a supervariable; 0: merged or eliminated
    std::vector<std::size_t> degree_;            // of a variable: bound on its border; of an element: its border's size
    std::vector<idx> next_member_, last_member_; // lists of the members of supervariables
    std::vector<idx> next_, previous_, head_;    // doubly linked lists of variables by degree
    std::vector<idx> mark_;
    std::vector<std::size_t> outside_;
    std::vector<idx> outside_stamp_;
    std::vector<idx> front_of_;                         // live element -> its front
    std::vector<idx> border_;                           // of the front that is made
    std::vector<std::pair<std::uint64_t, idx>> hashes_; // of its variables' neighbourhoods
    std::vector<elimination_front> fronts_;
    idx stamp_ = 0;
};

} // namespace taut::impl
