// SPDX-License-Identifier: MIT
#pragma once

#include <type_traits>

#include <taut/impl/symbolic/sym.hpp>

namespace taut
{

/// A traced value in another precision: positions stay double, an element's formula may be float. It is always
/// explicit. Derivatives pass through, in the type of each side. To an integer it truncates towards zero, and outside
/// of the integer's range the device's result is undefined.
template <impl::traceable To, impl::traceable From>
sym<To> cast(sym<From> x)
{
    return sym<To>::of(impl::build(tape::current(), impl::opcode::cast, impl::scalar_type_of<To>, x.id()));
}

/// A traced real number in a precision that is chosen when the kernel is recorded: f32 or f64.
inline sym<double> cast(scalar_type to, sym<double> x)
{
    return sym<double>::of(impl::build(tape::current(), impl::opcode::cast, to, x.id()));
}

/// The same on the host, for code that is a template on its scalar.
template <impl::traceable To, class From>
    requires std::is_arithmetic_v<From>
constexpr To cast(From x) noexcept
{
    return static_cast<To>(x);
}

} // namespace taut
