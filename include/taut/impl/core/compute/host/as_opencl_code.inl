// SPDX-License-Identifier: MIT
// Takes the macros of as_host_code.inl away.
#undef __kernel
#undef __global
#undef __local
#undef restrict
#undef VECTOR
#undef UNROLLED
#undef PLAIN
#undef WHOLE_VECTORS
#undef INDEPENDENT
#undef SCRATCH
