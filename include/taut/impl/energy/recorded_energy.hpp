// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <taut/impl/energy/element.hpp>
#include <taut/impl/symbolic/apply.hpp>
#include <taut/impl/symbolic/glm.hpp>

namespace taut
{

/// A function of one element that is written down operation by operation: for energies that no compiler sees, as those
/// of the Python package. While it is being recorded its tape is current (tape_scope), and the parts of its element
/// are variables of the tape.
///
///     auto r = std::make_shared<energy_recording<2>>();
///     {
///         const tape_scope scope(r->recorded());
///         r->finish(norm2(r->S()) * (1.0 + 1.0 / (r->det() * r->det())));
///     }
///     const any_energy e = recorded_energy(r);
template <int D>
class energy_recording
{
public:
    using real = sym<double>;

    energy_recording()
    {
        const tape_scope scope(tape_);
        for (int c = 0; c < D; ++c)
            for (int r = 0; r < D; ++r) S_[c][r] = real::variable();
        det_ = real::variable();
        measure_ = real::variable();
    }

    tape& recorded() noexcept { return tape_; }

    const glm::mat<D, D, real>& S() const noexcept { return S_; }
    const real& det() const noexcept { return det_; }
    const real& measure() const noexcept { return measure_; }
    real attribute(std::size_t k) { return numbered(attributes_, k); }
    real parameter(std::size_t k) { return numbered(parameters_, k); }

    /// How many of each the function reads.
    std::size_t attributes() const noexcept { return attributes_.size(); }
    std::size_t parameters() const noexcept { return parameters_.size(); }

    /// The value of the function. Throws tape_error for one that is not on the tape.
    void finish(real value)
    {
        root_ = value.id();
        std::vector<char> needed(static_cast<std::size_t>(root_) + 1, 0);
        needed.back() = 1;
        for (impl::node_id id = root_; id >= 0; --id)
            if (needed[static_cast<std::size_t>(id)])
                for (const impl::node_id operand : tape_[id].operands)
                    if (operand != impl::no_node) needed[static_cast<std::size_t>(operand)] = 1;
        order_.clear();
        for (impl::node_id id = 0; id <= root_; ++id)
            if (needed[static_cast<std::size_t>(id)]) order_.push_back(id);
    }

    /// The function of numbers.
    double operator()(const element<double, D>& e) const
    {
        std::vector<std::uint64_t> value(static_cast<std::size_t>(root_) + 1, 0);
        const auto at = [&](impl::node_id id) { return id == impl::no_node ? 0 : value[static_cast<std::size_t>(id)]; };
        for_each_leaf(e,
                      [&](impl::node_id id, double x)
                      {
                          if (id <= root_) value[static_cast<std::size_t>(id)] = impl::to_bits(x);
                      });
        for (const impl::node_id id : order_)
        {
            const impl::node& n = tape_[id];
            if (n.op == impl::opcode::variable) continue;
            if (n.op == impl::opcode::constant)
                value.at(static_cast<std::size_t>(id)) = n.payload;
            else
                value.at(static_cast<std::size_t>(id)) =
                    *impl::apply(n, tape_[n.operands[0]].type, at(n.operands[0]), at(n.operands[1]), at(n.operands[2]));
        }
        return impl::from_bits<double>(at(root_));
    }

    /// The function of traced values, written to the current tape: the same operations in the same order.
    real operator()(const element<real, D>& e) const
    {
        tape& t = tape::current();
        std::vector<impl::node_id> place(static_cast<std::size_t>(root_) + 1, impl::no_node);
        for_each_leaf(e,
                      [&](impl::node_id id, const real& x)
                      {
                          if (id <= root_) place[static_cast<std::size_t>(id)] = x.id();
                      });
        for (const impl::node_id id : order_)
            if (const impl::node& n = tape_[id]; n.op != impl::opcode::variable)
                place[static_cast<std::size_t>(id)] = copied(t, n, place);
        return real::of(place[static_cast<std::size_t>(root_)]);
    }

private:
    real numbered(std::vector<real>& list, std::size_t k)
    {
        const tape_scope scope(tape_);
        while (list.size() <= k) list.push_back(real::variable());
        return list[k];
    }

    /// Calls f(variable, value) with all parts of an element that the function reads. Throws parameter_error where the
    /// element has fewer numbers.
    template <class T, class F>
    void for_each_leaf(const element<T, D>& e, const F& f) const
    {
        for (int c = 0; c < D; ++c)
            for (int r = 0; r < D; ++r) f(S_[c][r].id(), e.S[c][r]);
        f(det_.id(), e.det);
        f(measure_.id(), e.measure);
        for (std::size_t k = 0; k < attributes_.size(); ++k) f(attributes_[k].id(), e.attribute(k));
        for (std::size_t k = 0; k < parameters_.size(); ++k) f(parameters_[k].id(), e.parameter(k));
    }

    /// One operation on another tape, whose real numbers may be in single precision.
    static impl::node_id copied(tape& t, const impl::node& n, const std::vector<impl::node_id>& place)
    {
        if (n.op == impl::opcode::constant)
            return n.type == scalar_type::boolean ? t.constant(n.payload != 0)
                                                  : t.real_constant(impl::from_bits<double>(n.payload));
        const auto at = [&](impl::node_id id)
        { return id == impl::no_node ? impl::no_node : place[static_cast<std::size_t>(id)]; };
        impl::node_id a = at(n.operands[0]), b = at(n.operands[1]), c = at(n.operands[2]);
        scalar_type type = n.type;
        if (n.op == impl::opcode::select)
            type = impl::shared_type(t, b, c);
        else if (t[a].type != scalar_type::boolean)
        {
            const scalar_type real_type = b == impl::no_node ? t[a].type : impl::shared_type(t, a, b);
            if (type != scalar_type::boolean) type = real_type;
        }
        return impl::build(t, n.op, type, a, b, c);
    }

    tape tape_;
    glm::mat<D, D, real> S_;
    real det_, measure_;
    std::vector<real> attributes_, parameters_;
    impl::node_id root_ = 0;
    std::vector<impl::node_id> order_; ///< the operations that the value needs, operands first
};

/// Recordings as an energy, of the plane, of space, or of both. As an any_energy it takes derivatives and becomes
/// kernels as one that is written in C++ does, with the same values bit for bit where its operations are the same.
class recorded_energy
{
public:
    bool barrier = true; ///< +infinity where det S <= 0, which the recording does not say

    recorded_energy(std::shared_ptr<const energy_recording<2>> plane, std::shared_ptr<const energy_recording<3>> space,
                    bool is_barrier = true)
        : barrier(is_barrier), plane_(std::move(plane)), space_(std::move(space))
    {
    }
    explicit recorded_energy(std::shared_ptr<const energy_recording<2>> plane, bool is_barrier = true)
        : recorded_energy(std::move(plane), nullptr, is_barrier)
    {
    }

    /// Throws parameter_error in a dimension without a recording.
    template <class T, int D>
    T operator()(const element<T, D>& e) const
    {
        const auto* recording = of_dimension<D>();
        if (!recording) throw parameter_error("energy", "is not defined in dimension " + std::to_string(D));
        return (*recording)(e);
    }

private:
    template <int D>
    const energy_recording<D>* of_dimension() const
    {
        if constexpr (D == 2)
            return plane_.get();
        else
            return space_.get();
    }

    std::shared_ptr<const energy_recording<2>> plane_;
    std::shared_ptr<const energy_recording<3>> space_;
};

} // namespace taut
