// SPDX-License-Identifier: MIT
// Untangling by topological operators (paper, Algorithm 2): vertices of inverted elements move along the gradient of
// their determinants. An iteration is three launches: elements, decide, move. What the schedule decides stays here, so
// that the host looks at the state now and then only.
//
// Arrays are structures of arrays: coordinate c of vertex v at x[c * vertices + v], corner k of cell f at
// corners[k * cells + f]; both strides are padded, and there is at least one cell of padding.
//
// Macros:
//   D      2 or 3
//   L, V   items a group and elements an item does at once. (1, 16): CPUs, explicit vectors. (256, 1): GPUs.
//   C      rows a slice of the vertices' lists: 16 on CPUs, 32 on GPUs
//
// check: -DD=2 -DL=1 -DV=16 -DC=16
// check: -DD=3 -DL=1 -DV=16 -DC=16
// check: -DD=2 -DL=256 -DV=1 -DC=32
// check: -DD=3 -DL=128 -DV=1 -DC=32

#ifndef UNROLLED
#define UNROLLED _Pragma("unroll") for
#endif
/// A vector of its lanes: a literal of OpenCL C, a constructor of C++.
#ifndef VECTOR
#define VECTOR(T) (T)
#endif

#if V == 1
#define REALV float
#define INTV int
#define LOAD(p, i) (p)[i]
#define STORE(v, p, i) (p)[i] = (v)
#define GATHER(p, at) (p)[at]
#define WHERE(test, yes, no) ((test) ? (yes) : (no))
#define LANES 0
#define ONE_WHERE(test) ((test) ? 1 : 0)
#define FOLD(s) (s)
#else
#define REALV float16
#define INTV int16
#define LOAD(p, i) vload16(0, (p) + (i))
#define STORE(v, p, i) vstore16(v, 0, (p) + (i))
#define GATHER(p, at)                                                                                                  \
    VECTOR(REALV)                                                                                                      \
    ((p)[(at).s0], (p)[(at).s1], (p)[(at).s2], (p)[(at).s3], (p)[(at).s4], (p)[(at).s5], (p)[(at).s6],                 \
            (p)[(at).s7], (p)[(at).s8], (p)[(at).s9], (p)[(at).sa], (p)[(at).sb], (p)[(at).sc], (p)[(at).sd],          \
            (p)[(at).se], (p)[(at).sf])
#define WHERE(test, yes, no) select((REALV)(no), (REALV)(yes), test)
#define LANES VECTOR(INTV)(0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15)
#define ONE_WHERE(test) (-(test))
#define FOLD_8(s) ((((s).s0 + (s).s1) + ((s).s2 + (s).s3)) + (((s).s4 + (s).s5) + ((s).s6 + (s).s7)))
#define FOLD(s) FOLD_8((s).lo + (s).hi)
#endif

/// The state of a run, which only decide() writes; numbers as their bits.
enum
{
    STOP,          ///< why the run ended: one of the reasons below
    ITERATION,     ///< moves made
    IMPROVED,      ///< the state at hand is the best so far: move() keeps it
    INVERTED,      ///< elements with det <= 0
    BELOW,         ///< elements with det <= goal
    BEST_INVERTED, ///< the same of the best state
    BEST_BELOW,
    BEST_ITERATION,
    STREAK, ///< increases in a row
    DELTA,  ///< float: length of the next step
    VALUE   ///< float: sum of margin - det over the elements below the margin
};
enum
{
    RUNNING,
    UNTANGLED,
    SHORT_STEP,
    NOT_FINITE
};

#if D == 2
#define DOT(a, b) ((a)[0] * (b)[0] + (a)[1] * (b)[1])
#else
#define DOT(a, b) ((a)[0] * (b)[0] + (a)[1] * (b)[1] + (a)[2] * (b)[2])

inline void cross_product(const REALV* a, const REALV* b, REALV* c)
{
    c[0] = a[1] * b[2] - a[2] * b[1];
    c[1] = a[2] * b[0] - a[0] * b[2];
    c[2] = a[0] * b[1] - a[1] * b[0];
}
#endif

