// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <string_view>
#include <utility>

#include <taut/impl/core/symbolic/emit.hpp>

namespace taut::impl
{

std::string parameter_text(const kernel_argument& a)
{
    const std::string_view type = spelling(a.type);
    switch (a.kind)
    {
    case argument_kind::scalar:
        return concat("const ", type, " ", a.name);
    case argument_kind::in:
        return concat("__global const ", type, "* ", a.name);
    default:
        return concat("__global ", type, "* ", a.name);
    }
}

std::string prologue(kernel_form form, const kernel_needs& needs)
{
    std::string text;
    for (int d = 1; d < 3; ++d)
        if (needs.dimensions[static_cast<std::size_t>(d)])
            text += concat("    const int i", std::to_string(d), " = get_global_id(", std::to_string(d), ");\n");
    if (form == kernel_form::run)
    {
        const std::string length = std::to_string(run_length);
        text += concat("    const int taut_first = (int)get_global_id(0) * ", length, ";\n");
        text += concat("    const int taut_last = min(taut_first + ", length, ", taut_count);\n");
    }
    if (has_loop(form))
    {
        // Work-items are independent, so the indices are. Without this loop PoCL packs x and y of a point into pairs
        // first, and then no longer vectorises over work-items. Only innermost loops vectorise.
        if (!needs.loops) text += "    #pragma clang loop vectorize(assume_safety) vectorize_width(8)\n";
        text += concat("    for (int i0 = taut_first; i0 < taut_last; ",
                       form == kernel_form::run ? "++i0" : "i0 += taut_step", ")\n    {\n");
    }
    else if (needs.dimensions[0] || form == kernel_form::guarded)
        text += "    const int i0 = get_global_id(0);\n";
    if (form == kernel_form::guarded) text += "    if (i0 >= taut_count) return;\n";
    return text;
}

std::vector<std::size_t> accessed_by_index(const graph& t, const schedule& plan)
{
    std::vector<std::size_t> arguments;
    for (const node_id id : plan.top())
    {
        const node& n = t[id];
        if (n.op != opcode::load && n.op != opcode::store) continue;
        const node& at = t[n.operands[0]];
        if (at.op == opcode::global_id && at.payload == 0) arguments.push_back(n.payload & 0xffffffffu);
    }
    return arguments;
}

kernel_text emit(const graph& t, std::string name, std::vector<kernel_argument> arguments, kernel_form form,
                 kernel_use use)
{
    const bool is_loop = impl::has_loop(form), is_part = form == kernel_form::part;
    const impl::schedule plan(t, t.stores());
    const impl::statement_writer body(t, arguments, plan, is_loop ? "        " : "    ");
    const impl::kernel_needs& needs = body.needs();
    const auto add_int = [&](const char* extra) {
        arguments.push_back({extra, argument_kind::scalar, scalar_type::i32});
    };
    if (is_part)
        for (const char* extra : {"taut_first", "taut_last", "taut_step"}) add_int(extra);
    else if (form != kernel_form::item)
        add_int("taut_count");

    std::string parameters;
    bool f64 = needs.f64;
    for (const kernel_argument& a : arguments)
    {
        parameters += impl::concat(parameters.empty() ? "" : ", ", impl::parameter_text(a));
        f64 |= a.type == scalar_type::f64;
    }

    std::string source = f64 ? "#pragma OPENCL EXTENSION cl_khr_fp64 : enable\n" : "";
    if (is_loop) source += "#pragma clang diagnostic ignored \"-Wpass-failed\"\n"; // a call in the loop stays scalar
    if (needs.cbrt_f32) source += impl::cbrt_f32_source;
    if (needs.cbrt_f64) source += impl::cbrt_f64_source;
    const bool plain = form == kernel_form::run && use == kernel_use::seldom;
    source += is_part ? "static " : plain ? "__kernel __attribute__((optnone)) " : "__kernel ";
    source += impl::concat("void ", name, "(", parameters, ")\n{\n");
    source += impl::prologue(form, needs) + body.text() + (is_loop ? "    }\n}\n" : "}\n");
    return {std::move(name), std::move(source), std::move(arguments), form, impl::accessed_by_index(t, plan), nullptr};
}

} // namespace taut::impl
