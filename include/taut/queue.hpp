// SPDX-License-Identifier: MIT
#pragma once

/// Devices and command queues.
#include <taut/impl/compute/choose_device.hpp>
#include <taut/impl/compute/queue.hpp>
#include <taut/impl/compute/queue_counters.hpp>
