// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <cstdlib>
#include <random>
#include <string>
#include <vector>

#include <support/size.hpp>
#include <taut/impl/core/compute/quirks.hpp>
#include <taut/impl/core/symbolic/scalar_type.hpp>
#include <taut/queue.hpp>

namespace taut::test
{

/// For tests that bring OpenCL C of their own: whether their device compiles it.
inline bool compiles_text()
{
    return !impl::quirks::compiles_no_text(find_device());
}

/// Whether a queue has built so many programs; on a device without a compiler it has built none.
inline bool has_built(const queue& q, std::uint64_t programs)
{
    return q.counters().builds == (impl::quirks::compiles_no_text(q.device()) ? 0 : programs);
}

/// sized() for counts of elements.
inline std::size_t sized_count(int usual, int small)
{
    return static_cast<std::size_t>(sized(usual, small));
}

template <class T>
std::vector<T> random_values(std::size_t n, unsigned seed)
{
    std::mt19937 generator(seed);
    std::normal_distribution<double> normal;
    std::vector<T> values(n);
    for (T& v : values) v = static_cast<T>(normal(generator));
    return values;
}

/// x as a device has it in `type`: narrowed to float and back, or x.
inline double as_real(scalar_type type, double x)
{
    return type == scalar_type::f32 ? static_cast<double>(static_cast<float>(x)) : x;
}

/// random_values<double>(), as a device has them in `type`.
inline std::vector<double> random_reals(scalar_type type, std::size_t n, unsigned seed)
{
    auto values = random_values<double>(n, seed);
    for (double& v : values) v = as_real(type, v);
    return values;
}

/// Sets an environment variable for the life of a scope.
class with_variable
{
public:
    with_variable(const char* name, const std::string& value) : name_(name)
    {
        if (const char* before = std::getenv(name)) before_ = before, had_ = true;
        ::setenv(name, value.c_str(), 1);
    }
    ~with_variable()
    {
        if (had_)
            ::setenv(name_, before_.c_str(), 1);
        else
            ::unsetenv(name_);
    }
    with_variable(const with_variable&) = delete;
    with_variable& operator=(const with_variable&) = delete;

private:
    const char* name_;
    std::string before_;
    bool had_ = false;
};

} // namespace taut::test
