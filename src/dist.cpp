// SPDX-License-Identifier: MIT
#include <taut/impl/dist/detail/session.ipp>
