// SPDX-License-Identifier: MIT
#pragma once

#include <taut/any_energy.hpp>
#include <taut/energies.hpp>

namespace taut
{

any_energy default_energy()
{
    return energy::isometric{};
}

} // namespace taut
