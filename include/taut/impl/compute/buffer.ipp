// SPDX-License-Identifier: MIT
#pragma once

#include <taut/impl/compute/buffer.hpp>

namespace taut
{

template class buffer<float>;
template class buffer<double>;
template class buffer<idx>;

} // namespace taut
