// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <utility>

#include <taut/impl/symbolic/sym.hpp>

namespace taut
{

/// The sum of summand(k) for k = begin, ..., end - 1, in this order: a loop of the kernel, for counts that are known
/// only there, as the row of a sparse matrix (a `for` of the host is unrolled instead). Empty ranges give 0.
///
/// `summand` maps a sym<idx> to a sym<T>. What it loads is loaded inside of the loop; what it computes without k is
/// computed once. It cannot store, values cannot leave it but as the sum, and there is no derivative through it.
template <class F>
auto sum_over(sym<idx> begin, sym<idx> end, F&& summand)
{
    tape& t = tape::current();
    using result = decltype(+std::forward<F>(summand)(sym<idx>())); // a proxy becomes its value

    struct open_loop // closes also when the summand throws
    {
        explicit open_loop(tape& on) : t(on), index_node(on.open_loop()) {}
        ~open_loop() { t.close_loop(); }
        open_loop(const open_loop&) = delete;
        open_loop& operator=(const open_loop&) = delete;
        tape& t;
        impl::node_id index_node;
    };

    const impl::node_id first = begin.id();
    const impl::node_id last = end.id();
    impl::node_id term = impl::no_node;
    impl::node_id loop = impl::no_node;
    {
        const open_loop body(t);
        loop = body.index_node;
        const result r = std::forward<F>(summand)(sym<idx>::of(loop));
        term = r.id();
    }
    return result::of(t.intern({.op = impl::opcode::loop_sum,
                                .type = t[term].type,
                                .operands = {first, last, term},
                                .payload = static_cast<std::uint64_t>(loop)}));
}

} // namespace taut
