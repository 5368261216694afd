// SPDX-License-Identifier: MIT
#include <taut/impl/enter.inl>
#ifndef TAUT_RECORDING_HPP
#define TAUT_RECORDING_HPP

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <taut/symbolic.hpp>
#include <taut/types.hpp>

/// Kernels as they are recorded: arrays and numbers as traced arguments, and the OpenCL C that comes of it. No device
/// is involved; <taut/kernel.hpp> launches them.
namespace taut::impl
{

struct row_program;

} // namespace taut::impl

namespace taut
{

/// Use of an argument by a kernel.
enum class argument_kind : std::uint8_t
{
    in,     ///< a pointer that is only read
    out,    ///< a pointer that is only written
    inout,  ///< a pointer that is read and written
    scalar, ///< a number, the same for all work-items
};

/// One argument of a kernel, in the order of clSetKernelArg.
struct kernel_argument
{
    std::string name;
    argument_kind kind{};
    scalar_type type{};

    friend bool operator==(const kernel_argument&, const kernel_argument&) = default;
};

/// Distribution of `count` indices along dimension 0 over the work-items of a kernel.
enum class kernel_form : std::uint8_t
{
    item,    ///< one index each: the global size is the count
    guarded, ///< one index each, and those beyond the count return: for GPUs, where the global size is rounded up
    run,     ///< 256 consecutive indices each, in a loop that vectorises: for CPUs, with local size 1
    part,    ///< no kernel but a function, for kernels written by hand: indices taut_first, taut_first + taut_step, ...
             ///< below taut_last, which are its last three arguments; the loop vectorises where the step is 1
    host,    ///< no text, for the host device: any indices
};

/// Expected share of a kernel in the time of a run.
enum class kernel_use : std::uint8_t
{
    often,  ///< the device's compiler does its best
    seldom, ///< a few short launches a run: kernel_form::run is compiled without optimisations, as CPUs would wait
            ///< longer for the compiler than for the kernel
};

/// A complete OpenCL C 1.2 program with one kernel, or the function of kernel_form::part. Equal recordings give equal
/// text, so the text is its own cache key.
struct kernel_text
{
    std::string name;
    std::string source;
    std::vector<kernel_argument>
        arguments; ///< guarded, run and host have a last one, the int `taut_count`; part has three
    kernel_form form = kernel_form::item;
    std::vector<std::size_t> by_index; ///< positions of arguments that are read or written at [i], the plain index
    std::shared_ptr<const impl::row_program> rows; ///< of kernel_form::host
};

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
    /// An element of an array that the kernel may read and write: converts to its traced value, and can be assigned.
    /// Each conversion is a load as of that moment, so `auto r = y[i];` sees later stores, as a reference does.
    ///
    /// It is a template on the traced type, not on the scalar, in order to bring the friends of sym<T> into view:
    /// `x[i] * y[i]` and `sqrt(y[i])` then work on references.
    template <class Sym>
    class element
    {
    public:
        element(std::uint32_t argument, scalar_type type, sym<idx> at) noexcept
            : argument_(argument), type_(type), at_(at)
        {
        }
        element(const element&) = default;

        operator Sym() const { return load(); }

        Sym load() const { return Sym::of(tape::current().load(argument_, type_, at_.id())); }

        const element& operator=(Sym x) const
        {
            store(argument_, type_, at_, x.id());
            return *this;
        }

        /// y[i] = z[j] copies the element, as it does for numbers.
        const element& operator=(const element& other) const { return *this = other.load(); }
        element& operator=(const element& other)
        {
            static_cast<void>(std::as_const(*this) = other.load());
            return *this;
        }

        const element& operator+=(Sym x) const { return *this = load() + x; }
        const element& operator-=(Sym x) const { return *this = load() - x; }
        const element& operator*=(Sym x) const { return *this = load() * x; }
        const element& operator/=(Sym x) const { return *this = load() / x; }

    private:
        std::uint32_t argument_;
        scalar_type type_;
        sym<idx> at_;
    };

    /// An element that the kernel only writes. It does not convert, so that reading an output does not compile.
    template <class Sym>
    class sink
    {
    public:
        sink(std::uint32_t argument, scalar_type type, sym<idx> at) noexcept : argument_(argument), type_(type), at_(at)
        {
        }
        sink(const sink&) = delete;

        const sink& operator=(Sym x) const
        {
            store(argument_, type_, at_, x.id());
            return *this;
        }
        const sink& operator=(const sink&) const = delete;

    private:
        std::uint32_t argument_;
        scalar_type type_;
        sym<idx> at_;
    };

