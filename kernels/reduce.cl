// SPDX-License-Identifier: MIT
// First stage of the deterministic reductions. Each work-group reduces one contiguous block of a vector to one partial;
// the host adds the partials in their order. Which item takes which element is fixed, so results repeat bit for bit.
//
// Macros:
//   REAL   element type: float or double
//   FP64   1 where the device has double: accumulators are double, else float
//   L, V   items a group and elements a load. (1, 8): a CPU, where an item is one long serial run through memory.
//          (256, 1): a GPU, where neighbouring items take neighbouring elements, and one barrier joins them.
//
// check: -DREAL=double -DFP64=1 -DL=1 -DV=8
// check: -DREAL=float -DFP64=1 -DL=1 -DV=8
// check: -DREAL=double -DFP64=1 -DL=256 -DV=1
// check: -DREAL=float -DFP64=0 -DL=128 -DV=1

#define CAT_(a, b) a##b
#define CAT(a, b) CAT_(a, b)

#if FP64
#pragma OPENCL EXTENSION cl_khr_fp64 : enable
#define SUM double
#else
#define SUM float
#endif

#if V == 1
#define SUMV SUM
#define LOAD(p, i) ((SUM)(p)[i])
#define FOLD(s) (s)
#else
#define SUMV CAT(SUM, 8)
#define LOAD(p, i) CAT(convert_, SUMV)(vload8(i, p))
#define FOLD(s) ((((s).s0 + (s).s1) + ((s).s2 + (s).s3)) + (((s).s4 + (s).s5) + ((s).s6 + (s).s7)))
#endif

/// A loop as it stands. On CPUs compilers take longer for copies of it, for vectors and for counts, than these save.
#ifndef PLAIN
#if V == 1
#define PLAIN for
#else
#define PLAIN _Pragma("clang loop vectorize(disable) interleave(disable) unroll(disable)") for
#endif
#endif

/// Joins `count` of at most K values of each of the items of a group, column by column: one barrier.
#if L == 1
#define JOIN(K, count, items, value, out)                                                                              \
    PLAIN (uint k = 0; k < (count); ++k) (out)[k * groups] = (value)[k];
#else
#define JOIN(K, count, items, value, out)                                                                              \
    __local SUM shared[(K) * (items)];                                                                                 \
    for (uint k = 0; k < (count); ++k) shared[k * (items) + lid] = (value)[k];                                         \
    barrier(CLK_LOCAL_MEM_FENCE);                                                                                      \
    for (int k = lid; k < (int)(count); k += (items))                                                                  \
    {                                                                                                                  \
        SUM s0 = 0, s1 = 0, s2 = 0, s3 = 0;                                                                            \
        for (int i = 0; i < (items); i += 4)                                                                           \
        {                                                                                                              \
            s0 += shared[k * (items) + i];                                                                             \
            s1 += shared[k * (items) + i + 1];                                                                         \
            s2 += shared[k * (items) + i + 2];                                                                         \
            s3 += shared[k * (items) + i + 3];                                                                         \
        }                                                                                                              \
        (out)[k * groups] = (s0 + s1) + (s2 + s3);                                                                     \
    }
#endif

/// Elements of a block whose products with all others are summed before the next ones are loaded: they stay in the cache.
#define CHUNK 1024
/// Items of `dots`: 16 KB of local memory at most.
#define TEAM (L > 128 ? 128 : L)

/// partials[first + k * groups + group] = the group's share of the dot product k = l * right + r of vectors of n
/// elements. block: elements a group, a multiple of V. Only the first `left` and `right` vectors are read; the others
/// fill the signature.
__kernel void dots(const uint n, const uint block, const uint groups, const uint first, const uint left,
                   const uint right, __global SUM* partials, __global const REAL* a0, __global const REAL* a1,
                   __global const REAL* a2, __global const REAL* a3, __global const REAL* b0, __global const REAL* b1,
                   __global const REAL* b2, __global const REAL* b3)
{
    __global const REAL* const a[4] = {a0, a1, a2, a3};
    __global const REAL* const b[4] = {b0, b1, b2, b3};
    const uint group = get_group_id(0);
    const int lid = (int)get_local_id(0);
    const uint begin = min(group * block, n), end = min(begin + block, n);

    SUM total[16];
    for (int k = 0; k < 16; ++k) total[k] = 0;
    for (uint from = begin; from < end; from += CHUNK)
    {
        const uint to = min(from + CHUNK, end), vend = to / V;
        for (uint k = 0; k < left * right; ++k)
        {
            __global const REAL* x = a[k / right];
            __global const REAL* y = b[k % right];
            // Independent accumulators hide the latency of the additions.
            SUMV s0 = 0, s1 = 0, s2 = 0, s3 = 0;
            uint i = from / V + (uint)lid;
            for (; i + 3 * TEAM < vend; i += 4 * TEAM)
            {
                s0 += LOAD(x, i) * LOAD(y, i);
                s1 += LOAD(x, i + TEAM) * LOAD(y, i + TEAM);
                s2 += LOAD(x, i + 2 * TEAM) * LOAD(y, i + 2 * TEAM);
                s3 += LOAD(x, i + 3 * TEAM) * LOAD(y, i + 3 * TEAM);
            }
            PLAIN (; i < vend; i += TEAM) s0 += LOAD(x, i) * LOAD(y, i);
            s0 = (s0 + s1) + (s2 + s3);
            SUM sum = FOLD(s0);
#if V > 1
            PLAIN (uint t = vend * V; t < to; ++t) sum += (SUM)x[t] * (SUM)y[t];
#endif
            total[k] += sum;
        }
    }
    JOIN(16, left * right, TEAM, total, partials + first + group)
}

