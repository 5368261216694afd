// SPDX-License-Identifier: MIT
} // namespace taut::impl::host_baseline
#if defined(__GNUC__)
#pragma GCC diagnostic pop
#endif
