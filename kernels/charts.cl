// SPDX-License-Identifier: MIT
// Newton's method for many small maps at once, one group of TEAM work-items a chart: TEAM = 1 on CPUs.
//
// What belongs to a chart lies in one piece of each array, and its triangles and vertices are numbered from 0 there.
// layout: 4 numbers a chart: first triangle and vertex of its pieces, number of triangles, number of vertices; an odd
// number of vertices is followed by an idle one.
// Arrays of triangles are structures of arrays, STRIDE(triangles) apart.
//
// The Hessian is banded after reordering, and stored by panels of two vertices, that is four columns: panel p of a
// chart has them one after the other from A + offsets[p], heights[p] numbers each (a multiple of 4), from its own first
// row on. Heights are such that the rows of a panel reach no further than those of the next. Its L D L' has
// L D below the diagonal and 1 / D, or 0 for a direction without stiffness, on it.
//
// The formulas of triangles are functions that are recorded (kernel_form::part) and stand before this text.
//
// Macros: REAL float or double; TEAM; EPSILON relative shift of the diagonal.
//
// check: -DALONE -DREAL=double -DTEAM=1 -DEPSILON=1e-11
// check: -DALONE -DREAL=float -DTEAM=64 -DEPSILON=1e-5f

#ifdef ALONE
#define INPUTS                                                                                                         \
    __global const int *corners, __global const REAL *inverse, __global const REAL *measure,                           \
        __global const REAL *weight, __global const REAL *x, const int cell_stride, const int vertex_stride
void element_gradient(INPUTS, __global REAL* energy, __global REAL* corner_gradient, int first, int last, int step);
void element_hessian(INPUTS, int definiteness, __global REAL* hessian, int first, int last, int step);
void element_first_flip(INPUTS, __global const REAL* d, __global REAL* flip, int first, int last, int step);
void element_along(INPUTS, __global const REAL* d, __global const REAL* unit, __global REAL* energy, REAL step0,
                   REAL step1, REAL step2, REAL step3, int first, int last, int step);
#endif

#if TEAM > 1
#define EACH(i, from, to) for (int i = (from) + LANE; i < (to); i += TEAM)
#define LANE ((int)get_local_id(0))
#define BARRIER barrier(CLK_LOCAL_MEM_FENCE | CLK_GLOBAL_MEM_FENCE)
#else
#ifndef INDEPENDENT
#define INDEPENDENT _Pragma("clang loop vectorize(assume_safety) vectorize_width(4)")
#endif
#define EACH(i, from, to) INDEPENDENT for (int i = (from); i < (to); ++i)
#define LANE 0
#define BARRIER
#endif
#define CAT_(a, b) a##b
#define CAT(a, b) CAT_(a, b)
#define REAL4 CAT(REAL, 4)
/// A vector of its lanes: a literal of OpenCL C, a constructor of C++.
#ifndef VECTOR
#define VECTOR(T) (T)
#endif
/// Not a multiple of large powers of 2, which the sets of a cache would not like.
#define STRIDE(n) (((n) + 7) / 8 * 8 + 4)

/// Of all lanes, in their order.
static REAL4 team_sum(const REAL4 mine, __local REAL4* parts)
{
#if TEAM > 1
    BARRIER;
    parts[LANE] = mine;
    BARRIER;
    REAL4 sum = parts[0];
    for (int i = 1; i < TEAM; ++i) sum += parts[i];
    return sum;
#else
    return mine;
#endif
}

static REAL team_min(REAL mine, __local REAL4* parts)
{
#if TEAM > 1
    BARRIER;
    parts[LANE].x = mine;
    BARRIER;
    for (int i = 0; i < TEAM; ++i) mine = fmin(mine, parts[i].x);
#endif
    return mine;
}

static REAL4 sums_of_energies(const int cells, __global const REAL* energies, __local REAL4* parts)
{
    const int stride = STRIDE(cells);
    REAL4 sum = 0;
    for (int c = LANE; c < cells; c += TEAM)
        sum += VECTOR(REAL4)(energies[c], energies[c + stride], energies[c + 2 * stride], energies[c + 3 * stride]);
    return team_sum(sum, parts);
}

