// SPDX-License-Identifier: MIT
// Vector updates: one element an item, in scalar loads and stores of stride 1, which every compiler vectorises.
// Vectors are padded to a multiple of the group size, so there is no bounds test; padding is zero and stays zero.
//
// Macros:
//   REAL   type of the vectors: float or double
//   FP64   1 where the device has double, for positions more precise than the vectors; 0 elsewhere
//
// check: -DREAL=double -DFP64=1
// check: -DREAL=float -DFP64=1
// check: -DREAL=float -DFP64=0

#if FP64
#pragma OPENCL EXTENSION cl_khr_fp64 : enable
#endif

/// y = a x
__kernel void scale(const REAL a, __global const REAL* x, __global REAL* y)
{
    const size_t i = get_global_id(0);
    y[i] = a * x[i];
}

/// y = a x + b y
__kernel void axpby(const REAL a, __global const REAL* x, const REAL b, __global REAL* y)
{
    const size_t i = get_global_id(0);
    y[i] = a * x[i] + b * y[i];
}

/// out = x + a d, a step from positions x along a direction d; x and out may be the same buffer.
__kernel void step_along_float(__global const float* x, const float a, __global const REAL* d, __global float* out)
{
    const size_t i = get_global_id(0);
    out[i] = x[i] + a * d[i];
}
#if FP64
__kernel void step_along_double(__global const double* x, const double a, __global const REAL* d, __global double* out)
{
    const size_t i = get_global_id(0);
    out[i] = x[i] + a * d[i];
}
#endif

/// out = a0 x0 + a1 x1 + ... over the first 2, 4 or 8 vectors; the others fill the signature. x0 may be out itself.
#define COMBINE(NAME, INTO_S)                                                                                          \
    __kernel void NAME(__global REAL* out, const REAL a0, __global const REAL* x0, const REAL a1,                      \
                       __global const REAL* x1, const REAL a2, __global const REAL* x2, const REAL a3,                 \
                       __global const REAL* x3, const REAL a4, __global const REAL* x4, const REAL a5,                 \
                       __global const REAL* x5, const REAL a6, __global const REAL* x6, const REAL a7,                 \
                       __global const REAL* x7)                                                                        \
    {                                                                                                                  \
        const size_t i = get_global_id(0);                                                                             \
        INTO_S                                                                                                         \
        out[i] = s;                                                                                                    \
    }

#define TWO REAL s = a0 * x0[i] + a1 * x1[i];
#define FOUR TWO s += a2 * x2[i] + a3 * x3[i];
#define EIGHT FOUR s += a4 * x4[i] + a5 * x5[i]; s += a6 * x6[i] + a7 * x7[i];

COMBINE(combine_2, TWO)
COMBINE(combine_4, FOUR)
COMBINE(combine_8, EIGHT)
