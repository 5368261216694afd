// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <map>
#include <string>
#include <type_traits>
#include <vector>

#include <doctest/doctest.h>

#include <taut/impl/core/compute/host/row_launch.hpp>
#include <taut/impl/core/symbolic/apply.hpp>
#include <taut/impl/core/symbolic/schedule.hpp>
#include <taut/recording.hpp>

/// Arguments of a kernel by name, each an array of just as many bytes as it has, or the bits of a number.
struct host_memory
{
    std::map<std::string, std::vector<char>> arrays;
    std::map<std::string, std::uint64_t> numbers;

    template <class T>
    void put(const std::string& name, const std::vector<T>& values)
    {
        auto& bytes = arrays[name];
        bytes.resize(values.size() * sizeof(T));
        if (!values.empty()) std::memcpy(bytes.data(), values.data(), bytes.size());
    }
    template <class T>
    std::vector<T> get(const std::string& name) const
    {
        const auto& bytes = arrays.at(name);
        std::vector<T> values(bytes.size() / sizeof(T));
        if (!values.empty()) std::memcpy(values.data(), bytes.data(), bytes.size());
        return values;
    }

    std::vector<taut::impl::host_argument> arguments(const std::vector<taut::kernel_argument>& declared) const
    {
        std::vector<taut::impl::host_argument> all;
        for (const auto& a : declared)
            if (a.kind != taut::argument_kind::scalar)
                all.push_back(arrays.at(a.name).data());
            else
            {
                all.push_back(nullptr);
                all.back().bits = numbers.at(a.name);
            }
        return all;
    }
};

/// What a recording does with memory, one index and one operation after the other: an oracle.
class reference_run
{
public:
    reference_run(const taut::recording& r, host_memory& memory)
        : recording_(r), tape_(r.recorded()), plan_(tape_, tape_.stores()), values_(tape_.size()), memory_(memory)
    {
    }

    void operator()(taut::idx index)
    {
        index_ = index;
        run(plan_.top());
    }

private:
    using node = taut::impl::node;
    using opcode = taut::impl::opcode;

    std::uint64_t& value(taut::impl::node_id id) { return values_[static_cast<std::size_t>(id)]; }
    std::uint64_t operand(taut::impl::node_id id) { return id == taut::impl::no_node ? 0 : value(id); }
    taut::idx integer(taut::impl::node_id id) { return taut::impl::from_bits<taut::idx>(value(id)); }

    void run(std::span<const taut::impl::node_id> ids)
    {
        for (const auto id : ids) run(id, tape_[id]);
    }

    void run(taut::impl::node_id id, const node& n)
    {
        const auto [a, b, c] = n.operands;
        const auto& argument =
            recording_.arguments()[std::min<std::size_t>(n.payload & 0xffffffffu, recording_.arguments().size() - 1)];
        const std::size_t size = taut::impl::size_of(n.type);
        if (n.op == opcode::constant)
            value(id) = n.payload;
        else if (n.op == opcode::argument)
            value(id) = memory_.numbers.at(argument.name);
        else if (n.op == opcode::global_id)
            value(id) = n.payload == 0 ? taut::impl::to_bits(index_) : 0;
        else if (n.op == opcode::load)
        {
            value(id) = 0;
            std::memcpy(&value(id),
                        memory_.arrays.at(argument.name).data() + std::ptrdiff_t{integer(a)} * std::ptrdiff_t(size),
                        size);
        }
        else if (n.op == opcode::store)
            std::memcpy(memory_.arrays.at(argument.name).data() + std::ptrdiff_t{integer(a)} * std::ptrdiff_t(size),
                        &value(b), size);
        else if (n.op == opcode::loop_sum)
        {
            const auto counter = static_cast<taut::impl::node_id>(n.payload);
            std::uint64_t sum = 0;
            for (taut::idx k = integer(a); k < integer(b); ++k)
            {
                value(counter) = taut::impl::to_bits(k);
                run(plan_.body(counter));
                sum = *taut::impl::apply({.op = opcode::add, .type = n.type}, n.type, sum, value(c), 0);
            }
            value(id) = sum;
        }
        else
            value(id) = taut::impl::apply(n, tape_[a].type, operand(a), operand(b), operand(c)).value_or(0);
    }

    const taut::recording& recording_;
    const taut::tape& tape_;
    taut::impl::schedule plan_;
    std::vector<std::uint64_t> values_;
    host_memory& memory_;
    taut::idx index_ = 0;
};

/// tolerance: relative, absolute below 1.
template <class T>
bool same_number(T a, T b, double tolerance)
{
    if (std::isinf(tolerance)) return true;
    if (a == b || (std::isnan(double(a)) && std::isnan(double(b)))) return true;
    return std::abs(double(a) - double(b)) <= tolerance * std::max({1.0, std::abs(double(a)), std::abs(double(b))});
}

/// The arrays of two memories have the same numbers, NaN where the other has one; tolerance: relative.
inline bool agree(const taut::recording& r, const host_memory& got, const host_memory& expected, double tolerance)
{
    for (const auto& a : r.arguments())
    {
        if (a.kind == taut::argument_kind::scalar) continue;
        const bool found =
            taut::impl::with_type(a.type,
                                  [&]<class T>(std::type_identity<T>)
                                  {
                                      if constexpr (std::is_same_v<T, bool>)
                                          return false;
                                      else
                                      {
                                          const auto x = got.get<T>(a.name), y = expected.get<T>(a.name);
                                          for (std::size_t k = 0; k < x.size(); ++k)
                                              if (!same_number(x[k], y[k], tolerance))
                                              {
                                                  MESSAGE(a.name << "[" << k << "] is " << x[k] << ", not " << y[k]);
                                                  return false;
                                              }
                                          return true;
                                      }
                                  });
        if (!found) return false;
    }
    return true;
}

/// Runs a recording over first, first + step, ... below last, with each set of operations and as the oracle does
/// it. contracted: the tolerance for sets that contract products with sums.
inline bool runs_as_recorded(const taut::recording& r, const host_memory& memory, taut::idx first, taut::idx last,
                             taut::idx step = 1, double tolerance = 0, double contracted = 0)
{
    host_memory expected = memory;
    reference_run reference(r, expected);
    for (taut::idx i = first; i < last; i += step) reference(i);
    const taut::kernel_text text = r.finish("f", taut::kernel_form::host);
    for (const auto& operations : taut::impl::row_operation_sets())
    {
        host_memory got = memory;
        taut::impl::row_launch(*text.rows, got.arguments(r.arguments()), operations).run(first, last, step);
        const bool plain = &operations == &taut::impl::row_operation_sets().back();
        INFO("operations of " << std::string(operations.name));
        if (!agree(r, got, expected, plain ? tolerance : std::max(contracted, tolerance))) return false;
    }
    return true;
}
