// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <initializer_list>
#include <string>
#include <string_view>
#include <utility>

#include <taut/impl/core/compute/program/own_program.hpp>
#include <taut/impl/core/core/padded.hpp> // ranges
#include <taut/kernel.hpp>

namespace taut::impl
{

/// A kernel of taut's own, and one that was recorded, in a program of that source. Throw as constructors of kernel.
kernel make_kernel(queue& q, const own_program& program, const std::string& name);
kernel make_kernel(queue& q, const kernel_text& recorded, const std::string& source);

/// A double as a number of a type: float or double.
inline argument number_of(std::string_view type, double value)
{
    argument number(value);
    number.narrow_to(type);
    return number;
}

/// A kernel that is built when it is first launched: until then its program may be built elsewhere.
class late_kernel
{
public:
    late_kernel() = default;
    explicit late_kernel(std::function<kernel()> build) : build_(std::move(build)) {}

    event operator()(range r, std::initializer_list<named_argument> arguments) const;

private:
    std::function<kernel()> build_;
    mutable kernel built_;
};

} // namespace taut::impl
