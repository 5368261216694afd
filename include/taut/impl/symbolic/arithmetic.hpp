// SPDX-License-Identifier: MIT
#pragma once

#include <concepts>

#include <taut/impl/symbolic/sym_bool.hpp>

namespace taut
{

template <impl::traceable T>
class sym;

} // namespace taut

namespace taut::impl
{

/// The operators of sym<T>, for sym<T> to inherit.
///
/// They are friends and no templates, which only an argument of type sym<T> brings into view: so literals and
/// proxies of array elements convert to sym<T>, and code that does not mention sym<T> never sees them. Two different
/// precisions do not mix: float + double is an error where it is written, not a slow kernel.
///
/// sym<double> may be in float all the same, where a recording chose so for its arrays (recording::in): precision is
/// then data, and an error of the recording where it is mixed.
template <class T>
struct sym_arithmetic
{
    friend sym<T> operator+(sym<T> a) { return a; }
    friend sym<T> operator-(sym<T> a) { return make(opcode::neg, a); }
    friend sym<T> operator+(sym<T> a, sym<T> b) { return make(opcode::add, a, b); }
    friend sym<T> operator-(sym<T> a, sym<T> b) { return make(opcode::sub, a, b); }
    friend sym<T> operator*(sym<T> a, sym<T> b) { return make(opcode::mul, a, b); }
    friend sym<T> operator/(sym<T> a, sym<T> b) { return make(opcode::div, a, b); }
    friend sym<T> operator%(sym<T> a, sym<T> b) requires std::integral<T> { return make(opcode::rem, a, b); }

    // The handle moves on to a new node; other copies of the old handle keep their value.
    friend sym<T>& operator+=(sym<T>& a, sym<T> b) { return a = a + b; }
    friend sym<T>& operator-=(sym<T>& a, sym<T> b) { return a = a - b; }
    friend sym<T>& operator*=(sym<T>& a, sym<T> b) { return a = a * b; }
    friend sym<T>& operator/=(sym<T>& a, sym<T> b) { return a = a / b; }

    // > and >= have no node of their own: a > b is b < a, also for NaN.
    friend sym_bool operator<(sym<T> a, sym<T> b) { return compare(opcode::less, a, b); }
    friend sym_bool operator>(sym<T> a, sym<T> b) { return compare(opcode::less, b, a); }
    friend sym_bool operator<=(sym<T> a, sym<T> b) { return compare(opcode::less_equal, a, b); }
    friend sym_bool operator>=(sym<T> a, sym<T> b) { return compare(opcode::less_equal, b, a); }
    friend sym_bool operator==(sym<T> a, sym<T> b) { return compare(opcode::equal, a, b); }
    friend sym_bool operator!=(sym<T> a, sym<T> b) { return compare(opcode::not_equal, a, b); }

    /// cond ? a : b, without a branch: both are computed, one is taken, and only the taken one has a derivative.
    friend sym<T> select(sym_bool cond, sym<T> a, sym<T> b)
    {
        tape& t = tape::current();
        node_id yes = a.id(), no = b.id();
        const scalar_type type = shared_type(t, yes, no);
        return sym<T>::of(build(t, opcode::select, type, cond.id(), yes, no));
    }

protected:
    static sym<T> make(opcode op, sym<T> a)
    {
        tape& t = tape::current();
        return sym<T>::of(build(t, op, t[a.id()].type, a.id()));
    }

    static sym<T> make(opcode op, sym<T> a, sym<T> b)
    {
        tape& t = tape::current();
        node_id left = a.id(), right = b.id();
        const scalar_type type = shared_type(t, left, right);
        return sym<T>::of(build(t, op, type, left, right));
    }

private:
    static sym_bool compare(opcode op, sym<T> a, sym<T> b)
    {
        tape& t = tape::current();
        node_id left = a.id(), right = b.id();
        shared_type(t, left, right);
        return sym_bool::of(build(t, op, scalar_type::boolean, left, right));
    }
};

} // namespace taut::impl
