// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>

#include <taut/impl/core/symbolic/row_compiler.hpp>

namespace taut::impl
{

row_program::row_program(const graph& t, std::vector<kernel_argument> all) : arguments(std::move(all))
{
    row_compiler(t, *this);
}

row_compiler::row_compiler(const graph& t, row_program& out)
    : tape_(t), plan_(t, t.stores()), out_(out), values_(t.size())
{
    classify(plan_.top());
    order();
    find_rows_in_memory();
    fuse();
    find_uses();
    for (const node_id id : order_) emit(id);
    out_.code.resize(out_.code.size() + row_program::ahead);
    std::sort(out_.aliases.begin(), out_.aliases.end(),
              [](const auto& a, const auto& b) { return std::pair(a.store, a.row) < std::pair(b.store, b.row); });
}

void row_compiler::classify(std::span<const node_id> ids)
{
    for (const node_id id : ids)
    {
        const node& x = n(id);
        if (x.op == opcode::variable)
            graph::refuse("a kernel cannot depend on a free variable: load it, or make it an argument");
        if (x.op == opcode::loop_sum) classify(plan_.body(index_of(x)));
        v(id).kind = variation_of(x);
        if (v(id).kind != variation::varying) add_uniform(id);
    }
}

row_compiler::variation row_compiler::variation_of(const node& x) const
{
    const auto [a, b, c] = x.operands;
    const bool uniform = is_uniform(a) && is_uniform(b) && is_uniform(c);
    switch (x.op)
    {
    case opcode::global_id:
        return x.payload == 0 ? variation::linear : variation::uniform;
    case opcode::load: // in a loop it may be out of bounds if the loop is empty
        return uniform && kind(x) == argument_kind::in && b == no_node ? variation::uniform : variation::varying;
    case opcode::loop_index:
    case opcode::loop_sum:
    case opcode::store:
        return variation::varying;
    case opcode::add:
    case opcode::sub:
        if (x.type == scalar_type::i32 &&
            ((is_linear(a) && is_uniform(b)) || (x.op == opcode::add && is_uniform(a) && is_linear(b))))
            return variation::linear;
        break;
    default:
        break;
    }
    return uniform ? variation::uniform : variation::varying;
}

void row_compiler::add_uniform(node_id id)
{
    node x = n(id);
    const scalar_type from = x.operands[0] == no_node ? x.type : n(x.operands[0]).type;
    v(id).uniform = static_cast<int>(out_.values.size());
    out_.values.push_back(x.op == opcode::constant ? x.payload : 0);
    if (x.op == opcode::constant || x.op == opcode::global_id) return; // of linear ones: that at index 0
    for (node_id& operand : x.operands)
        if (operand != no_node) operand = v(operand).uniform;
    if (x.op == opcode::load) x.payload = static_cast<std::uint64_t>(argument(x));
    out_.uniforms.push_back({v(id).uniform, x, from});
}

void row_compiler::order()
{
    for (const node_id id : plan_.top())
    {
        const node& x = n(id);
        if (x.op == opcode::store || x.op == opcode::loop_sum || (x.op == opcode::load && kind(x) != argument_kind::in))
            visit(id);
    }
}

void row_compiler::visit(node_id root)
{
    std::vector<std::pair<node_id, bool>> stack = {{root, false}};
    std::vector<node_id> before;
    while (!stack.empty())
    {
        const auto [id, done] = stack.back();
        stack.pop_back();
        if (done)
            append(id, no_node);
        else if (!std::exchange(v(id).seen, true))
        {
            stack.emplace_back(id, true);
            before.clear();
            if (!is_linear(id)) operands(id, before);
            for (auto o = before.rbegin(); o != before.rend(); ++o)
                if (!is_uniform(*o) && !v(*o).seen) stack.emplace_back(*o, false);
        }
    }
}

void row_compiler::operands(node_id id, std::vector<node_id>& to) const
{
    for (const node_id o : n(id).operands)
        if (o != no_node && plan_.region(o) == no_node) to.push_back(o);
    if (n(id).op == opcode::loop_sum)
        for (const node_id inner : plan_.body(index_of(n(id)))) operands(inner, to);
}

void row_compiler::append(node_id id, node_id loop)
{
    const auto push = [&](node_id x, node_id around)
    {
        v(x).loop = around;
        v(x).place = static_cast<int>(order_.size());
        order_.push_back(x);
    };
    if (n(id).op == opcode::loop_sum)
    {
        push(index_of(n(id)), id);
        for (const node_id inner : plan_.body(index_of(n(id)))) append(inner, id);
    }
    push(id, loop);
}

void row_compiler::find_rows_in_memory()
{
    for (std::size_t a = 0; a < out_.arguments.size(); ++a)
    {
        std::vector<node_id> stores, indices;
        for (const node_id id : tape_.stores())
            if (static_cast<std::size_t>(argument(n(id))) == a)
                stores.push_back(id), indices.push_back(n(id).operands[0]);
        std::sort(indices.begin(), indices.end());
        if (out_.arguments[a].kind != argument_kind::out ||
            std::adjacent_find(indices.begin(), indices.end()) != indices.end() ||
            !std::all_of(indices.begin(), indices.end(), [this](node_id i) { return is_linear(i); }))
            continue;
        for (const node_id id : stores)
        {
            const node_id stored = n(id).operands[1];
            v(id).in_place = true;
            if (v(stored).kind == variation::varying && n(stored).op != opcode::load &&
                n(stored).op != opcode::loop_sum && v(stored).store == no_node)
                v(stored).store = id;
        }
    }
}

void row_compiler::fuse()
{
    for (auto place = order_.rbegin(); place != order_.rend(); ++place)
    {
        if (!is_sum_or_product(*place) || v(*place).fused) continue;
        for (const node_id o : {n(*place).operands[0], n(*place).operands[1]})
            v(o).fused = is_sum_or_product(o) && plan_.uses(o) == 1 && v(o).loop == v(*place).loop;
    }
}

bool row_compiler::is_sum_or_product(node_id id) const
{
    const node& x = n(id);
    return (x.op == opcode::add || x.op == opcode::sub || x.op == opcode::mul) && is_floating(x.type) &&
           v(id).kind == variation::varying;
}

void row_compiler::find_uses()
{
    for (auto place = order_.rbegin(); place != order_.rend(); ++place)
    {
        const node_id id = *place;
        const node& x = n(id);
        if (x.op == opcode::store)
        {
            if (!is_linear(x.operands[0])) use(x.operands[0], id);
            use(x.operands[1], id);
        }
        else if (!v(id).needed || is_linear(id) || v(id).fused || x.op == opcode::loop_index)
            continue;
        else if (x.op == opcode::load)
        {
            const bool row = !is_linear(x.operands[0]) || v(id).loop != no_node;
            if (row) use(split(x.operands[0]).first, id);
        }
        else
            for (const node_id o : x.operands)
                if (o == no_node)
                    continue;
                else if (v(o).fused)
                    for (const node_id inner : {n(o).operands[0], n(o).operands[1]}) use(inner, id);
                else
                    use(o, id);
    }
}

void row_compiler::use(node_id id, node_id user)
{
    if (is_uniform(id)) return;
    int place = v(user).place;
    // what a loop uses lives until its end
    if (v(id).loop != user)
        for (node_id loop = v(user).loop; loop != no_node && loop != v(id).loop; loop = v(loop).loop)
            place = std::max(place, v(loop).place);
    v(id).needed = true;
    v(id).last = std::max(v(id).last, place);
}

std::pair<node_id, node_id> row_compiler::split(node_id index) const
{
    const node& x = n(index);
    if (x.op == opcode::add && v(index).kind == variation::varying)
        for (const std::size_t k : {0u, 1u})
            if (is_uniform(x.operands[k])) return {x.operands[1 - k], x.operands[k]};
    return {index, no_node};
}

void row_compiler::emit(node_id id)
{
    const node& x = n(id);
    if (x.op == opcode::store)
        emit_store(id, x);
    else if (x.op == opcode::loop_index)
        begin_loop(v(id).loop, n(v(id).loop));
    else if (x.op == opcode::loop_sum)
        end_loop(id, x);
    else if (!v(id).needed || v(id).fused || v(id).kind == variation::uniform)
        return;
    else if (is_linear(id))
        add(row_code::index, id, {v(id).uniform});
    else if (x.op == opcode::load)
        emit_load(id, x);
    else
        emit_operation(id, x);
}

void row_compiler::begin_loop(node_id loop, const node& x)
{
    const int around = open_.empty() ? -1 : open_.back().mask;
    const int sum = take(x.type), counter = take(scalar_type::i32), mask = take(scalar_type::i32);
    v(loop).row = sum;
    v(index_of(x)).row = counter;
    open_.push_back({out_.code.size(), mask});
    add(row_code::loop + static_cast<int>(x.type),
        {sum, row(x.operands[0]), row(x.operands[1]), -1, counter, mask, around});
}

void row_compiler::end_loop(node_id loop, const node& x)
{
    const int summand = row(x.operands[2]);
    row_operation& code = out_.code[open_.back().code];
    code.rows[3] = summand;
    code.body = static_cast<int>(out_.code.size() - open_.back().code - 1);
    for (const int done : {code.rows[4], code.rows[5]}) free_[0].push_back(done);
    open_.pop_back();
    live_.push_back(loop);
    release(v(loop).place);
}

void row_compiler::emit_load(node_id id, const node& x)
{
    const int wide = row_compiler::wide(x.type);
    const node_id index = x.operands[0];
    if (v(id).loop == no_node && is_linear(index))
    {
        if (kind(x) == argument_kind::in)
            v(id).row = alias(x, no_node);
        else
            add(row_code::load + wide, id, {argument(x), v(index).uniform});
        return;
    }
    const auto [base, offset] = split(index);
    const int uniform = offset == no_node ? -1 : v(offset).uniform;
    if (v(id).loop == no_node)
        add(row_code::gather + wide, id, {row(base), argument(x), uniform});
    else
        add(row_code::masked + wide, id, {row(base), argument(x), uniform, open_.back().mask});
}

void row_compiler::emit_store(node_id id, const node& x)
{
    const auto [index, stored, none] = x.operands;
    const int wide = row_compiler::wide(x.type);
    if (!v(id).in_place && is_linear(index))
        add(row_code::store + wide, {row(stored), argument(x), v(index).uniform});
    else if (!v(id).in_place)
        add(row_code::scatter + wide, {row(stored), row(index), argument(x)});
    else if (v(stored).store != id)
        add(row_code::copy + wide, {alias(x, id), row(stored)});
    release(v(id).place);
}

void row_compiler::emit_operation(node_id id, const node& x)
{
    const auto [a, b, c] = x.operands;
    const scalar_type from = n(a).type == scalar_type::boolean ? scalar_type::i32 : n(a).type;
    if ((b != no_node && v(b).fused) || v(a).fused)
        emit_fused(id, x);
    else if (x.op == opcode::cast)
        add(row_code::cast(n(a).type, x.type), id, {row(a)});
    else if (x.op >= opcode::less && x.op <= opcode::not_equal)
        add(row_code::plain(x.op, from), id, {row(a), row(b)});
    else if (c != no_node)
        add(row_code::plain(x.op, x.type), id, {row(a), row(b), row(c)});
    else if (b != no_node)
        add(row_code::plain(x.op, x.type), id, {row(a), row(b)});
    else
        add(row_code::plain(x.op, x.type), id, {row(a)});
}

void row_compiler::emit_fused(node_id id, const node& x)
{
    const auto [a, b, none] = x.operands;
    const auto inner = [this](node_id i)
    {
        const opcode op = n(i).op;
        return op == opcode::add ? row_code::sum : op == opcode::sub ? row_code::difference : row_code::product;
    };
    const auto rows = [this](node_id i) { return std::pair(row(n(i).operands[0]), row(n(i).operands[1])); };
    auto outer = x.op == opcode::add ? row_code::plus : x.op == opcode::sub ? row_code::minus : row_code::times;
    const node_id first = v(a).fused ? a : b;
    const auto [a0, a1] = rows(first);
    if (v(a).fused && v(b).fused)
    {
        const auto [b0, b1] = rows(b);
        return add(row_code::join(inner(a), inner(b), outer, x.type), id, {a0, a1, b0, b1});
    }
    if (first == b && outer == row_code::minus) outer = row_code::from;
    add(row_code::pair(inner(first), outer, x.type), id, {a0, a1, row(first == a ? b : a)});
}

int row_compiler::row(node_id id)
{
    value& x = v(id);
    if (x.row < 0) // of a uniform, for all the time
    {
        x.row = new_row(n(id).type);
        out_.splats.push_back({x.row, x.uniform, n(id).type});
    }
    return x.row;
}

int row_compiler::new_row(scalar_type type)
{
    out_.widths.push_back(static_cast<std::uint8_t>(size_of(type)));
    return static_cast<int>(out_.widths.size() - 1);
}

int row_compiler::take(scalar_type type)
{
    auto& free = free_[static_cast<std::size_t>(wide(type))];
    if (free.empty()) return new_row(type);
    const int r = free.back();
    free.pop_back();
    return r;
}

int row_compiler::alias(const node& access, node_id store)
{
    const int r = new_row(access.type);
    out_.aliases.push_back({r, static_cast<std::size_t>(argument(access)), v(access.operands[0]).uniform, store});
    return r;
}

void row_compiler::release(int place)
{
    std::erase_if(live_,
                  [&](node_id id)
                  {
                      if (v(id).last > place) return false;
                      free_[static_cast<std::size_t>(wide(n(id).type))].push_back(v(id).row);
                      return true;
                  });
}

void row_compiler::add(int code, node_id result, std::initializer_list<int> rows)
{
    value& x = v(result);
    release(x.place);
    if (x.store != no_node)
        x.row = alias(n(x.store), x.store);
    else
    {
        x.row = take(n(result).type);
        live_.push_back(result);
    }
    row_operation& operation = out_.code.emplace_back();
    operation.code = code;
    operation.rows[0] = x.row;
    std::copy(rows.begin(), rows.end(), operation.rows.begin() + 1);
}

void row_compiler::add(int code, std::initializer_list<int> rows)
{
    row_operation& operation = out_.code.emplace_back();
    operation.code = code;
    std::copy(rows.begin(), rows.end(), operation.rows.begin());
}

} // namespace taut::impl
