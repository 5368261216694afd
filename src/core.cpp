// SPDX-License-Identifier: MIT
#include <taut/impl/compute/choose_device.ipp>
#include <taut/impl/compute/device.ipp>
#include <taut/impl/compute/queue.ipp>
#include <taut/impl/core/parallel.ipp>
#include <taut/impl/energy/default_energy.ipp>
