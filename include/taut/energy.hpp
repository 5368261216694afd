// SPDX-License-Identifier: MIT
#include <taut/impl/enter.inl>
#ifndef TAUT_ENERGY_HPP
#define TAUT_ENERGY_HPP

/// Energies of maps: those that come along, their algebra, and what an energy of your own takes.
#include <taut/any_energy.hpp>
#include <taut/energies.hpp>
#include <taut/impl/core/energy/algebra.hpp>
#include <taut/impl/core/energy/characteristic_value.hpp>
#include <taut/impl/core/energy/regularized.hpp>
#include <taut/shell.hpp>
#include <taut/traced_vectors.hpp>

#endif
#include <taut/impl/leave.inl>
