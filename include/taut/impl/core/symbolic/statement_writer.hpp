// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <taut/impl/core/symbolic/literal.hpp>
#include <taut/impl/core/symbolic/schedule.hpp>
#include <taut/recording.hpp>

namespace taut::impl
{

/// Requirements of a kernel besides its statements.
struct kernel_needs
{
    bool f64 = false;                 ///< computes with doubles
    bool cbrt_f32 = false;            ///< calls taut_cbrt_f32
    bool cbrt_f64 = false;            ///< calls taut_cbrt_f64
    bool loops = false;               ///< contains a sum_over
    std::array<bool, 3> dimensions{}; ///< reads its global id along them: i0, i1, i2
};

/// Writes nodes as C statements: one `const T tN = ...;` each, scalar and free of branches, the form that compilers
/// vectorise. A product that only one sum needs is written inside of it, so that the compiler may contract both to a
/// fused multiply-add (C lets it do so within an expression only). Names count statements: they do not depend on what
/// else is on the tape.
class statement_writer
{
public:
    statement_writer(const graph& t, std::span<const kernel_argument> arguments, const schedule& plan,
                     std::string indent);

    const kernel_needs& needs() const noexcept { return needs_; }
    const std::string& text() const noexcept { return text_; }

private:
    static std::size_t at(node_id id) noexcept { return static_cast<std::size_t>(id); }
    const std::string& name(node_id id) const { return names_[at(id)]; }
    std::string& name(node_id id) { return names_[at(id)]; }
    std::string fresh() { return numbered("t", count_++); }
    template <class... Parts>
    void line(const Parts&... parts)
    {
        text_ += concat(indent_, parts..., "\n");
    }

    const kernel_argument& argument(const node& n) const
    {
        return arguments_[static_cast<std::size_t>(n.payload & 0xffffffffu)];
    }

    /// Marks the products that move into a sum.
    void fuse(std::span<const node_id> ids);

    /// Writes the statements of one scope. Constants and arguments need none: their text stands where they are used.
    void write(std::span<const node_id> ids);

    /// A loop nests only as deep as sum_over was nested in the source.
    void write_loop(node_id id, const node& n, std::string_view type);

    /// The built-in cbrt does not vectorise: ours goes into the program, see device_functions.hpp.
    std::string cube_root(scalar_type type, const std::string& x);

    /// One operation in C, with its operands by name. A fused product stands without parentheses: only sums contain
    /// one, and * binds stronger.
    std::string expression(const node& n);

    const graph& tape_;
    std::span<const kernel_argument> arguments_;
    const schedule& plan_;
    std::vector<std::string> names_; // by node: a temporary, an argument, a literal, or a fused product
    std::vector<bool> fused_;
    std::string indent_;
    std::string text_;
    kernel_needs needs_;
    std::uint64_t count_ = 0;
};

} // namespace taut::impl
