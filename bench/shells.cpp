// SPDX-License-Identifier: MIT
// Surfaces in space that are bent, twisted and lifted by three handle regions: the first 8 % of the vertices along the
// longest axis are held, the last 8 % moved, and where they are lifted the middle too. Steps, seconds and how much
// edges change, as a thin shell and as rigid as possible; then a drag, frame by frame.
//   taut_bench_shells [--thickness T] [--frame MS] MESH...
// thickness: by the length of the surface along that axis.
#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <filesystem>
#include <iterator>
#include <numeric>
#include <random>
#include <string>
#include <vector>

#include <taut/certify.hpp>
#include <taut/deform.hpp>
#include <taut/impl/core/exact/collapses.hpp>
#include <taut/impl/core/measure/shape_quality.hpp>
#include <taut/surface_file.hpp>

#include "rigid_as_possible.hpp"

namespace
{

using namespace taut;
using namespace taut::impl;
using taut::idx;

double now()
{
    return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

/// A surface with its handles.
class handled
{
public:
    enum motion
    {
        bend,
        twist,
        lift
    };
    static constexpr std::array<const char*, 3> names{"bend", "twist", "lift"};

    explicit handled(const mesh<triangle>& m) : points_(m.points())
    {
        vec3 low = points_[0], high = low;
        for (const vec3& p : points_) low = glm::min(low, p), high = glm::max(high, p);
        const vec3 size = high - low;
        middle_ = (low + high) / 2.0;
        axis_ = size.x > size.y && size.x > size.z ? 0 : size.y > size.z ? 1 : 2;
        length = size[axis_];
        for (const vec3& p : points_)
        {
            const double share = (p[axis_] - low[axis_]) / length;
            part_.push_back(share < 0.08 ? 'a' : share > 0.92 ? 'c' : std::abs(share - 0.5) < 0.01 ? 'b' : ' ');
        }
    }

    /// The handles where a share of a motion has brought them.
    void place(motion kind, double share, std::vector<idx>& who, std::vector<vec3>& where) const
    {
        who.clear();
        where.clear();
        for (std::size_t v = 0; v < points_.size(); ++v)
        {
            if (part_[v] == ' ' || (part_[v] == 'b' && kind != lift)) continue;
            vec3 p = points_[v];
            const int side = (axis_ + 1) % 3;
            if (kind == lift)
                p[side] += (part_[v] == 'a' ? 0.0 : part_[v] == 'b' ? 0.1 : 0.2) * share * length;
            else if (part_[v] == 'c')
                p = middle_ + turned(p - middle_, kind == bend ? side : axis_, share * (kind == bend ? 1.0 : 1.5));
            who.push_back(static_cast<idx>(v));
            where.push_back(p);
        }
    }

    double length = 0;

private:
    static vec3 turned(const vec3& d, int axis, double angle)
    {
        const int i = (axis + 1) % 3, j = (axis + 2) % 3;
        vec3 r = d;
        r[i] = std::cos(angle) * d[i] - std::sin(angle) * d[j];
        r[j] = std::sin(angle) * d[i] + std::cos(angle) * d[j];
        return r;
    }

    std::vector<vec3> points_;
    std::vector<char> part_;
    vec3 middle_{0.0};
    int axis_ = 0;
};

/// Root of the mean square of the edges' relative changes, in per cent.
double edge_change(const mesh<triangle>& m, const std::vector<vec3>& x)
{
    double sum = 0;
    for (const auto& t : m.cells())
        for (std::size_t k = 0; k < 3; ++k)
        {
            const auto a = static_cast<std::size_t>(t[k]), b = static_cast<std::size_t>(t[(k + 1) % 3]);
            const double change = glm::distance(x[a], x[b]) / glm::distance(m.points()[a], m.points()[b]) - 1;
            sum += change * change;
        }
    return 100 * std::sqrt(sum / (3.0 * static_cast<double>(m.cells().size())));
}

/// Frames of a session: milliseconds, and how the shape moves.
class frames
{
public:
    explicit frames(session<hinge>& s) : session_(s), before_(s.solve().x) {}

    session_result<hinge> solve(std::chrono::duration<double> time)
    {
        const double begin = now();
        auto r = session_.solve({.time = time});
        seconds_.push_back(now() - begin);
        late += r.report.pins_held ? 0 : 1;
        for (std::size_t v = 0; v < r.x.size(); ++v) farthest = std::max(farthest, glm::distance(r.x[v], before_[v]));
        least_area = std::min(least_area, r.report.flips.min_det);
        before_ = r.x;
        return r;
    }

    double median() const { return sorted()[seconds_.size() / 2]; }
    double longest() const { return sorted().back(); }
    std::size_t count() const { return seconds_.size(); }

    double farthest = 0, least_area = INFINITY;
    int late = 0;

private:
    std::vector<double> sorted() const
    {
        auto all = seconds_;
        std::sort(all.begin(), all.end());
        for (double& t : all) t *= 1e3;
        return all;
    }

    session<hinge>& session_;
    std::vector<vec3> before_;
    std::vector<double> seconds_;
};

struct setting
{
    double thickness = 0.013;
    std::chrono::duration<double> frame{0.05};
    int pins = 0, frames = 60;
    double waves = 0.05;
};

void lead_many(queue& q, const mesh<triangle>& m, const thin_shell& shell, const handled& handles, const setting& how)
{
    vec3 low = m.points()[0], high = low;
    for (const vec3& p : m.points()) low = glm::min(low, p), high = glm::max(high, p);
    const vec3 size = high - low;
    const double amplitude = how.waves * std::min({size.x, size.y, size.z});
    std::vector<idx> all(m.points().size()), who;
    std::iota(all.begin(), all.end(), 0);
    std::sample(all.begin(), all.end(), std::back_inserter(who), how.pins, std::mt19937(1));
    session<hinge> s(q, shell, {.thickness = how.thickness * handles.length});
    std::vector<vec3> where;
    const auto lead = [&](double part)
    {
        where.clear();
        for (const idx v : who)
        {
            vec3 p = m.points()[static_cast<std::size_t>(v)];
            const vec3 at = (p - low) / size * 9.0;
            p += part * amplitude * vec3(std::sin(at.y), std::sin(at.z), std::sin(at.x));
            where.push_back(p);
        }
        s.move(who, where);
    };
    lead(0);
    frames f(s);
    const int moved = how.frames, most = moved + 400;
    std::printf("  %d pins, ahead by the amplitude:", how.pins);
    for (int k = 1; k <= moved; ++k)
    {
        lead(double(k) / moved);
        const auto r = f.solve(how.frame);
        if (k % 10 == 0 || moved < 10) std::printf(" %.2g", r.report.distance / amplitude);
    }
    const int late = f.late;
    session_result<hinge> r;
    do r = f.solve(how.frame);
    while (!r.report.pins_held && static_cast<int>(f.count()) < most);
    std::printf(
        "\n  pins behind in %d of %d frames, %s after %d at rest, there at energy %.6g; median %.1f ms, longest %.1f "
        "ms; areas from %.2g\n",
        late, moved, r.report.pins_held ? "there" : "NOT there", static_cast<int>(f.count()) - moved, r.report.energy,
        f.median(), f.longest(), f.least_area);
    int steps = 0;
    const double begin = now();
    while (!r.report.converged && now() < begin + 60) steps += (r = s.solve()).report.steps;
    std::printf("  %s after %d steps more, energy %.6g\n", r.report.converged ? "converged" : "NOT converged", steps,
                r.report.energy);
}

void run(const std::string& path, const setting& how)
{
    const auto m = io::read_surface(path);
    queue q;
    const thin_shell shell(m);
    const double share = how.thickness;
    const handled handles(m);
    std::printf("%s: %d vertices, %d triangles, thickness %.2f mean edges\n",
                std::filesystem::path(path).filename().c_str(), m.vertex_count(), m.cell_count(),
                share * handles.length / shell.mean_edge());
    if (how.pins > 0) return lead_many(q, m, shell, handles, how);
    std::vector<idx> who;
    std::vector<vec3> where;
    deform(q, shell, {.thickness = share * handles.length}); // what drivers compile
    for (const auto kind : {handled::bend, handled::twist, handled::lift})
    {
        handles.place(kind, 1, who, where);
        auto pins = taut::constraints(shell.hinges());
        pins.repin(who, where);
        double begin = now();
        const auto r = deform(q, shell, {.constraints = pins, .thickness = share * handles.length});
        const double seconds = now() - begin;
        int follow = 0, minimise = 0;
        for (const auto& stage : r.report.stages) (stage.stage == "follow" ? follow : minimise) += stage.iterations;
        std::printf("  %-5s shell: %2d + %2d steps, %s, %6.2f s, edges %.2f %%, areas %.2f .. %.2f\n",
                    handled::names[kind], follow, minimise, r.report.converged ? "converged" : "not converged", seconds,
                    edge_change(m, r.x), r.report.flips.min_det, r.report.flips.max_det);
        begin = now();
        const auto rigid = bench::rigid_as_possible(m, pins).solve(1e-5 * handles.length, 500);
        std::printf("        as rigid as possible: %d steps, %6.2f s, edges %.2f %%, areas from %.2g\n",
                    rigid.iterations, now() - begin, edge_change(m, rigid.x),
                    certify_surface(m.cells(), m.points(), rigid.x).min_det);
        std::fflush(stdout);
    }

    session<hinge> s(q, shell, {.thickness = share * handles.length});
    const auto lead = [&](double part)
    {
        handles.place(handled::bend, part, who, where);
        s.move(who, where);
    };
    lead(0);
    frames f(s);
    constexpr int count = 60;
    for (int k = 1; k <= count; ++k)
    {
        lead(double(k) / count);
        f.solve(how.frame);
    }
    std::printf(
        "  drag  %d frames of bending: median %.1f ms, longest %.1f ms, handles behind in %d, farthest move in a "
        "frame %.3f of the length\n",
        count, f.median(), f.longest(), f.late, f.farthest / handles.length);
}

} // namespace

int main(int argc, char** argv)
try
{
    setting how;
    for (int i = 1; i < argc; ++i)
    {
        const std::string a = argv[i];
        const auto is = [&](const char* name) { return a == name && i + 1 < argc; };
        if (is("--thickness"))
            how.thickness = std::atof(argv[++i]);
        else if (is("--frame"))
            how.frame = std::chrono::duration<double>(std::atof(argv[++i]) / 1000);
        else if (is("--pins"))
            how.pins = std::atoi(argv[++i]);
        else if (is("--frames"))
            how.frames = std::atoi(argv[++i]);
        else if (is("--waves"))
            how.waves = std::atof(argv[++i]);
        else
            run(a, how);
    }
    return 0;
}
catch (const std::exception& e)
{
    std::fprintf(stderr, "%s\n", e.what());
    return 1;
}
