// SPDX-License-Identifier: MIT
// Makes kernels/*.cl C++, until as_opencl_code.inl.
#define __kernel
#define __global
#define __local
#define restrict __restrict
#define VECTOR(T) T
#define UNROLLED _Pragma("GCC unroll 16") for
#define PLAIN for
#define WHOLE_VECTORS
#define INDEPENDENT _Pragma("GCC ivdep")
#define SCRATCH(T, name, n) T* const name = static_cast<T*>(host_scratch((n) * sizeof(T)))
