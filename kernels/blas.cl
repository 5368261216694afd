// SPDX-License-Identifier: MIT
// Vector updates. Vectors are padded to a multiple of the group size, so there is no bounds test; padding is zero and
// stays zero.
//
// Macros:
//   REAL   type of the vectors: float or double
//   FP64   1 where the device has double, for positions more precise than the vectors; 0 elsewhere
//   V      elements an item of `combine`: 8 or 1
//
// check: -DREAL=double -DFP64=1 -DV=8
// check: -DREAL=float -DFP64=1 -DV=8
// check: -DREAL=float -DFP64=0 -DV=1

#define CAT_(a, b) a##b
#define CAT(a, b) CAT_(a, b)

#if FP64
#pragma OPENCL EXTENSION cl_khr_fp64 : enable
#endif

/// out = x + a d, a step from positions x along a direction d, one element an item; x and out may be the same buffer.
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

#if V == 1
#define PART REAL
#define LOAD_PART(x) ((x)[i])
#define STORE_PART(value, x) (x)[i] = (value)
#else
#define PART CAT(REAL, 8)
#define LOAD_PART(x) vload8(i, x)
#define STORE_PART(value, x) vstore8(value, i, x)
#endif

/// out = a0 x0 + a1 x1 + ... over the first `count` vectors, V elements an item; the others fill the signature and are
/// not read. out may be one of them.
__kernel void combine(const int count, __global REAL* out, const REAL a0, __global const REAL* x0, const REAL a1,
                      __global const REAL* x1, const REAL a2, __global const REAL* x2, const REAL a3,
                      __global const REAL* x3, const REAL a4, __global const REAL* x4, const REAL a5,
                      __global const REAL* x5, const REAL a6, __global const REAL* x6, const REAL a7,
                      __global const REAL* x7)
{
    const size_t i = get_global_id(0);
    PART s = a0 * LOAD_PART(x0);
    if (count > 1) s += a1 * LOAD_PART(x1);
    if (count > 2) s += a2 * LOAD_PART(x2);
    if (count > 3) s += a3 * LOAD_PART(x3);
    if (count > 4) s += a4 * LOAD_PART(x4);
    if (count > 5) s += a5 * LOAD_PART(x5);
    if (count > 6) s += a6 * LOAD_PART(x6);
    if (count > 7) s += a7 * LOAD_PART(x7);
    STORE_PART(s, out);
}
