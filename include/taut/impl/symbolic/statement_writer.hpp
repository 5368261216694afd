// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <taut/impl/symbolic/kernel_text.hpp>
#include <taut/impl/symbolic/literal.hpp>
#include <taut/impl/symbolic/schedule.hpp>

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
    statement_writer(const tape& t, std::span<const kernel_argument> arguments, const schedule& plan,
                     std::string indent)
        : tape_(t),
          arguments_(arguments),
          plan_(plan),
          names_(t.size()),
          fused_(t.size(), false),
          indent_(std::move(indent))
    {
        write(plan_.top());
    }

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
    void fuse(std::span<const node_id> ids)
    {
        for (const node_id id : ids)
        {
            const node& n = tape_[id];
            if ((n.op != opcode::add && n.op != opcode::sub) || !is_floating(n.type)) continue;
            for (const node_id operand : {n.operands[0], n.operands[1]})
                if (tape_[operand].op == opcode::mul && plan_.uses(operand) == 1 &&
                    plan_.region(operand) == plan_.region(id))
                    fused_[at(operand)] = true;
        }
    }

    /// Writes the statements of one scope. Constants and arguments need none: their text stands where they are used.
    void write(std::span<const node_id> ids)
    {
        fuse(ids);
        for (const node_id id : ids)
        {
            const node& n = tape_[id];
            needs_.f64 |= n.type == scalar_type::f64;
            const std::string_view type = spelling(n.type);
            switch (n.op)
            {
            case opcode::constant:
                name(id) = literal(n.type, n.payload);
                break;
            case opcode::argument:
                name(id) = argument(n).name;
                break;
            case opcode::store:
                line(argument(n).name, "[", name(n.operands[0]), "] = ", name(n.operands[1]), ";");
                break;
            case opcode::loop_sum:
                write_loop(id, n, type);
                break;
            case opcode::global_id:
                needs_.dimensions[static_cast<std::size_t>(n.payload)] = true;
                name(id) = numbered("i", n.payload);
                break;
            default:
                if (fused_[at(id)])
                    name(id) = expression(n);
                else
                {
                    name(id) = fresh();
                    line("const ", type, " ", name(id), " = ", expression(n), ";");
                }
            }
        }
    }

    /// A loop nests only as deep as sum_over was nested in the source.
    void write_loop(node_id id, const node& n, std::string_view type)
    {
        needs_.loops = true;
        const auto index_node = static_cast<node_id>(n.payload);
        name(id) = fresh();
        name(index_node) = fresh();
        const std::string k = name(index_node);
        line(type, " ", name(id), " = 0;");
        line("for (int ", k, " = ", name(n.operands[0]), "; ", k, " < ", name(n.operands[1]), "; ++", k, ")");
        line("{");
        indent_ += "    ";
        write(plan_.body(index_node));
        line(name(id), " += ", name(n.operands[2]), ";");
        indent_.resize(indent_.size() - 4);
        line("}");
    }

    /// The built-in cbrt does not vectorise: ours goes into the program, see device_functions.hpp.
    std::string cube_root(scalar_type type, const std::string& x)
    {
        const bool f64 = type == scalar_type::f64;
        (f64 ? needs_.cbrt_f64 : needs_.cbrt_f32) = true;
        return concat(f64 ? "taut_cbrt_f64(" : "taut_cbrt_f32(", x, ")");
    }

    /// One operation in C, with its operands by name. A fused product stands without parentheses: only sums contain
    /// one, and * binds stronger.
    std::string expression(const node& n)
    {
        const auto operand = [&](std::size_t k) -> const std::string& { return name(n.operands[k]); };
        const auto infix = [&](const char* op) { return concat(operand(0), " ", op, " ", operand(1)); };
        const auto call = [&](const char* f) { return concat(f, "(", operand(0), ")"); };
        switch (n.op)
        {
        case opcode::neg:
            return concat("-", operand(0));
        case opcode::add:
            return infix("+");
        case opcode::sub:
            return infix("-");
        case opcode::mul:
            return infix("*");
        case opcode::div:
            return infix("/");
        case opcode::rem:
            return infix("%");
        case opcode::abs:
            return call("fabs");
        case opcode::floor:
            return call("floor");
        case opcode::sqrt:
            return call("sqrt");
        case opcode::cbrt:
            return cube_root(n.type, operand(0));
        case opcode::root3:
            return cube_root(n.type, concat(operand(0), " < 0 ? NAN : ", operand(0))); // a float NaN widens
        case opcode::exp:
            return call("exp");
        case opcode::log:
            return call("log");
        case opcode::sin:
            return call("sin");
        case opcode::cos:
            return call("cos");
        case opcode::tan:
            return call("tan");
        case opcode::atan:
            return call("atan");
        case opcode::pow:
            return concat("pow(", operand(0), ", ", operand(1), ")");
        case opcode::less:
            return infix("<");
        case opcode::less_equal:
            return infix("<=");
        case opcode::equal:
            return infix("==");
        case opcode::not_equal:
            return infix("!=");
        case opcode::logical_not:
            return concat("!", operand(0));
        case opcode::logical_and:
            return infix("&"); // not &&: both sides exist, and a branch would not vectorise
        case opcode::logical_or:
            return infix("|");
        case opcode::select:
            return concat(operand(0), " ? ", operand(1), " : ", operand(2));
        case opcode::cast:
            return concat("(", spelling(n.type), ")", operand(0));
        case opcode::load:
            return concat(argument(n).name, "[", operand(0), "]");
        case opcode::variable:
            throw tape_error("a kernel cannot depend on a free variable: load it, or make it an argument");
        default:
            throw tape_error("an operation cannot be written as an expression");
        }
    }

    const tape& tape_;
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
