// SPDX-License-Identifier: MIT
// The functions of OpenCL C that taut's own programs call, as its header declares them: for drivers that read the 900 kB
// of that header at each build (program_cache).
//
// check: -D_OPENCL_H_

#ifdef cl_khr_fp64
#pragma OPENCL EXTENSION cl_khr_fp64 : enable
#endif

#define TAUT_PURE __attribute__((overloadable, pure))
#define TAUT_CONST __attribute__((overloadable, const))

size_t TAUT_CONST get_global_id(uint);
size_t TAUT_CONST get_local_id(uint);
size_t TAUT_CONST get_group_id(uint);
size_t TAUT_CONST get_num_groups(uint);
void __attribute__((overloadable, convergent)) barrier(cl_mem_fence_flags);

/// Of integers.
#define TAUT_INTEGER(I)                                                                                                \
    I TAUT_CONST min(I, I);                                                                                            \
    I TAUT_CONST max(I, I);                                                                                            \
    I TAUT_CONST select(I, I, I);
/// Of reals; I: integers of their size; TEST: what comparisons give.
#define TAUT_REAL(R, I, TEST)                                                                                          \
    R TAUT_CONST fabs(R);                                                                                              \
    R TAUT_CONST floor(R);                                                                                             \
    R TAUT_CONST sqrt(R);                                                                                              \
    R TAUT_CONST rsqrt(R);                                                                                             \
    R TAUT_CONST exp(R);                                                                                               \
    R TAUT_CONST log(R);                                                                                               \
    R TAUT_CONST sin(R);                                                                                               \
    R TAUT_CONST cos(R);                                                                                               \
    R TAUT_CONST tan(R);                                                                                               \
    R TAUT_CONST atan(R);                                                                                              \
    R TAUT_CONST pow(R, R);                                                                                            \
    R TAUT_CONST fmin(R, R);                                                                                           \
    R TAUT_CONST fmax(R, R);                                                                                           \
    R TAUT_CONST min(R, R);                                                                                            \
    R TAUT_CONST max(R, R);                                                                                            \
    R TAUT_CONST clamp(R, R, R);                                                                                       \
    R TAUT_CONST select(R, R, I);                                                                                      \
    TEST TAUT_CONST isfinite(R);                                                                                       \
    TEST TAUT_CONST isnan(R);                                                                                          \
    TEST TAUT_CONST isless(R, R);

#define TAUT_MEMORY_IN(SPACE, T, N)                                                                                    \
    T##N TAUT_PURE vload##N(size_t, const SPACE T*);                                                                   \
    void __attribute__((overloadable)) vstore##N(T##N, size_t, SPACE T*);
#define TAUT_MEMORY(T, N)                                                                                              \
    TAUT_MEMORY_IN(__global, T, N)                                                                                     \
    TAUT_MEMORY_IN(__local, T, N)                                                                                      \
    TAUT_MEMORY_IN(__private, T, N)
#define TAUT_CONVERSIONS(TO, N)                                                                                        \
    TO##N TAUT_CONST convert_##TO##N(int##N);                                                                          \
    TO##N TAUT_CONST convert_##TO##N(float##N);                                                                        \
    TAUT_DOUBLE(TO##N TAUT_CONST convert_##TO##N(double##N);)

#ifdef cl_khr_fp64
#define TAUT_DOUBLE(...) __VA_ARGS__
#else
#define TAUT_DOUBLE(...)
#endif
#define TAUT_WIDTH(N)                                                                                                  \
    TAUT_INTEGER(int##N)                                                                                               \
    TAUT_REAL(float##N, int##N, int##N)                                                                                \
    TAUT_MEMORY(int, N)                                                                                                \
    TAUT_MEMORY(float, N)                                                                                              \
    TAUT_CONVERSIONS(int, N)                                                                                           \
    TAUT_CONVERSIONS(long, N)                                                                                          \
    TAUT_CONVERSIONS(float, N)                                                                                         \
    TAUT_DOUBLE(TAUT_REAL(double##N, long##N, long##N))                                                                \
    TAUT_DOUBLE(TAUT_MEMORY(double, N))                                                                                \
    TAUT_DOUBLE(TAUT_CONVERSIONS(double, N))

TAUT_INTEGER(int)
TAUT_INTEGER(uint)
TAUT_INTEGER(long)
TAUT_INTEGER(ulong)
ulong TAUT_CONST clz(ulong);
TAUT_REAL(float, int, int)
TAUT_DOUBLE(TAUT_REAL(double, long, int))
TAUT_WIDTH(2)
TAUT_WIDTH(3)
TAUT_WIDTH(4)
TAUT_WIDTH(8)
TAUT_WIDTH(16)
