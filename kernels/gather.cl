// SPDX-License-Identifier: MIT
// Sums, for each vertex, what the corners of its cells contribute: no atomics, so the order of additions is fixed.
//
// contributions[(corner * D + c) * cells + cell] is component c of a corner of a cell; a slot is the place
// corner * D * cells + cell, so that component c of it lies c * cells further on.
//
// Macros:
//   REAL   float or double, of the sums
//   FP64   1 where the device has double
//
// check: -DREAL=double -DFP64=1
// check: -DREAL=float -DFP64=0

#if FP64
#pragma OPENCL EXTENSION cl_khr_fp64 : enable
#endif

/// The first W slots of each vertex, in columns: slots[j * vertices + v], -1 for none. A fixed count without branches is
/// what compilers vectorise; the slots of neighbouring vertices are neighbours.
#define GATHER(TERM, D, W)                                                                                             \
    __kernel void gather_##TERM##_##D##x##W(const int vertices, const int cells, __global const int* restrict slots,   \
                                            __global const TERM* restrict contributions, __global REAL* restrict out)  \
    {                                                                                                                  \
        const int v = (int)get_global_id(0);                                                                           \
        TERM sum[D];                                                                                                   \
        _Pragma("unroll") for (int c = 0; c < D; ++c) sum[c] = 0;                                                      \
        _Pragma("unroll") for (int j = 0; j < W; ++j)                                                                  \
        {                                                                                                              \
            const int slot = slots[j * vertices + v];                                                                  \
            const int place = max(slot, 0);                                                                            \
            _Pragma("unroll") for (int c = 0; c < D; ++c)                                                              \
            {                                                                                                          \
                const TERM value = contributions[place + c * cells];                                                   \
                sum[c] += slot < 0 ? (TERM)0 : value;                                                                  \
            }                                                                                                          \
        }                                                                                                              \
        _Pragma("unroll") for (int c = 0; c < D; ++c) out[c * vertices + v] = (REAL)sum[c];                            \
    }

/// The rest of the few vertices with more than W slots: rows of slots from offsets[i] to offsets[i + 1], added to what
/// the first step left in the D components of vertex which[i].
#define GATHER_REST(TERM)                                                                                              \
    __kernel void gather_rest_##TERM(const int components, const int vertices, const int cells, const int rows,        \
                                     __global const int* restrict which, __global const int* restrict offsets,         \
                                     __global const int* restrict slots, __global const TERM* restrict contributions,  \
                                     __global REAL* restrict out)                                                      \
    {                                                                                                                  \
        const int i = (int)get_global_id(0);                                                                           \
        if (i >= rows) return;                                                                                         \
        const int v = which[i];                                                                                        \
        for (int c = 0; c < components; ++c)                                                                           \
        {                                                                                                              \
            TERM sum = out[c * vertices + v];                                                                          \
            for (int k = offsets[i]; k < offsets[i + 1]; ++k) sum += contributions[slots[k] + c * cells];              \
            out[c * vertices + v] = (REAL)sum;                                                                         \
        }                                                                                                              \
    }

// The widths that gather.hpp chooses from.
#define GATHERS(TERM, D)                                                                                               \
    GATHER(TERM, D, 4)                                                                                                 \
    GATHER(TERM, D, 6)                                                                                                 \
    GATHER(TERM, D, 8)                                                                                                 \
    GATHER(TERM, D, 10)                                                                                                \
    GATHER(TERM, D, 12)                                                                                                \
    GATHER(TERM, D, 16)                                                                                                \
    GATHER(TERM, D, 24)                                                                                                \
    GATHER(TERM, D, 32)                                                                                                \
    GATHER(TERM, D, 48)

GATHERS(float, 2)
GATHERS(float, 3)
GATHER_REST(float)
#if FP64
GATHERS(double, 2)
GATHERS(double, 3)
GATHER_REST(double)
#endif
