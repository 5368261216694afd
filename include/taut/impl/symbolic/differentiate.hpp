// SPDX-License-Identifier: MIT
#pragma once

#include <initializer_list>
#include <span>
#include <vector>

#include <taut/impl/symbolic/reverse.hpp>
#include <taut/impl/symbolic/sym.hpp>

namespace taut
{

/// Partial derivatives of f by each x, in reverse mode: a few times the work of f, however many x there are.
///
/// The x may be any nodes (variables, loads, intermediate values); each is treated as independent of the others. The
/// results are ordinary values, so differentiating them again gives second derivatives. A partial has the type of its
/// x.
/// At a kink (select, abs) it is the derivative of the branch that the comparison takes. Throws tape_error if f
/// depends on x through sum_over.
template <class T, class X>
std::vector<sym<X>> differentiate(sym<T> f, std::span<const sym<X>> x)
{
    std::vector<impl::node_id> ids;
    ids.reserve(x.size());
    for (const sym<X> variable : x) ids.push_back(variable.id());

    std::vector<sym<X>> partials;
    partials.reserve(x.size());
    for (const impl::node_id partial : impl::reverse_sweep(tape::current(), f.id(), ids))
        partials.push_back(partial == impl::no_node ? sym<X>(X(0)) : sym<X>::of(partial));
    return partials;
}

template <class T, class X>
std::vector<sym<X>> differentiate(sym<T> f, const std::vector<sym<X>>& x)
{
    return differentiate(f, std::span<const sym<X>>(x));
}

template <class T, class X>
std::vector<sym<X>> differentiate(sym<T> f, std::initializer_list<sym<X>> x)
{
    return differentiate(f, std::span<const sym<X>>(x.begin(), x.size()));
}

/// Derivative of f by a single x.
template <class T, class X>
sym<X> differentiate(sym<T> f, sym<X> x)
{
    return differentiate(f, std::span<const sym<X>>(&x, 1)).front();
}

} // namespace taut