/// The columns of the Hessian and the negative gradient, a vertex a lane.
static void assemble(const int vertices, const int cells, __global const int* corners, __global const int* fan_starts,
                     __global const int* fans, __global const int* offsets, __global const int* heights,
                     __global const REAL* gradient, __global const REAL* hessian, __global REAL* A,
                     __global REAL* rhs)
{
    const int stride = STRIDE(cells), firsts[3][3] = {{0, 3, 7}, {3, 11, 14}, {7, 14, 18}}; // hessian_slots<2>
    for (int v = LANE; v < vertices; v += TEAM)
    {
        const int height = heights[v / 2];
        __global REAL* x = A + offsets[v / 2] + v % 2 * 2 * height;
        __global REAL* y = x + height;
        for (int r = 0; r < height; ++r) x[r] = y[r] = 0;
        REAL gx = 0, gy = 0;
        for (int i = fan_starts[v]; i < fan_starts[v + 1]; ++i)
        {
            const int cell = fans[i] / 3, k = fans[i] % 3;
            gx += gradient[cell + 2 * k * stride];
            gy += gradient[cell + (2 * k + 1) * stride];
            for (int l = 0; l < 3; ++l)
            {
                const int row = 2 * corners[cell + l * stride] - 4 * (v / 2);
                if (row < v % 2 * 2) continue;
                __global const REAL* H = hessian + cell + firsts[k][l] * stride;
                const int xy = l < k ? 2 : 1, yx = l == k ? 1 : 3 - xy, yy = l == k ? 2 : 3;
                x[row] += H[0];
                x[row + 1] += H[xy * stride];
                y[row] += H[yx * stride];
                y[row + 1] += H[yy * stride];
            }
        }
        const int row = v % 2 * 2;
        const bool used = fan_starts[v] < fan_starts[v + 1];
        x[row] = used ? x[row] * (1 + EPSILON) : 1;
        y[row + 1] = used ? y[row + 1] * (1 + EPSILON) : 1;
        rhs[2 * v] = -gx;
        rhs[2 * v + 1] = -gy;
    }
}

static REAL inverse_pivot(const REAL d)
{
    return d > 0 ? 1 / d : 0;
}

/// A = L D L', rhs = L^-1 rhs. Returns rhs' A^-1 rhs, or -1, and nothing else of use, where a pivot is not positive: of
/// all but the last three unknowns, which moving and turning the map leaves open, and for `semidefinite` of none.
static REAL factorize(const int vertices, const int semidefinite, __global const int* offsets,
                      __global const int* heights, __global REAL* A, __global REAL* rhs)
{
    const int panels = (vertices + 1) / 2, open = semidefinite ? 0 : 2 * vertices - 3;
    REAL square = 0;
    for (int p = 0; p < panels; ++p)
    {
        const int height = heights[p];
        __global REAL *A0 = A + offsets[p], *A1 = A0 + height, *A2 = A1 + height, *A3 = A2 + height;
        __global REAL* b = rhs + 4 * p;

        // The block on the diagonal, by every lane.
        REAL m10 = A0[1], m20 = A0[2], m30 = A0[3], m21 = A1[2], m31 = A1[3], m32 = A2[3];
        REAL m11 = A1[1], m22 = A2[2], m33 = A3[3], y0 = b[0], y1 = b[1], y2 = b[2], y3 = b[3];
        const REAL d0 = inverse_pivot(A0[0]), f10 = m10 * d0, f20 = m20 * d0, f30 = m30 * d0;
        m11 -= f10 * m10, m21 -= f10 * m20, m31 -= f10 * m30, m22 -= f20 * m20, m32 -= f20 * m30, m33 -= f30 * m30;
        const REAL d1 = inverse_pivot(m11), f21 = m21 * d1, f31 = m31 * d1;
        m22 -= f21 * m21, m32 -= f21 * m31, m33 -= f31 * m31;
        const REAL d2 = inverse_pivot(m22), f32 = m32 * d2;
        m33 -= f32 * m32;
        const REAL d3 = inverse_pivot(m33);
        if ((d0 == 0 && 4 * p < open) || (d1 == 0 && 4 * p + 1 < open) || (d2 == 0 && 4 * p + 2 < open) ||
            (d3 == 0 && 4 * p + 3 < open))
            return -1;
        y1 -= f10 * y0;
        y2 -= f20 * y0 + f21 * y1;
        y3 -= f30 * y0 + f31 * y1 + f32 * y2;
        const REAL z0 = y0 * d0, z1 = y1 * d1, z2 = y2 * d2, z3 = y3 * d3;
        square += y0 * z0 + y1 * z1 + y2 * z2 + y3 * z3;
        BARRIER;
        if (LANE == 0)
        {
            A0[0] = d0, A1[1] = d1, A2[2] = d2, A3[3] = d3;
            A1[2] = m21, A1[3] = m31, A2[3] = m32;
            b[1] = y1, b[2] = y2, b[3] = y3;
        }
        EACH (r, 4, height)
        {
            const REAL a0 = A0[r], a1 = A1[r] - f10 * a0, a2 = A2[r] - f20 * a0 - f21 * a1;
            const REAL a3 = A3[r] - f30 * a0 - f31 * a1 - f32 * a2;
            A1[r] = a1;
            A2[r] = a2;
            A3[r] = a3;
            b[r] -= (a0 * z0 + a1 * z1) + (a2 * z2 + a3 * z3);
        }
        BARRIER;

        // What is left of the panels that these columns reach.
        for (int s = 4; s < height; s += 4)
        {
            const int q = p + s / 4, below = heights[q];
            __global REAL *B0 = A + offsets[q], *B1 = B0 + below, *B2 = B1 + below, *B3 = B2 + below;
            const REAL g00 = A0[s] * d0, g01 = A1[s] * d1, g02 = A2[s] * d2, g03 = A3[s] * d3;
            const REAL g10 = A0[s + 1] * d0, g11 = A1[s + 1] * d1, g12 = A2[s + 1] * d2, g13 = A3[s + 1] * d3;
            const REAL g20 = A0[s + 2] * d0, g21 = A1[s + 2] * d1, g22 = A2[s + 2] * d2, g23 = A3[s + 2] * d3;
            const REAL g30 = A0[s + 3] * d0, g31 = A1[s + 3] * d1, g32 = A2[s + 3] * d2, g33 = A3[s + 3] * d3;
            EACH (r, 0, height - s)
            {
                const REAL a0 = A0[s + r], a1 = A1[s + r], a2 = A2[s + r], a3 = A3[s + r];
                B0[r] -= (g00 * a0 + g01 * a1) + (g02 * a2 + g03 * a3);
                B1[r] -= (g10 * a0 + g11 * a1) + (g12 * a2 + g13 * a3);
                B2[r] -= (g20 * a0 + g21 * a1) + (g22 * a2 + g23 * a3);
                B3[r] -= (g30 * a0 + g31 * a1) + (g32 * a2 + g33 * a3);
            }
        }
        BARRIER;
    }
    return square;
}

