// SPDX-License-Identifier: MIT
#include <taut/impl/enter.inl>
#ifndef TAUT_SYMBOLIC_HPP
#define TAUT_SYMBOLIC_HPP

#include <concepts>
#include <cstdint>
#include <initializer_list>
#include <span>
#include <type_traits>
#include <utility>
#include <vector>

#include <taut/errors.hpp>
#include <taut/impl/core/symbolic/build.hpp>
#include <taut/types.hpp>

/// Traced scalars: a function that is a template on its scalar computes with double, and records itself with
/// sym<double>. Recordings are differentiated, evaluated, and printed as kernels (<taut/recording.hpp>).
///
///     tape t;
///     const tape_scope scope(t);
///     const auto x = sym<double>::variable(), y = sym<double>::variable();
///     const auto f = x * x + sin(y);
///     const auto g = differentiate(f, {x, y});                    // 2 x, cos y
///     const double fx = evaluate(g[0], {{x, 3.0}, {y, 0.0}});     // 6
///
/// All errors are tape_error. <taut/traced_vectors.hpp> has the vectors and matrices of GLM on traced scalars.
namespace taut::impl
{

template <class T>
struct sym_arithmetic;

template <class T>
struct sym_math;

} // namespace taut::impl

namespace taut
{

/// A mistake in the use of traced values: no tape is current, a value left its loop, a derivative does not exist.
class tape_error : public error
{
public:
    using error::error;
};

/// A recording of scalar operations, as a graph: equal operations on equal operands are one node, so that a value that
/// looks exponential as a tree stays linear. It grows only, each node after its operands, and belongs to the thread
/// that records on it.
class tape : public impl::graph
{
public:
    /// The calling thread's tape. Throws tape_error if there is no tape_scope.
    static tape& current()
    {
        if (!current_) refuse("no tape: a sym was used outside of a recording; create a taut::tape_scope first");
        return *current_;
    }

private:
    friend class tape_scope;
    static inline thread_local constinit tape* current_ = nullptr;
};

/// Makes a tape the calling thread's current one for the lifetime of the scope; scopes nest.
class tape_scope
{
public:
    explicit tape_scope(tape& t) noexcept : outer_(std::exchange(tape::current_, &t)) {}
    ~tape_scope() { tape::current_ = outer_; }
    tape_scope(const tape_scope&) = delete;
    tape_scope& operator=(const tape_scope&) = delete;

private:
    tape* outer_;
};

/// A traced scalar: a handle to a node of the current tape. Copying is copying an integer. T is float, double or idx;
/// a sym<double> is in float where a recording chose so for its arrays.
///
/// Constants convert implicitly, and narrow to T silently (a double literal in a float kernel is a float literal).
/// Everything but copying needs a tape_scope; without one it throws tape_error. A handle is good on its own tape only.
///
/// Operators: + - * / (and % of integers), comparisons, select(). Functions, found by their argument: min max abs
/// floor sqrt cbrt exp log sin cos tan atan pow. Write `using std::sqrt;` first in code that takes plain numbers, too.
/// Powers with constant integer, half or third exponents become products and roots. float and double do not mix: cast.
template <impl::traceable T>
class sym : public impl::sym_arithmetic<T>, public impl::sym_math<T>
{
public:
    using value_type = T;

    /// Trivial, as GLM's unions need: `sym<T> x;` has no value yet, `sym<T> x{};` is zero.
    sym() = default;

    /// The constant. A traced integer takes integers only, of 32 bits.
    template <class A>
        requires(std::floating_point<A> || std::integral<A>)
    &&(std::floating_point<T> || std::integral<A>)sym(A value) : id_(constant(narrow(value))) {}

    /// A new independent variable.
    static sym variable() { return of(tape::current().variable(impl::scalar_type_of<T>)); }

    /// The handle of a node that exists; the caller vouches for its type.
    static sym of(idx node) noexcept
    {
        sym s;
        s.id_ = node;
        return s;
    }

    /// The number of the node on the current tape.
    idx id() const
    {
        return id_ == 0 ? constant(T(0)) : id_; // zero bytes stand for zero
    }

private:
    static idx constant(T value)
    {
        if constexpr (std::same_as<T, double>)
            return tape::current().real_constant(value);
        else
            return tape::current().constant(value);
    }

    template <class A>
    static T narrow(A value)
    {
        if constexpr (std::same_as<T, idx>)
            if (!std::in_range<idx>(value)) tape::refuse("an integer constant does not fit into 32 bits");
        return static_cast<T>(value);
    }

