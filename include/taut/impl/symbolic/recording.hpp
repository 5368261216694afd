// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include <taut/impl/symbolic/array.hpp>
#include <taut/impl/symbolic/emit.hpp>

namespace taut
{

/// A kernel being traced: its tape, current for the calling thread as long as the recording lives, and its arguments
/// in the order in which they are declared. Pure text: no device is involved.
///
///     recording r;
///     const auto x = r.in<double>("x");
///     const auto y = r.inout<double>("y");
///     const auto a = r.scalar<double>("a");
///     const auto i = r.global_id();
///     y[i] = a * x[i] + y[i];
///     const kernel_text text = r.finish("axpy");
///
/// Assumptions of the kernel: arguments do not overlap in memory, and no work-item reads what another one writes.
/// A loop of the host is unrolled, an `if` of the host decides now; for the device's own there are sum_over and select.
class recording
{
public:
    /// real: the type of constants of sym<double>, for a kernel whose formulas are in float.
    explicit recording(scalar_type real = scalar_type::f64);

    /// Declares a pointer argument. A name is a C identifier, distinct from the others and not of the form t0, i0 or
    /// taut_x; an empty one becomes a0, a1, ... by position. Throws parameter_error for any other.
    /// type: of the numbers in memory. Doubles may be f32 there; what is loaded is then a sym<double> in float, and so
    /// is all that is computed from it.
    template <impl::traceable T>
    impl::in_array<T> in(std::string_view name = {}, scalar_type type = impl::scalar_type_of<T>)
    {
        return impl::in_array<T>(declare(name, impl::argument_kind::in, type), type);
    }

    template <impl::traceable T>
    impl::out_array<T> out(std::string_view name = {}, scalar_type type = impl::scalar_type_of<T>)
    {
        return impl::out_array<T>(declare(name, impl::argument_kind::out, type), type);
    }

    template <impl::traceable T>
    impl::inout_array<T> inout(std::string_view name = {}, scalar_type type = impl::scalar_type_of<T>)
    {
        return impl::inout_array<T>(declare(name, impl::argument_kind::inout, type), type);
    }

    /// Declares a number that may change from launch to launch, unlike a captured host value, which becomes a literal.
    template <impl::traceable T>
    sym<T> scalar(std::string_view name = {}, scalar_type type = impl::scalar_type_of<T>)
    {
        const std::uint32_t position = declare(name, impl::argument_kind::scalar, type);
        return sym<T>::of(tape_.intern({.op = impl::opcode::argument, .type = type, .payload = position}));
    }

    /// The number of the work-item along dimension 0, 1 or 2 of the range.
    sym<idx> global_id(unsigned dimension = 0);

    const std::vector<impl::kernel_argument>& arguments() const noexcept { return arguments_; }
    const tape& recorded() const noexcept { return tape_; }

    /// The kernel as recorded so far. Its form depends on the device; see kernel_form.
    impl::kernel_text finish(std::string name, impl::kernel_form form = impl::kernel_form::item,
                             impl::kernel_use use = impl::kernel_use::often) const;

private:
    std::uint32_t declare(std::string_view name, impl::argument_kind kind, scalar_type type);

    /// Names go into the text as they are; what the emitter makes up itself must stay free.
    static void require_identifier(const std::string& name);

    tape tape_;
    tape_scope scope_; // after the tape, as it must go first
    std::vector<impl::kernel_argument> arguments_;
};

} // namespace taut

#ifdef TAUT_IMPLEMENTATION
#include <taut/impl/symbolic/recording.ipp>
#endif
