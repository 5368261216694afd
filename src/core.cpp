// SPDX-License-Identifier: MIT
#include <taut/compute/detail/choose_device.ipp>
#include <taut/compute/detail/device.ipp>
#include <taut/compute/detail/queue.ipp>
#include <taut/core/detail/parallel.ipp>
#include <taut/energy/detail/default_energy.ipp>
