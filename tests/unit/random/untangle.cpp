// SPDX-License-Identifier: MIT
#include <algorithm>
#include <random>
#include <set>
#include <utility>
#include <vector>

#include <doctest/doctest.h>

#include <support/size.hpp>
#include <support/untangle_checks.hpp>
#include <taut/impl/core/start/barycentric_map.hpp>
#include <taut/impl/core/untangle/untangle_host.hpp>
#include <taut/untangle.hpp>

namespace
{

using namespace taut;
using namespace taut::impl;
using taut::idx;

/// Small disks of random connectivity and shape: a triangle that grew ears, filled notches and split triangles.
class random_disk
{
public:
    random_disk(std::mt19937& random, int steps) : random_(random)
    {
        for (int i = 0; i < steps; ++i) grow();
    }

    mesh<triangle> at_random_places()
    {
        std::normal_distribution<double> any;
        std::vector<vec3> points(static_cast<std::size_t>(vertices_));
        for (vec3& p : points) p = vec3(any(random_), any(random_), any(random_));
        return {std::move(points), cells_};
    }

private:
    std::size_t pick(std::size_t n) { return std::uniform_int_distribution<std::size_t>(0, n - 1)(random_); }

    void add(idx a, idx b, idx c)
    {
        cells_.push_back({a, b, c});
        for (const auto& [p, q] : {std::pair(a, b), std::pair(b, c), std::pair(c, a)})
            edges_.insert({std::min(p, q), std::max(p, q)});
    }

    void grow()
    {
        const std::size_t n = rim_.size(), i = pick(n);
        const idx a = rim_[i], b = rim_[(i + 1) % n], c = rim_[(i + 2) % n];
        switch (pick(3))
        {
        case 0: // an ear on the edge ab
            add(b, a, vertices_);
            rim_.insert(rim_.begin() + static_cast<std::ptrdiff_t>(i) + 1, vertices_++);
            break;
        case 1: // the notch at b
            if (n < 4 || edges_.contains({std::min(a, c), std::max(a, c)})) break;
            add(b, a, c);
            rim_.erase(rim_.begin() + static_cast<std::ptrdiff_t>((i + 1) % n));
            break;
        default: // a vertex inside a triangle
            const std::size_t k = pick(cells_.size());
            const auto t = cells_[k];
            cells_.erase(cells_.begin() + static_cast<std::ptrdiff_t>(k));
            for (std::size_t e = 0; e < 3; ++e) add(t[e], t[(e + 1) % 3], vertices_);
            ++vertices_;
        }
    }

    std::mt19937& random_;
    idx vertices_ = 3;
    std::vector<mesh<triangle>::cell> cells_{{0, 1, 2}};
    std::vector<idx> rim_{0, 1, 2};
    std::set<std::pair<idx, idx>> edges_{{0, 1}, {1, 2}, {0, 2}};
};

} // namespace

TEST_CASE("untangle: random pins on random disks end honestly, and those of a valid map are met")
{
    const int cases = test::sized(2000, 100, 20000);
    std::mt19937 random(7);
    std::uniform_real_distribution<double> chance(0, 1);
    std::normal_distribution<double> any;
    int possible = 0, solved = 0;
    for (int number = 0; number < cases; ++number)
    {
        CAPTURE(number);
        const auto m = random_disk(random, std::uniform_int_distribution<int>(0, 40)(random)).at_random_places();
        const auto valid = barycentric_map(m);
        untangle_problem<triangle> problem{m, valid.uv, {}};
        const double freedom = chance(random), noise = 10 * chance(random) * chance(random);
        const bool pins_fit = chance(random) < 0.6;
        problem.held = fixed_marks<2>(problem.initial.size());
        for (std::size_t v = 0; v < problem.initial.size(); ++v)
        {
            const auto held = chance(random) < freedom ? 0u : std::uniform_int_distribution<unsigned>(1, 3)(random);
            problem.held[v] = static_cast<std::uint8_t>(held);
            for (int k = 0; k < 2; ++k)
                if (!pins_fit || !problem.held.test(v, k)) problem.initial[v][k] += noise * any(random);
        }
        if (number % 50 == 0) std::fill(problem.initial.begin(), problem.initial.end(), vec2(0.0));
        untangle_params params; // a fraction of the effort that is usual
        params.tuning.first_round = 30;
        params.rounds = 1;
        const auto result = untangle(problem, params);
        test::check_typed(problem, result);
        if (!pins_fit || valid.flips.flipped > 0 || number % 50 == 0) continue;
        ++possible;
        solved += static_cast<bool>(result);
        CHECK(result.outcome != outcome::infeasible);
    }
    MESSAGE(cases, " cases, ", possible, " with pins of a valid map, of which ", solved, " were met");
    CHECK(solved >= 0.9 * possible);
    CHECK(possible > 0.3 * cases);
}
