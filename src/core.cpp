// SPDX-License-Identifier: MIT
#include <taut/impl/compute/detail/choose_device.ipp>
#include <taut/impl/compute/detail/device.ipp>
#include <taut/impl/compute/detail/queue.ipp>
#include <taut/impl/core/parallel.ipp>
#include <taut/impl/energy/default_energy.ipp>