/// The direction of corner k: the gradient of det (eqs. 23 to 25) and, where the corner leans over the end of the
/// opposite facet, `shear` times a vector of the same length along the facet, towards its middle (Fig. 10). In space
/// both are brought to a fifth of the square root of their length: a length again and not an area, or large elements
/// overshoot and the map blows up; and a vertex has some five times as many elements as in the plane.
inline void direction(const REALV x[D + 1][D], const int k, const REALV shear, REALV* d)
{
#if D == 2
    const int i = (k + 1) % 3, j = (k + 2) % 3;
    REALV e[2], from[2], to[2];
    UNROLLED (int c = 0; c < 2; ++c)
    {
        e[c] = x[j][c] - x[i][c];
        from[c] = x[k][c] - x[i][c];
        to[c] = x[k][c] - x[j][c];
    }
    const REALV along = WHERE(DOT(from, e) < 0, shear, WHERE(DOT(to, e) > 0, -shear, (REALV)0));
    d[0] = along * e[0] - e[1];
    d[1] = along * e[1] + e[0];
#else
    // The facet opposite k, its normal m pointing out of the element.
    const int facets[4][3] = {{1, 2, 3}, {0, 3, 2}, {0, 1, 3}, {0, 2, 1}};
    REALV u[3], v[3], w[3], uv[3], vw[3], wu[3], m[3], t[3];
    UNROLLED (int c = 0; c < 3; ++c)
    {
        u[c] = x[facets[k][0]][c] - x[k][c];
        v[c] = x[facets[k][1]][c] - x[k][c];
        w[c] = x[facets[k][2]][c] - x[k][c];
        t[c] = u[c] + v[c] + w[c];
    }
    cross_product(u, v, uv);
    cross_product(v, w, vw);
    cross_product(w, u, wu);
    UNROLLED (int c = 0; c < 3; ++c) m[c] = uv[c] + vw[c] + wu[c];
    const REALV tiny = (REALV)1e-30f, squared = fmax(DOT(m, m), tiny);
    // Barycentric coordinates of the corner's foot on the facet, but for a positive factor.
    const REALV least = fmin(DOT(m, uv), fmin(DOT(m, vw), DOT(m, wu)));
    const REALV height = DOT(t, m) / squared;
    UNROLLED (int c = 0; c < 3; ++c) t[c] -= height * m[c];
    const REALV along = WHERE(least < 0, shear * sqrt(squared / fmax(DOT(t, t), tiny)), (REALV)0);
    const REALV shorter = 0.2f * rsqrt(sqrt(squared));
    UNROLLED (int c = 0; c < 3; ++c) d[c] = shorter * (along * t[c] - m[c]);
#endif
}

/// contributions[(k * D + c) * cells + f] = the direction of corner k of cell f, 0 where det > margin; and of each
/// group the sum of margin - det over the others, the elements with det <= 0 and those with det <= goal, at
/// partials[{0, 1, 2} * groups]. 0 <= goal <= margin.
/// A group does `block` cells from group * block on; count are not padding.
__kernel void untangle_elements(const int count, const int cells, const int vertices, const int block,
                                const float margin, const float goal, const float inverse_beta, const float shear,
                                __global const int* restrict state, __global const int* restrict corners,
                                __global const float* restrict x, __global float* restrict contributions,
                                __global float* restrict partials)
{
    const int group = (int)get_group_id(0), groups = (int)get_num_groups(0), lid = (int)get_local_id(0);
    REALV value = 0;
    INTV inverted = 0, below = 0;
    if (state[STOP] == RUNNING)
        for (int f = group * block + lid * V; f < min((group + 1) * block, cells); f += L * V)
        {
            REALV p[D + 1][D];
            UNROLLED (int k = 0; k <= D; ++k)
            {
                const INTV v = LOAD(corners, k * cells + f);
                UNROLLED (int c = 0; c < D; ++c) p[k][c] = GATHER(x + c * vertices, v);
            }
            REALV a[D][D];
            UNROLLED (int k = 0; k < D; ++k)
                UNROLLED (int c = 0; c < D; ++c) a[k][c] = p[k + 1][c] - p[0][c];
#if D == 2
            const REALV det = a[0][0] * a[1][1] - a[0][1] * a[1][0];
#else
            REALV n[3];
            cross_product(a[0], a[1], n);
            const REALV det = DOT(n, a[2]);
#endif
            // NaN is inverted, too.
            const INTV inside = f + LANES < count, moved = inside && !(det > margin);
            value += WHERE(moved, margin - det, (REALV)0);
            inverted += ONE_WHERE(inside && !(det > 0));
            below += ONE_WHERE(inside && !(det > goal));
            const REALV factor = shear * fmax(1 - fabs(det) * inverse_beta, (REALV)0); // eq. 26
            UNROLLED (int k = 0; k <= D; ++k)
            {
                REALV d[D];
                direction(p, k, factor, d);
                UNROLLED (int c = 0; c < D; ++c)
                    STORE(WHERE(moved, d[c], (REALV)0), contributions, (k * D + c) * cells + f);
            }
        }
#if L == 1
    partials[group] = FOLD(value);
    partials[groups + group] = (float)FOLD(inverted);
    partials[2 * groups + group] = (float)FOLD(below);
#else
    __local float shared[3 * L];
    shared[lid] = value;
    shared[L + lid] = (float)inverted;
    shared[2 * L + lid] = (float)below;
    barrier(CLK_LOCAL_MEM_FENCE);
    if (lid < 3)
    {
        float s0 = 0, s1 = 0;
        for (int i = 0; i < L; i += 2)
        {
            s0 += shared[lid * L + i];
            s1 += shared[lid * L + i + 1];
        }
        partials[lid * groups + group] = s0 + s1;
    }
#endif
}