/// rhs = L'^-1 D^-1 rhs
static void substitute(const int panels, __global const int* offsets, __global const int* heights,
                       __global const REAL* A, __global REAL* rhs, __local REAL4* parts)
{
    for (int p = panels - 1; p >= 0; --p)
    {
        const int height = heights[p];
        __global const REAL *A0 = A + offsets[p], *A1 = A0 + height, *A2 = A1 + height, *A3 = A2 + height;
        __global REAL* b = rhs + 4 * p;
        REAL4 s0 = 0, s1 = 0, s2 = 0, s3 = 0;
        for (int r = 4 + 4 * LANE; r < height; r += 4 * TEAM)
        {
            const REAL4 x = vload4(0, b + r);
            s0 += vload4(0, A0 + r) * x;
            s1 += vload4(0, A1 + r) * x;
            s2 += vload4(0, A2 + r) * x;
            s3 += vload4(0, A3 + r) * x;
        }
        const REAL4 mine = VECTOR(REAL4)(s0.x + s0.y + s0.z + s0.w, s1.x + s1.y + s1.z + s1.w, s2.x + s2.y + s2.z + s2.w,
                                   s3.x + s3.y + s3.z + s3.w);
        const REAL4 below = team_sum(mine, parts);
        if (LANE == 0)
        {
            const REAL x3 = (b[3] - below.w) * A3[3];
            const REAL x2 = (b[2] - below.z - A2[3] * x3) * A2[2];
            const REAL x1 = (b[1] - below.y - A1[2] * x2 - A1[3] * x3) * A1[1];
            b[0] = (b[0] - below.x - A0[1] * x1 - A0[2] * x2 - A0[3] * x3) * A0[0];
            b[1] = x1, b[2] = x2, b[3] = x3;
        }
        BARRIER;
    }
}

