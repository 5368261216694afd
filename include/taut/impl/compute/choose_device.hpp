// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <taut/impl/compute/device.hpp>
#include <taut/impl/compute/errors.hpp>

namespace taut
{

/// Requirements on a device.
struct device_requirements
{
    bool fp64 = false;        ///< double precision is a must; without it fp64 is only preferred
    std::uint64_t memory = 0; ///< bytes of global memory
};

} // namespace taut

namespace taut::impl
{

/// A device of this machine, and why it cannot serve; an empty refusal means that it can.
struct listed_device
{
    taut::device device;
    std::string refusal;
};

/// Why d does not meet the needs, in words; empty if it does.
std::string device_refusal(const device& d, const device_requirements& needs = {});

/// find_device(), of a wish that the message of no_device calls `said` and the wish: "--device Tesla".
device find_device(const std::string& wish, const device_requirements& needs, const std::string& said);

} // namespace taut::impl

namespace taut
{

/// Every device of every platform, in the order of the driver loader: TAUT_DEVICE counts them in this order, from 0.
std::vector<impl::listed_device> devices(const device_requirements& needs = {});

/// The device that a wish names: an index into devices(), or a part of a device's, vendor's or platform's name, in any
/// case. Of several that fit, and for an empty wish, the best one: double precision before none, then GPU before CPU,
/// then the largest. With TAUT_FORM=gpu it is taken for a GPU. Throws no_device if none fits.
device find_device(const std::string& wish, const device_requirements& needs = {});

/// The device that TAUT_DEVICE names if it is set, else the best one.
device find_device(const device_requirements& needs = {});

} // namespace taut

#ifdef TAUT_IMPLEMENTATION
#include <taut/impl/compute/choose_device.ipp>
#endif
