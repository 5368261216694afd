// SPDX-License-Identifier: MIT
#include <taut/impl/dist/detail/session.ipp>
#include <taut/impl/dist/detail/smooth.ipp>
#include <taut/impl/dist/detail/check.ipp>
