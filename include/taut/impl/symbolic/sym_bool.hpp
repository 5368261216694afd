// SPDX-License-Identifier: MIT
#pragma once

#include <concepts>

#include <taut/impl/symbolic/build.hpp>

namespace taut
{

/// Result of comparing traced values. It is known only when the kernel runs, so it combines with && || ! and steers
/// select(), never an `if` of the host.
class sym_bool
{
public:
    sym_bool() = default;

    template <std::same_as<bool> B>
    sym_bool(B value) : id_(tape::current().constant(value))
    {
    }

    static sym_bool of(impl::node_id id) noexcept
    {
        sym_bool s;
        s.id_ = id;
        return s;
    }

    impl::node_id id() const noexcept { return id_; }

    /// Always an error; it exists in order to explain itself.
    template <class B>
        requires std::same_as<B, bool>
    operator B() const
    {
        static_assert(!std::same_as<B, bool>,
                      "taut: a comparison of traced values is known only when the kernel runs, so it cannot steer "
                      "`if`, `while` or `?:` while the kernel is being recorded; use select(cond, a, b)");
        return false;
    }

    /// !(a < b) is not a >= b: with NaN the first is true and the second is false.
    friend sym_bool operator!(sym_bool a)
    {
        return of(impl::build(tape::current(), impl::opcode::logical_not, scalar_type::boolean, a.id_));
    }

    /// Both sides are always computed: there is no short circuit in a recording.
    friend sym_bool operator&&(sym_bool a, sym_bool b)
    {
        return of(impl::build(tape::current(), impl::opcode::logical_and, scalar_type::boolean, a.id_, b.id_));
    }

    friend sym_bool operator||(sym_bool a, sym_bool b)
    {
        return of(impl::build(tape::current(), impl::opcode::logical_or, scalar_type::boolean, a.id_, b.id_));
    }

    // exact matches, for the built-in operators on bool are candidates, too
    friend sym_bool operator&&(sym_bool a, bool b) { return a && sym_bool(b); }
    friend sym_bool operator&&(bool a, sym_bool b) { return sym_bool(a) && b; }
    friend sym_bool operator||(sym_bool a, bool b) { return a || sym_bool(b); }
    friend sym_bool operator||(bool a, sym_bool b) { return sym_bool(a) || b; }

private:
    impl::node_id id_;
};

} // namespace taut
