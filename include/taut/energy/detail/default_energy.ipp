// SPDX-License-Identifier: MIT
#pragma once

#include <taut/energy/any_energy.hpp>
#include <taut/energy/isometric.hpp>

namespace taut
{

any_energy default_energy()
{
    return energy::isometric{};
}

} // namespace taut