    /// A pointer argument that the kernel only reads: x[i] is a traced value.
    template <impl::traceable T>
    class in_array
    {
    public:
        /// type: of the numbers in memory; of doubles, it may be f32.
        explicit in_array(std::uint32_t argument, scalar_type type = impl::scalar_type_of<T>) noexcept
            : argument_(argument), type_(type)
        {
        }
        sym<T> operator[](sym<idx> at) const { return sym<T>::of(tape::current().load(argument_, type_, at.id())); }

    private:
        std::uint32_t argument_;
        scalar_type type_;
    };

    /// A pointer argument that the kernel only writes: x[i] = value. Reading it does not compile.
    template <impl::traceable T>
    class out_array
    {
    public:
        /// type: of the numbers in memory; of doubles, it may be f32.
        explicit out_array(std::uint32_t argument, scalar_type type = impl::scalar_type_of<T>) noexcept
            : argument_(argument), type_(type)
        {
        }
        sink<sym<T>> operator[](sym<idx> at) const { return {argument_, type_, at}; }

    private:
        std::uint32_t argument_;
        scalar_type type_;
    };

    /// A pointer argument that the kernel reads and writes: y[i] = a * x[i] + y[i].
    template <impl::traceable T>
    class inout_array
    {
    public:
        /// type: of the numbers in memory; of doubles, it may be f32.
        explicit inout_array(std::uint32_t argument, scalar_type type = impl::scalar_type_of<T>) noexcept
            : argument_(argument), type_(type)
        {
        }
        element<sym<T>> operator[](sym<idx> at) const { return {argument_, type_, at}; }

    private:
        std::uint32_t argument_;
        scalar_type type_;
    };

    /// real: the type of constants of sym<double>, for a kernel whose formulas are in float.
    explicit recording(scalar_type real = scalar_type::f64);

    /// Declares a pointer argument. A name is a C identifier, distinct from the others and not of the form t0, i0 or
    /// taut_x; an empty one becomes a0, a1, ... by position. Throws parameter_error for any other.
    /// type: of the numbers in memory. Doubles may be f32 there; what is loaded is then a sym<double> in float, and so
    /// is all that is computed from it.
    template <impl::traceable T>
    in_array<T> in(std::string_view name = {}, scalar_type type = impl::scalar_type_of<T>)
    {
        return in_array<T>(declare(name, argument_kind::in, type), type);
    }

    template <impl::traceable T>
    out_array<T> out(std::string_view name = {}, scalar_type type = impl::scalar_type_of<T>)
    {
        return out_array<T>(declare(name, argument_kind::out, type), type);
    }

    template <impl::traceable T>
    inout_array<T> inout(std::string_view name = {}, scalar_type type = impl::scalar_type_of<T>)
    {
        return inout_array<T>(declare(name, argument_kind::inout, type), type);
    }

    /// Declares a number that may change from launch to launch, unlike a captured host value, which becomes a literal.
    template <impl::traceable T>
    sym<T> scalar(std::string_view name = {}, scalar_type type = impl::scalar_type_of<T>)
    {
        const std::uint32_t position = declare(name, argument_kind::scalar, type);
        return sym<T>::of(tape_.intern({.op = impl::opcode::argument, .type = type, .payload = position}));
    }

    /// The number of the work-item along dimension 0, 1 or 2 of the range.
    sym<idx> global_id(unsigned dimension = 0);

    const std::vector<kernel_argument>& arguments() const noexcept { return arguments_; }
    const tape& recorded() const noexcept { return tape_; }

    /// The kernel as recorded so far. Its form depends on the device; see kernel_form.
    kernel_text finish(std::string name, kernel_form form = kernel_form::item,
                       kernel_use use = kernel_use::often) const;

private:
    /// Stores in the type of the array.
    static void store(std::uint32_t argument, scalar_type type, sym<idx> at, idx value);

    std::uint32_t declare(std::string_view name, argument_kind kind, scalar_type type);

    /// Names go into the text as they are; what the emitter makes up itself must stay free.
    static void require_identifier(const std::string& name);

    tape tape_;
    tape_scope scope_; // after the tape, as it must go first
    std::vector<kernel_argument> arguments_;
};

/// Traced element of an array in another precision, cast<float>(y[i]): a template does not convert its argument.
template <impl::traceable To, class Sym>
sym<To> cast(const recording::element<Sym>& x)
{
    return cast<To>(x.load());
}

} // namespace taut

#endif
#include <taut/impl/leave.inl>
