// SPDX-License-Identifier: MIT
#pragma once

#include <utility>

#include <taut/impl/core/symbolic/statement_writer.hpp>

namespace taut::impl
{

statement_writer::statement_writer(const graph& t, std::span<const kernel_argument> arguments, const schedule& plan,
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

void statement_writer::fuse(std::span<const node_id> ids)
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

void statement_writer::write(std::span<const node_id> ids)
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

void statement_writer::write_loop(node_id id, const node& n, std::string_view type)
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

std::string statement_writer::cube_root(scalar_type type, const std::string& x)
{
    const bool f64 = type == scalar_type::f64;
    (f64 ? needs_.cbrt_f64 : needs_.cbrt_f32) = true;
    return concat(f64 ? "taut_cbrt_f64(" : "taut_cbrt_f32(", x, ")");
}

std::string statement_writer::expression(const node& n)
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
        graph::refuse("a kernel cannot depend on a free variable: load it, or make it an argument");
    default:
        graph::refuse("an operation cannot be written as an expression");
    }
}

} // namespace taut::impl
