// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include <taut/any_energy.hpp>
#include <taut/impl/core/energy/invariants.hpp>
#include <taut/symbolic.hpp>

namespace taut::impl
{

/// The derivatives by the invariants if the recording of E(S) shows that S enters through norm2(S) and det S alone;
/// nothing otherwise.
///
/// The tape keeps one node for equal expressions, so the energy's own norm2(e.S) is the node I, and so is e.det d. A
/// sweep that stops at these two reaches an entry of S only if the energy uses it in another way. Hence nobody declares
/// anything, sums and products of energies qualify when their parts do, and no declaration can be wrong; an energy that
/// spells |S|^2 differently goes the numeric way, which is right, too, and slower.
///
/// The invariants rather than singular values s1, s2: what comes from E(s1, s2) needs (E_1 - E_2)/(s1 - s2), which is
/// 0/0 at every similarity, the very state that maps tend to.
template <int D>
std::optional<invariant_derivatives<sym<double>>> derivatives_by_invariants(sym<double> value,
                                                                            const glm::mat<D, D, sym<double>>& S)
{
    const sym<double> I = norm2(S), d = glm::determinant(S);
    std::vector<node_id> stops = {I.id(), d.id()};
    for (int c = 0; c < D; ++c)
        for (int r = 0; r < D; ++r) stops.push_back(S[c][r].id());
    const auto partials = impl::reverse_sweep(tape::current(), value.id(), stops);
    for (std::size_t k = 2; k < stops.size(); ++k)
        if (partials[k] != no_node) return std::nullopt;

    const auto first = differentiate(value, {I, d});
    const auto of_I = differentiate(first[0], {I, d});
    return invariant_derivatives<sym<double>>{I, d, first[0], first[1], of_I[0], of_I[1], differentiate(first[1], d)};
}

/// True if the energy gets the closed form of modes.hpp in dimension D, found by recording it once.
template <int D>
bool is_isotropic(const any_energy& energy)
{
    using real = sym<double>;
    tape recorded;
    const tape_scope scope(recorded);
    glm::mat<D, D, real> S;
    for (int c = 0; c < D; ++c)
        for (int r = 0; r < D; ++r) S[c][r] = real::variable();
    const real value = energy(element<real, D>{S, glm::determinant(S), real::variable()});
    return derivatives_by_invariants<D>(value, S).has_value();
}

} // namespace taut::impl
