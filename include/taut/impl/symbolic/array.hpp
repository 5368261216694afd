// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

#include <taut/impl/symbolic/cast.hpp>

namespace taut::impl
{

/// Stores in the type of the array.
inline void store(std::uint32_t argument, scalar_type type, sym<idx> at, node_id value)
{
    tape& t = tape::current();
    t.store(argument, at.id(), build(t, opcode::cast, type, value));
}

/// An element of an array that the kernel may read and write: converts to its traced value, and can be assigned.
/// Each conversion is a load as of that moment, so `auto r = y[i];` sees later stores, as a reference does.
///
/// It is a template on the traced type, not on the scalar, in order to bring the friends of sym<T> into view:
/// `x[i] * y[i]` and `sqrt(y[i])` then work on references.
template <class Sym>
class element_reference
{
public:
    element_reference(std::uint32_t argument, scalar_type type, sym<idx> at) noexcept
        : argument_(argument), type_(type), at_(at)
    {
    }
    element_reference(const element_reference&) = default;

    operator Sym() const { return load(); }

    Sym load() const { return Sym::of(tape::current().load(argument_, type_, at_.id())); }

    const element_reference& operator=(Sym x) const
    {
        impl::store(argument_, type_, at_, x.id());
        return *this;
    }

    /// y[i] = z[j] copies the element, as it does for numbers.
    const element_reference& operator=(const element_reference& other) const { return *this = other.load(); }
    element_reference& operator=(const element_reference& other)
    {
        static_cast<void>(std::as_const(*this) = other.load());
        return *this;
    }

    const element_reference& operator+=(Sym x) const { return *this = load() + x; }
    const element_reference& operator-=(Sym x) const { return *this = load() - x; }
    const element_reference& operator*=(Sym x) const { return *this = load() * x; }
    const element_reference& operator/=(Sym x) const { return *this = load() / x; }

private:
    std::uint32_t argument_;
    scalar_type type_;
    sym<idx> at_;
};

/// An element that the kernel only writes. It does not convert, so that reading an output does not compile.
template <class Sym>
class element_sink
{
public:
    element_sink(std::uint32_t argument, scalar_type type, sym<idx> at) noexcept
        : argument_(argument), type_(type), at_(at)
    {
    }
    element_sink(const element_sink&) = delete;

    const element_sink& operator=(Sym x) const
    {
        impl::store(argument_, type_, at_, x.id());
        return *this;
    }
    const element_sink& operator=(const element_sink&) const = delete;

private:
    std::uint32_t argument_;
    scalar_type type_;
    sym<idx> at_;
};

/// A pointer argument that the kernel only reads: x[i] is a traced value.
template <traceable T>
class in_array
{
public:
    /// type: of the numbers in memory; of doubles, it may be f32.
    explicit in_array(std::uint32_t argument, scalar_type type = scalar_type_of<T>) noexcept
        : argument_(argument), type_(type)
    {
    }
    sym<T> operator[](sym<idx> at) const { return sym<T>::of(tape::current().load(argument_, type_, at.id())); }

private:
    std::uint32_t argument_;
    scalar_type type_;
};

/// A pointer argument that the kernel only writes: x[i] = value. Reading it does not compile.
template <traceable T>
class out_array
{
public:
    /// type: of the numbers in memory; of doubles, it may be f32.
    explicit out_array(std::uint32_t argument, scalar_type type = scalar_type_of<T>) noexcept
        : argument_(argument), type_(type)
    {
    }
    element_sink<sym<T>> operator[](sym<idx> at) const { return {argument_, type_, at}; }

private:
    std::uint32_t argument_;
    scalar_type type_;
};

/// A pointer argument that the kernel reads and writes: y[i] = a * x[i] + y[i].
template <traceable T>
class inout_array
{
public:
    /// type: of the numbers in memory; of doubles, it may be f32.
    explicit inout_array(std::uint32_t argument, scalar_type type = scalar_type_of<T>) noexcept
        : argument_(argument), type_(type)
    {
    }
    element_reference<sym<T>> operator[](sym<idx> at) const { return {argument_, type_, at}; }

private:
    std::uint32_t argument_;
    scalar_type type_;
};

} // namespace taut::impl

namespace taut
{

/// Traced element of an array in another precision, cast<float>(y[i]): a template does not convert its argument.
template <impl::traceable To, class Sym>
sym<To> cast(const impl::element_reference<Sym>& x)
{
    return cast<To>(x.load());
}

} // namespace taut