/// Sums of segments of x: segment k is the n elements from start + k * stride. The launch has groups groups for each
/// segment; partials[first + k * groups + g] is the share of block g.
__kernel void sums(const uint n, const uint block, const uint groups, const uint first, __global SUM* partials,
                   __global const REAL* x, const ulong start, const ulong stride)
{
    const uint segment = get_group_id(0) / groups, group = get_group_id(0) % groups;
    const int lid = (int)get_local_id(0);
    const uint begin = min(group * block, n), end = min(begin + block, n);
    __global const REAL* from = x + start + segment * stride + begin;
    const uint vend = (end - begin) / V;

    SUMV s0 = 0, s1 = 0, s2 = 0, s3 = 0;
    uint i = (uint)lid;
    for (; i + 3 * L < vend; i += 4 * L)
    {
        s0 += LOAD(from, i);
        s1 += LOAD(from, i + L);
        s2 += LOAD(from, i + 2 * L);
        s3 += LOAD(from, i + 3 * L);
    }
    PLAIN (; i < vend; i += L) s0 += LOAD(from, i);
    s0 = (s0 + s1) + (s2 + s3);
    SUM total[1] = {FOLD(s0)};
#if V > 1
    PLAIN (uint t = vend * V; t < end - begin; ++t) total[0] += from[t];
#endif
    JOIN(1, 1, L, total, partials + first + segment * groups + group)
}

/// The smaller of two numbers; NaN if either is: fmin would hide it.
#define LESS(a, b) ((b) < (a) || (b) != (b) ? (b) : (a))

/// partials[first + group] = the smallest element of the group's block; NaN as soon as one is NaN.
__kernel void minima(const uint n, const uint block, const uint first, __global SUM* partials, __global const REAL* x,
                     const ulong start)
{
    const uint group = get_group_id(0);
    const uint begin = min(group * block, n), end = min(begin + block, n);
    __global const REAL* from = x + start + begin;
    const uint vend = (end - begin) / V;

    SUM least = INFINITY;
#if V == 1
    const uint lid = get_local_id(0);
    for (uint i = lid; i < vend; i += L) least = LESS(least, (SUM)from[i]);
#else
    SUMV m = (SUMV)(INFINITY);
    for (uint i = 0; i < vend; ++i)
    {
        const SUMV c = LOAD(from, i);
        m = select(m, c, isless(c, m) | isnan(c));
    }
    const SUM e[8] = {m.s0, m.s1, m.s2, m.s3, m.s4, m.s5, m.s6, m.s7};
    for (int k = 0; k < 8; ++k) least = LESS(least, e[k]);
    PLAIN (uint t = vend * V; t < end - begin; ++t) least = LESS(least, (SUM)from[t]);
#endif
#if L == 1
    partials[first + group] = least;
#else
    __local SUM shared[L];
    shared[lid] = least;
    barrier(CLK_LOCAL_MEM_FENCE);
    if (lid == 0)
    {
        for (int i = 1; i < L; ++i) least = LESS(least, shared[i]);
        partials[first + group] = least;
    }
#endif
}

/// out[0] = min(most, fraction * the smallest of count partials), so that a limit that one reduction found steers the
/// next launch without the host. NaN stays NaN. A single item.
__kernel void limit(const uint first, const uint count, __global const SUM* partials, const SUM fraction,
                    const SUM most, __global REAL* out)
{
    SUM least = INFINITY;
    for (uint i = first; i < first + count; ++i) least = LESS(least, partials[i]);
    const SUM bound = fraction * least;
    if (get_global_id(0) == 0) out[0] = (REAL)(bound >= most ? most : bound);
}
