// SPDX-License-Identifier: MIT
#pragma once

#include <span>

#include <taut/impl/core/solve/line/line_function.hpp>
#include <taut/solve_params.hpp>

namespace taut::solve::impl
{

/// Type-erased line function, so that the line searches are compiled once, whatever the objectives: a call costs
/// nothing beside an evaluation. Refers to the line.
class any_line
{
public:
    template <line_function Line>
    explicit any_line(Line& line) : line_(&line), calls_(&table<Line>)
    {
    }

    impl::line_point start() const { return calls_->start(line_); }
    double bound() const { return calls_->bound(line_); }
    double noise() const { return calls_->noise(line_); }
    double ceiling() const { return calls_->ceiling(line_); }
    int batch() const { return calls_->batch(line_); }
    double value(double a) { return calls_->value(line_, a); }
    void values(std::span<const double> a, std::span<double> out) { calls_->values(line_, a, out); }
    double value_gradient(double a) { return calls_->value_gradient(line_, a); }
    double slope() { return calls_->slope(line_); }
    impl::line_point best() const { return calls_->best(line_); }
    bool interrupted() const { return calls_->interrupted(line_); }

private:
    struct calls
    {
        impl::line_point (*start)(void*);
        double (*bound)(void*);
        double (*noise)(void*);
        double (*ceiling)(void*);
        int (*batch)(void*);
        double (*value)(void*, double);
        void (*values)(void*, std::span<const double>, std::span<double>);
        double (*value_gradient)(void*, double);
        double (*slope)(void*);
        impl::line_point (*best)(void*);
        bool (*interrupted)(void*);
    };

    template <class Line>
    static Line& as(void* line)
    {
        return *static_cast<Line*>(line);
    }

    template <class Line>
    static constexpr calls table = {[](void* l) { return impl::line_point(as<Line>(l).start()); },
                                    [](void* l) { return double(as<Line>(l).bound()); },
                                    [](void* l) { return double(as<Line>(l).noise()); },
                                    [](void* l) { return double(as<Line>(l).ceiling()); },
                                    [](void* l) { return int(as<Line>(l).batch()); },
                                    [](void* l, double a) { return double(as<Line>(l).value(a)); },
                                    [](void* l, std::span<const double> a, std::span<double> out)
                                    { as<Line>(l).values(a, out); },
                                    [](void* l, double a) { return double(as<Line>(l).value_gradient(a)); },
                                    [](void* l) { return double(as<Line>(l).slope()); },
                                    [](void* l) { return impl::line_point(as<Line>(l).best()); },
                                    [](void* l) { return bool(as<Line>(l).interrupted()); }};

    void* line_;
    const calls* calls_;
};

} // namespace taut::solve::impl