/// One step of each active chart. values: 4 a chart: the energy before the step, the decrease that Newton's model
/// predicts, the length of the step, steps to wait before the Hessian itself is tried again. states: GOING, or why the
/// chart is done. before: the last map. one: the number 1.
#define GOING 0
#define CONVERGED 1
#define STUCK 2
__kernel void chart_newton(__global const int* active, __global const int* layout, __global const int* corners,
                           __global const REAL* inverse, __global const REAL* measure, __global const REAL* weight,
                           __global const int* fan_starts, __global const int* fans, __global const int* offsets,
                           __global const int* heights, const REAL tolerance, __global const REAL* one,
                           __global REAL* x, __global REAL* before, __global REAL* d, __global REAL* rhs,
                           __global REAL* energies, __global REAL* gradient, __global REAL* hessian, __global REAL* A,
                           __global REAL* values, __global int* states)
{
    __local REAL4 parts[TEAM];
    const int chart = active[get_group_id(0)];
    const int first = layout[4 * chart], base = layout[4 * chart + 1];
    const int cells = layout[4 * chart + 2], used = layout[4 * chart + 3], vertices = (used + 1) / 2 * 2;
    const int stride = STRIDE(cells);
    corners += 3 * first, inverse += 3 * first, measure += first, weight += first;
    energies += 4 * first, gradient += 6 * first, hessian += 21 * first;
    x += 2 * base, before += 2 * base, d += 2 * base, rhs += 2 * base;
    fan_starts += base + chart, offsets += base / 2, heights += base / 2, values += 4 * chart;
#define ELEMENTS corners, inverse, measure, weight, x, stride, vertices
#define CELLS LANE, cells, TEAM

    element_gradient(ELEMENTS, energies, gradient, CELLS);
    BARRIER;
    const REAL value = sums_of_energies(cells, energies, parts).x;
    if (!(value < INFINITY))
    {
        // Rounding took the last step over the barrier.
        EACH (i, 0, 2 * vertices) x[i] = before[i];
        if (LANE == 0) states[chart] = STUCK;
        return;
    }
    // The Hessian itself, where it is positive definite: near a minimum, and each fourth step.
    const int wait = (int)values[3];
    REAL square = -1;
    int projected = wait > 0;
    for (;; projected = 1)
    {
        element_hessian(ELEMENTS, projected, hessian, CELLS);
        BARRIER;
        assemble(vertices, cells, corners, fan_starts, fans, offsets, heights, gradient, hessian, A, rhs);
        BARRIER;
        square = factorize(used, projected, offsets, heights, A, rhs);
        BARRIER;
        if (square >= 0 || projected) break;
    }
    substitute(vertices / 2, offsets, heights, A, rhs, parts);
    EACH (v, 0, vertices)
    {
        d[v] = rhs[2 * v];
        d[v + vertices] = rhs[2 * v + 1];
    }
    BARRIER;

    // The best of four lengths, up to 0.9 of the way to the first flip, or of shorter and shorter ones. Near the
    // barrier Newton's step only multiplies the distance to it by 4/3, and a projected Hessian is too stiff: longer
    // ones are tried there.
    element_first_flip(ELEMENTS, d, energies, CELLS);
    BARRIER;
    REAL flip = INFINITY;
    for (int c = LANE; c < cells; c += TEAM) flip = fmin(flip, energies[c]);
    const bool near = square > (REAL)0.4 * value;
    const REAL ratio = near ? (REAL)0.25 : (REAL)0.5, most = near ? 64 : projected ? 4 : 1;
    REAL longest = fmin(most, (REAL)0.9 * team_min(flip, parts)), step = 0, best = value;
    for (int round = 0; round < 8 && step == 0; ++round)
    {
        REAL lengths[4];
        for (int k = 0; k < 4; ++k, longest *= ratio) lengths[k] = longest;
        element_along(ELEMENTS, d, one, energies, lengths[0], lengths[1], lengths[2], lengths[3], CELLS);
        BARRIER;
        const REAL4 there = sums_of_energies(cells, energies, parts);
        const REAL trials[4] = {there.x, there.y, there.z, there.w};
        for (int k = 0; k < 4; ++k)
            if (trials[k] < best && trials[k] <= value - (REAL)1e-4 * fmin(lengths[k], (REAL)1) * square)
            {
                best = trials[k];
                step = lengths[k];
            }
        BARRIER;
    }
    EACH (i, 0, 2 * vertices)
    {
        before[i] = x[i];
        x[i] += step * d[i];
    }
    BARRIER;
    if (LANE == 0)
    {
        // What a projected Hessian predicts near a saddle is far too little: a minimum is seen by the Hessian itself.
        const REAL predicted = (REAL)0.5 * square;
        const bool small = !(predicted > tolerance * value);
        const bool done = small && (!projected || !(predicted > (REAL)0.01 * tolerance * value));
        values[0] = value;
        values[1] = predicted;
        values[2] = step;
        values[3] = !projected || (small && wait > 0) ? 0 : wait > 0 ? wait - 1 : 3;
        states[chart] = done ? CONVERGED : step > 0 ? GOING : STUCK;
    }
}