    idx id_;
};

/// Result of comparing traced values. It is known only when the kernel runs, so it combines with && || ! and steers
/// select(), never an `if` of the host. Both sides of && and || are computed. !(a < b) is not a >= b: with NaN the
/// first is true and the second is false.
class sym_bool
{
public:
    sym_bool() = default;

    template <std::same_as<bool> B>
    sym_bool(B value) : id_(tape::current().constant(value))
    {
    }

    static sym_bool of(idx node) noexcept
    {
        sym_bool s;
        s.id_ = node;
        return s;
    }

    idx id() const noexcept { return id_; }

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

    friend sym_bool operator!(sym_bool a) { return logic(impl::opcode::logical_not, a.id_); }
    friend sym_bool operator&&(sym_bool a, sym_bool b) { return logic(impl::opcode::logical_and, a.id_, b.id_); }
    friend sym_bool operator||(sym_bool a, sym_bool b) { return logic(impl::opcode::logical_or, a.id_, b.id_); }

    // exact matches, for the built-in operators on bool are candidates, too
    friend sym_bool operator&&(sym_bool a, bool b) { return a && sym_bool(b); }
    friend sym_bool operator&&(bool a, sym_bool b) { return sym_bool(a) && b; }
    friend sym_bool operator||(sym_bool a, bool b) { return a || sym_bool(b); }
    friend sym_bool operator||(bool a, sym_bool b) { return sym_bool(a) || b; }

private:
    static sym_bool logic(impl::opcode what, idx a, idx b = impl::no_node)
    {
        return of(impl::build(tape::current(), what, scalar_type::boolean, a, b));
    }

    idx id_;
};

/// A choice between two numbers of the host, which are constants of the kernel: cond ? a : b without a branch. Both are
/// computed, one is taken, and only the taken one has a derivative.
template <std::floating_point T>
sym<T> select(sym_bool cond, T a, T b);

/// A traced value in another precision: positions stay double, an element's formula may be float. It is always
/// explicit. Derivatives pass through, in the type of each side. To an integer it truncates towards zero; outside the
/// integer's range the device's result is undefined.
template <impl::traceable To, impl::traceable From>
sym<To> cast(sym<From> x);

/// A traced real number in a precision that is chosen when the kernel is recorded: f32 or f64.
inline sym<double> cast(scalar_type to, sym<double> x);

/// The same on the host, for code that is a template on its scalar.
template <impl::traceable To, class From>
    requires std::is_arithmetic_v<From>
constexpr To cast(From x) noexcept
{
    return static_cast<To>(x);
}

/// The sum of summand(k) for k = begin, ..., end - 1, in this order: a loop of the kernel, for counts that are known
/// only there, as the row of a sparse matrix (a `for` of the host is unrolled instead). Empty ranges give 0.
///
/// `summand` maps a sym<idx> to a sym<T>. Its loads stay inside the loop; what does not depend on k is computed once.
/// It cannot store, its values cannot leave it but as the sum, and the sum has no derivative.
template <class F>
auto sum_over(sym<idx> begin, sym<idx> end, F&& summand);

/// Partial derivatives of f by each x, in reverse mode: a few times the work of f, however many x there are (Griewank
/// and Walther, Evaluating Derivatives, chapter 3).
///
/// The x may be any nodes (variables, loads, intermediate values); each is treated as independent of the others. The
/// results are ordinary values, so differentiating them again gives second derivatives. A partial has the type of its
/// x. At a kink (select, abs) it is the derivative of the branch that the comparison takes. Throws tape_error if f
/// depends on x through sum_over.
template <class T, class X>
std::vector<sym<X>> differentiate(sym<T> f, std::span<const sym<X>> x);

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

/// A node and its value for evaluate(): usually a variable, but any node may be replaced (a load, an argument).
struct binding
{
    template <impl::traceable T>
    binding(sym<T> x, T value) : id(x.id()), bits(impl::to_bits(value))
    {
    }

    idx id;
    std::uint64_t bits; ///< the value's own bits, in the lowest of the 64
};

/// Value of a traced expression of the current tape: evaluate(f, {{x, 2.0}, {y, 3.0}}). Runs on the host, each
/// operation in its own precision: an oracle for kernels, which may contract products with sums. Loads need a binding.
/// Throws tape_error for an unbound leaf, and for integer operations without a result.
template <impl::traceable T>
T evaluate(sym<T> f, std::initializer_list<binding> bindings = {});

/// Several values at once, for bindings that a program collected.
template <impl::traceable T>
std::vector<T> evaluate(const std::vector<sym<T>>& outputs, std::span<const binding> bindings);

inline bool evaluate(sym_bool f, std::initializer_list<binding> bindings = {});

} // namespace taut

#include <taut/impl/core/symbolic/sym.hpp> // bodies

#endif
#include <taut/impl/leave.inl>
