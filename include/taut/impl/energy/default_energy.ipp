// SPDX-License-Identifier: MIT
#pragma once

#include <taut/impl/energy/any_energy.hpp>
#include <taut/impl/energy/isometric.hpp>

namespace taut::impl
{

any_energy default_energy()
{
    return energy::isometric{};
}

} // namespace taut::impl