/// Ends the iteration's count and decides on the step: shorter by half after `patience` increases in a row (Algorithm
/// 2, lines 8 to 10; patience 0: never). One group.
__kernel void untangle_decide(const int groups, const int patience, const float least_delta,
                              __global const float* restrict partials, __global int* restrict state)
{
    const int lid = (int)get_local_id(0);
    float value = 0;
    int inverted = 0, below = 0;
    for (int g = lid; g < groups; g += L)
    {
        value += partials[g];
        inverted += (int)partials[groups + g];
        below += (int)partials[2 * groups + g];
    }
#if L > 1
    __local float values[L];
    __local int counts[2 * L];
    values[lid] = value;
    counts[lid] = inverted;
    counts[L + lid] = below;
    barrier(CLK_LOCAL_MEM_FENCE);
    if (lid > 0) return;
    for (int i = 1; i < L; ++i)
    {
        value += values[i];
        inverted += counts[i];
        below += counts[L + i];
    }
#endif
    if (state[STOP] != RUNNING) return;

    state[INVERTED] = inverted;
    state[BELOW] = below;
    const int improved =
        inverted < state[BEST_INVERTED] || (inverted == state[BEST_INVERTED] && below < state[BEST_BELOW]);
    state[IMPROVED] = improved;
    if (improved)
    {
        state[BEST_INVERTED] = inverted;
        state[BEST_BELOW] = below;
        state[BEST_ITERATION] = state[ITERATION];
    }

    const int streak = value >= as_float(state[VALUE]) ? state[STREAK] + 1 : 0;
    const int halve = patience > 0 && streak >= patience;
    const float delta = as_float(state[DELTA]) * (halve ? 0.5f : 1.0f);
    state[STREAK] = halve ? 0 : streak;
    state[DELTA] = as_int(delta);
    state[VALUE] = as_int(value);
    const int stop = below == 0                ? UNTANGLED
                     : !isfinite(value)        ? NOT_FINITE
                     : !(delta >= least_delta) ? SHORT_STEP
                                               : RUNNING;
    state[STOP] = stop;
    state[ITERATION] += stop == RUNNING;
}

/// Keeps x in best if it is, then x += delta * the sum of what the corners contribute, where not held: bit c of held
/// says that coordinate c is. Lists of places of contributions in slices, as in block_sparse.cl; what is missing names
/// a place of padding, whose contribution is 0.
__kernel void untangle_move(const int cells, const int vertices, __global const int* restrict state,
                            __global const int* restrict offsets, __global const int* restrict places,
                            __global const int* restrict held, __global const float* restrict contributions,
                            __global float* restrict x, __global float* restrict best)
{
    const int slice = (int)get_global_id(0) / (C / V), lane = (int)get_global_id(0) % (C / V);
    const int row = slice * C + lane * V;
    if (state[IMPROVED]) UNROLLED (int c = 0; c < D; ++c) STORE(LOAD(x, c * vertices + row), best, c * vertices + row);
    if (state[STOP] != RUNNING) return;
    REALV sum[D];
    UNROLLED (int c = 0; c < D; ++c) sum[c] = 0;
    const int end = offsets[slice + 1];
    for (int at = offsets[slice]; at < end; at += C)
    {
        const INTV place = LOAD(places, at + lane * V);
        UNROLLED (int c = 0; c < D; ++c) sum[c] += GATHER(contributions + c * cells, place);
    }
    const float delta = as_float(state[DELTA]);
    const INTV fixed = LOAD(held, row);
    UNROLLED (int c = 0; c < D; ++c)
    {
        const REALV from = LOAD(x, c * vertices + row);
        STORE(WHERE((fixed & (1 << c)) != 0, from, from + delta * sum[c]), x, c * vertices + row);
    }
}
