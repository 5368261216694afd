// SPDX-License-Identifier: MIT
#pragma once

namespace taut::impl
{

/// The cube root as straight-line arithmetic that vectorises; the built-in one is a scalar call, and made an element
/// kernel with det^(2/3) 15 times slower on PoCL. Error below one unit in the last place over the whole range,
/// subnormal numbers included; 0, infinity and NaN map to themselves.
///
/// A third of the exponent, taken from the bits, gives r = s^(-1/3) to 3 %. With h = 1 - s r^3 the exact factor is
/// (1 - h)^(-1/3); three terms of its series raise the error to the fourth power. Then y = s r^2, and one Newton step.
inline constexpr const char* cbrt_f64_source = R"cl(
inline double taut_cbrt_f64(const double x)
{
    const double a = fabs(x);
    const bool tiny = a < 0x1p-1000;
    const double s = tiny ? a * 0x1p+54 : a;
    double r = as_double((long)(0x553ee8fc - (int)((float)(int)(as_long(s) >> 32) * (1.0f / 3))) << 32);
    double h = 1 - (s * r) * (r * r);
    r = r + r * h * (1.0 / 3 + h * (2.0 / 9 + h * (14.0 / 81)));
    h = 1 - (s * r) * (r * r);
    r = r + r * h * (1.0 / 3 + h * (2.0 / 9 + h * (14.0 / 81)));
    const double y = s * (r * r);
    const double z = y - (y * y * y - s) * (r * r) * (1.0 / 3);
    const double w = tiny ? z * 0x1p-18 : z;
    return ((a > 0) & (a < INFINITY)) ? (x < 0 ? -w : w) : x;
}
)cl";

inline constexpr const char* cbrt_f32_source = R"cl(
inline float taut_cbrt_f32(const float x)
{
    const float a = fabs(x);
    const bool tiny = a < 0x1p-100f;
    const float s = tiny ? a * 0x1p+24f : a;
    float r = as_float(0x54a1f28c - (int)((float)as_int(s) * (1.0f / 3)));
    const float h = 1 - (s * r) * (r * r);
    r = r + r * h * (1.0f / 3 + h * (2.0f / 9 + h * (14.0f / 81)));
    const float y = s * (r * r);
    const float z = y - (y * y * y - s) * (r * r) * (1.0f / 3);
    const float w = tiny ? z * 0x1p-8f : z;
    return ((a > 0) & (a < INFINITY)) ? (x < 0 ? -w : w) : x;
}
)cl";

} // namespace taut::impl
