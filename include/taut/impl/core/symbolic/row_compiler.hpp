// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <span>
#include <utility>
#include <vector>

#include <taut/impl/core/symbolic/row_program.hpp>
#include <taut/impl/core/symbolic/schedule.hpp>

namespace taut::impl
{

/// Compiles a tape to a row_program: finds out what varies, orders, fuses, and gives rows to values while they live.
class row_compiler
{
public:
    row_compiler(const graph& t, row_program& out);

private:
    /// How a value depends on the index: not at all, as index + uniform, or in any way.
    enum class variation : std::uint8_t
    {
        uniform,
        linear,
        varying
    };
    /// A value's way through the compiler.
    struct value
    {
        variation kind = variation::varying;
        bool seen = false;
        bool needed = false;    ///< as a row
        bool fused = false;     ///< computed by its only user
        bool in_place = false;  ///< of a store: its row lies in memory; of a value: the row of its store is its own
        int uniform = -1;       ///< its number, of uniform and linear values
        int row = -1;           ///< while it lives; of a uniform: its splat
        int place = -1;         ///< in order_
        int last = -1;          ///< place of the last use
        node_id loop = no_node; ///< the loop_sum around it
        node_id store = no_node;
    };
    struct open_loop
    {
        std::size_t code;
        int mask;
    };

    static std::size_t at(node_id id) noexcept { return static_cast<std::size_t>(id); }
    value& v(node_id id) { return values_[at(id)]; }
    const value& v(node_id id) const { return values_[at(id)]; }
    const node& n(node_id id) const { return tape_[id]; }
    bool is_uniform(node_id id) const { return id == no_node || v(id).kind == variation::uniform; }
    bool is_linear(node_id id) const { return v(id).kind == variation::linear; }
    static int argument(const node& x) { return static_cast<int>(x.payload & 0xffffffffu); }
    argument_kind kind(const node& x) const { return out_.arguments[static_cast<std::size_t>(argument(x))].kind; }
    static node_id index_of(const node& loop) { return static_cast<node_id>(loop.payload); }
    static int wide(scalar_type type) { return type == scalar_type::f64 ? 1 : 0; }

    void classify(std::span<const node_id> ids);
    variation variation_of(const node& x) const;
    void add_uniform(node_id id);

    /// Depth first from the stores, so that values are used soon. Loops, and what reads or writes memory that the
    /// kernel writes, keep their order.
    void order();
    void visit(node_id root);
    /// Operands of a node, with those of the bodies of its loops.
    void operands(node_id id, std::vector<node_id>& to) const;
    void append(node_id id, node_id loop);

    /// Outputs at indices of their own are rows in memory.
    void find_rows_in_memory();
    /// What one operation needs, which can do it itself, has no row.
    void fuse();
    bool is_sum_or_product(node_id id) const;
    void find_uses();
    void use(node_id id, node_id user);
    /// An index as a row and a uniform, for addresses.
    std::pair<node_id, node_id> split(node_id index) const;

    void emit(node_id id);
    void begin_loop(node_id loop, const node& x);
    void end_loop(node_id loop, const node& x);
    void emit_load(node_id id, const node& x);
    void emit_store(node_id id, const node& x);
    void emit_operation(node_id id, const node& x);
    /// Sums, differences and products of floating-point numbers, with what is fused into them.
    void emit_fused(node_id id, const node& x);

    /// The row of a value; a uniform gets one.
    int row(node_id id);
    int new_row(scalar_type type);
    int take(scalar_type type);
    int alias(const node& access, node_id store);
    /// Ends what is not used after a place.
    void release(int place);
    /// An operation with a result, whose row may be that of an operand.
    void add(int code, node_id result, std::initializer_list<int> rows);
    void add(int code, std::initializer_list<int> rows);

    const graph& tape_;
    schedule plan_;
    row_program& out_;
    std::vector<value> values_;
    std::vector<node_id> order_; ///< of a loop: its index, its body, its sum
    std::vector<node_id> live_;
    std::array<std::vector<int>, 2> free_; ///< rows of 4 and of 8 bytes
    std::vector<open_loop> open_;
};

} // namespace taut::impl
