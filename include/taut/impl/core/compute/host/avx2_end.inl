// SPDX-License-Identifier: MIT
} // namespace taut::impl::host_avx2
#ifdef __clang__
#pragma clang attribute pop
#else
#pragma GCC pop_options
#endif
#pragma GCC diagnostic pop
