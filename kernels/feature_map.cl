// SPDX-License-Identifier: MIT
// Maps of features: positions over the plane in a grid of texels, four floats each: x, y, z and what is known there:
// 1 covered, -1 continued from covered ones, 0 nothing. Coordinates of the plane are in texels: the centre of texel
// (i, j) is (i + 0.5, j + 0.5).
//
// check: -DUNUSED

/// A vector of its lanes: a literal of OpenCL C, a constructor of C++.
#ifndef VECTOR
#define VECTOR(T) (T)
#endif

static float3 first3(const float4 a)
{
    return VECTOR(float3)(a.x, a.y, a.z);
}

/// A position and what is known there.
static float4 texel_of(const float3 p, const float known)
{
    return VECTOR(float4)(p.x, p.y, p.z, known);
}

/// Weights of the corners of a triangle at p; 6 numbers a triangle.
static float3 corner_weights(__global const float* restrict t, const float2 p)
{
    const float2 a = vload2(0, t), b = vload2(1, t) - a, c = vload2(2, t) - a, q = p - a;
    const float det = b.x * c.y - b.y * c.x;
    const float v = (q.x * c.y - q.y * c.x) / det, w = (b.x * q.y - b.y * q.x) / det;
    return VECTOR(float3)(1 - v - w, v, w);
}

/// Covers the texels whose centre is in a triangle; triangles of tile k are items[starts[k]] .. items[starts[k + 1] - 1].
/// What lies on an edge may be beyond it by rounding, hence the tolerance.
__kernel void map_cover(const int width, const int height, const int tile, const int tiles_across,
                        __global const int* restrict starts, __global const int* restrict items,
                        __global const float* restrict uv, __global const float* restrict positions,
                        __global float* restrict texels)
{
    const int at = (int)get_global_id(0), i = at % width, j = at / width;
    if (j >= height) return;
    const float2 p = VECTOR(float2)(i + 0.5f, j + 0.5f);
    const int k = j / tile * tiles_across + i / tile;
    float best = -1e-4f;
    float4 texel = (float4)(0);
    for (int n = starts[k]; n < starts[k + 1]; ++n)
    {
        const int f = items[n];
        const float3 w = corner_weights(uv + 6 * f, p);
        const float least = fmin(w.x, fmin(w.y, w.z));
        if (!(least > best)) continue;
        best = least;
        texel = texel_of(w.x * vload3(0, positions + 9 * f) + w.y * vload3(1, positions + 9 * f) +
                             w.z * vload3(2, positions + 9 * f),
                         1);
    }
    vstore4(texel, at, texels);
}

static float4 texel_at(__global const float* restrict texels, const int width, const int height, const int i, const int j)
{
    return i < 0 || j < 0 || i >= width || j >= height ? (float4)(0) : vload4(j * width + i, texels);
}

/// Continues what is known by one texel, linearly where two in a row are known, so that sampling near the rim sees no
/// emptiness.
__kernel void map_continue(const int width, const int height, __global const float* restrict from,
                           __global float* restrict to)
{
    const int at = (int)get_global_id(0), i = at % width, j = at / width;
    if (j >= height) return;
    float4 texel = vload4(at, from);
    if (texel.w == 0)
    {
        float3 sum = (float3)(0);
        float count = 0;
        for (int dj = -1; dj <= 1; ++dj)
            for (int di = -1; di <= 1; ++di)
            {
                const float4 near = texel_at(from, width, height, i + di, j + dj);
                if (near.w == 0) continue;
                const float4 next = texel_at(from, width, height, i + 2 * di, j + 2 * dj);
                sum += next.w == 0 ? first3(near) : 2 * first3(near) - first3(next);
                count += 1;
            }
        if (count > 0) texel = texel_of(sum / count, -1);
    }
    vstore4(texel, at, to);
}

/// Bilinear in the texels around p.
static float3 sampled(__global const float* restrict texels, const int width, const int height, const float2 p)
{
    const float2 q = clamp(p - 0.5f, (float2)(0), VECTOR(float2)(width - 1, height - 1));
    const int i = min((int)q.x, width - 2), j = min((int)q.y, height - 2);
    const float s = q.x - i, t = q.y - j;
    const int at = j * width + i;
    return (1 - t) * ((1 - s) * first3(vload4(at, texels)) + s * first3(vload4(at + 1, texels))) +
           t * ((1 - s) * first3(vload4(at + width, texels)) + s * first3(vload4(at + width + 1, texels)));
}

/// Positions at points of the plane.
__kernel void map_sample(const int count, const int width, const int height, __global const float* restrict texels,
                         __global const float* restrict points, __global float* restrict positions)
{
    const int n = (int)get_global_id(0);
    if (n < count) vstore3(sampled(texels, width, height, vload2(n, points)), n, positions);
}

static float apart(const float3 a, const float3 b)
{
    const float3 d = a - b;
    return sqrt(d.x * d.x + d.y * d.y + d.z * d.z);
}

/// How far the map is from bilinear in each square cell of `size` texels, of `across` a row: the largest distance at its
/// middle and the middles of its sides. Cells that see nothing covered are 0.
__kernel void map_roughness(const int width, const int height, const int size, const int across, const int count,
                            __global const float* restrict texels, __global float* restrict roughness)
{
    const int n = (int)get_global_id(0);
    if (n >= count) return;
    const float2 low = VECTOR(float2)(n % across * size, n / across * size);
    const float h = 0.5f * size;
    float3 x[9];
    int covered = 0;
    for (int k = 0; k < 9; ++k)
    {
        const float2 p = low + h * VECTOR(float2)(k % 3, k / 3);
        x[k] = sampled(texels, width, height, p);
        covered += texel_at(texels, width, height, min((int)p.x, width - 1), min((int)p.y, height - 1)).w == 1;
    }
    float worst = apart(x[4], 0.25f * (x[0] + x[2] + x[6] + x[8]));
    worst = fmax(worst, apart(x[1], 0.5f * (x[0] + x[2])));
    worst = fmax(worst, apart(x[3], 0.5f * (x[0] + x[6])));
    worst = fmax(worst, apart(x[5], 0.5f * (x[2] + x[8])));
    worst = fmax(worst, apart(x[7], 0.5f * (x[6] + x[8])));
    roughness[n] = covered == 0 ? 0 : worst;
}
