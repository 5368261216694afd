// SPDX-License-Identifier: MIT
#pragma once

/// Energies of maps: those that come along, their algebra, and what an energy of your own takes.
#include <taut/impl/energy/algebra.hpp>
#include <taut/impl/energy/any_energy.hpp>
#include <taut/impl/energy/area.hpp>
#include <taut/impl/energy/characteristic_value.hpp>
#include <taut/impl/energy/check_gradient.hpp>
#include <taut/impl/energy/definiteness.hpp>
#include <taut/impl/energy/element.hpp>
#include <taut/impl/energy/isometric.hpp>
#include <taut/impl/energy/neo_hookean.hpp>
#include <taut/impl/energy/recorded_energy.hpp>
#include <taut/impl/energy/regularized.hpp>
#include <taut/impl/energy/shape.hpp>
#include <taut/impl/energy/shape_power.hpp>
#include <taut/impl/energy/shell.hpp>
#include <taut/impl/symbolic/glm.hpp>
