// SPDX-License-Identifier: MIT
#include <taut/impl/charts/packing/certificate.ipp>
#include <taut/impl/charts/packing/pack.ipp>
