// SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <string>

#include <nanobind/nanobind.h>

#include <taut/queue.hpp>

namespace taut::python
{

/// A queue of nobody else's, with the programs that it has built so far; for the next call when the last copy is gone.
/// device: its number or a part of its name; empty: as TAUT_DEVICE says, or the best one. Throws no_device.
std::shared_ptr<queue> borrow_queue(const std::string& device);

/// Lets go of all queues that nobody has, before the interpreter ends and drivers go.
void drop_queues();

void add_devices(nanobind::module_& m);

} // namespace taut::python
