// SPDX-License-Identifier: MIT
// Sums, for each vertex, what the corners of its cells contribute: no atomics, so the order of additions is fixed.
//
// contributions[(corner * D + c) * cells + cell] is component c of a corner of a cell; a slot is the place
// corner * D * cells + cell, so that component c of it lies c * cells further on.
//
// Macros:
//   REAL   float or double, of the sums
//   FP64   1 where the device has double
//   V      vertices an item, side by side: 8 for CPUs, 1 for GPUs
//
// check: -DREAL=double -DFP64=1 -DV=8
// check: -DREAL=float -DFP64=1 -DV=8
// check: -DREAL=float -DFP64=0 -DV=1

#define CAT_(a, b) a##b
#define CAT(a, b) CAT_(a, b)
/// A vector of its lanes: a literal of OpenCL C, a constructor of C++.
#ifndef VECTOR
#define VECTOR(T) (T)
#endif

#if FP64
#pragma OPENCL EXTENSION cl_khr_fp64 : enable
#endif

#if V == 1
/// Vertices a slice: those of neighbouring items.
#define ROWS 32
#define SLOTS int
#define PARTS(T) T
#define LOAD_SLOTS(i) slots[i]
#define PART_OF(T, MASK, at, none) ((none) ? (T)0 : contributions[at])
#define STORE_SUM(sum, i) out[i] = (REAL)(sum)
#else
#define ROWS V
#define SLOTS int8
#define PARTS(T) CAT(T, 8)
#define LOAD_SLOTS(i) vload8(0, slots + (i))
#define PART_OF(T, MASK, at, none)                                                                                     \
    select(VECTOR(PARTS(T))(contributions[(at).s0], contributions[(at).s1], contributions[(at).s2],                    \
                            contributions[(at).s3], contributions[(at).s4], contributions[(at).s5],                    \
                            contributions[(at).s6], contributions[(at).s7]),                                           \
           (PARTS(T))(0), CAT(convert_, CAT(MASK, 8))(none))
#define STORE_SUM(sum, i) vstore8(CAT(convert_, CAT(REAL, 8))(sum), 0, out + (i))
#endif

/// Slots of vertices in slices of ROWS: slot j of vertex v at offsets[v / ROWS] + j * ROWS + v % ROWS, -1 for none. What
/// stands behind -1 may be anything, also not a number.
#define GATHER_CORNERS(TERM, MASK, D)                                                                                  \
    __kernel void gather_##TERM##_##D(const int vertices, const int cells, __global const int* restrict offsets,       \
                                      __global const int* restrict slots, __global const TERM* restrict contributions, \
                                      __global REAL* restrict out)                                                     \
    {                                                                                                                  \
        const int first = (int)get_global_id(0) * V, slice = first / ROWS, end = offsets[slice + 1];                   \
        PARTS(TERM) sum[D];                                                                                            \
        for (int c = 0; c < D; ++c) sum[c] = 0;                                                                        \
        for (int j = offsets[slice] + first % ROWS; j < end; j += ROWS)                                                \
        {                                                                                                              \
            const SLOTS slot = LOAD_SLOTS(j), place = max(slot, (SLOTS)(0));                                           \
            for (int c = 0; c < D; ++c) sum[c] += PART_OF(TERM, MASK, place + c * cells, slot < 0);                    \
        }                                                                                                              \
        for (int c = 0; c < D; ++c) STORE_SUM(sum[c], c * vertices + first);                                           \
    }

GATHER_CORNERS(float, int, 2)
GATHER_CORNERS(float, int, 3)
#if FP64
GATHER_CORNERS(double, long, 2)
GATHER_CORNERS(double, long, 3)
#endif
