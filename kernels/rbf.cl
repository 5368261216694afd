// SPDX-License-Identifier: MIT
// Fields of radial basis functions at many points, one an item.
//
// Macros:
//   REAL   float or double
//   PHI    which function: 0 -r, 1 r^3, 2 r^2 log r, 3 and 4 Wendland's C2 and C4 of s = r / radius
//
// check: -DREAL=double -DPHI=0
// check: -DREAL=double -DPHI=2
// check: -DREAL=float -DPHI=1
// check: -DREAL=float -DPHI=3
// check: -DREAL=float -DPHI=4

#ifdef cl_khr_fp64
#pragma OPENCL EXTENSION cl_khr_fp64 : enable
#endif

/// The function of r^2; `scale` is 1 / radius.
static REAL rbf_phi(const REAL r2, const REAL scale)
{
#if PHI == 0
    return -sqrt(r2);
#elif PHI == 1
    return r2 * sqrt(r2);
#elif PHI == 2
    return r2 > 0 ? (REAL)0.5 * r2 * log(r2) : 0;
#else
    const REAL s = scale * sqrt(r2), t = fmax((REAL)0, 1 - s), t2 = t * t;
#if PHI == 3
    return t2 * t2 * (4 * s + 1);
#else
    return t2 * t2 * t2 * ((35 * s + 18) * s + 3) / 3;
#endif
#endif
}

/// x: 3 numbers per point, as are centres and weights; polynomial: 4 rows of 3, of 1, x, y and z. Coordinates are
/// normalised.
__kernel void rbf_evaluate(const int count, const int centre_count, const REAL scale, __global const REAL* restrict x,
                           __global const REAL* restrict centres, __global const REAL* restrict weights,
                           __global const REAL* restrict polynomial, __global REAL* restrict out)
{
    const int i = (int)get_global_id(0);
    if (i >= count) return;
    const REAL px = x[3 * i], py = x[3 * i + 1], pz = x[3 * i + 2];
    REAL sx = polynomial[0] + px * polynomial[3] + py * polynomial[6] + pz * polynomial[9];
    REAL sy = polynomial[1] + px * polynomial[4] + py * polynomial[7] + pz * polynomial[10];
    REAL sz = polynomial[2] + px * polynomial[5] + py * polynomial[8] + pz * polynomial[11];
    for (int j = 0; j < centre_count; ++j)
    {
        const REAL dx = px - centres[3 * j], dy = py - centres[3 * j + 1], dz = pz - centres[3 * j + 2];
        const REAL phi = rbf_phi(dx * dx + dy * dy + dz * dz, scale);
        sx += phi * weights[3 * j];
        sy += phi * weights[3 * j + 1];
        sz += phi * weights[3 * j + 2];
    }
    out[3 * i] = sx;
    out[3 * i + 1] = sy;
    out[3 * i + 2] = sz;
}
