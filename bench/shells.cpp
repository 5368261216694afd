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
#include <string>
#include <vector>

#include <taut/exact/collapses.hpp>
#include <taut/io/read_surface.hpp>
#include <taut/map/deform.hpp>

#include "rigid_as_possible.hpp"

namespace
{

using namespace taut;
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

void run(const std::string& path, double share, std::chrono::duration<double> frame)
{
    const auto m = io::read_surface(path);
    queue q;
    const thin_shell shell(m);
    const handled handles(m);
    std::printf("%s: %d vertices, %d triangles, thickness %.2f mean edges\n",
                std::filesystem::path(path).filename().c_str(), m.vertex_count(), m.cell_count(),
                share * handles.length / shell.mean_edge());
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
    auto before = s.solve().x;
    std::vector<double> seconds;
    double farthest = 0;
    int late = 0;
    constexpr int frames = 60;
    for (int f = 1; f <= frames; ++f)
    {
        lead(double(f) / frames);
        const double begin = now();
        const auto r = s.solve({.time = frame});
        seconds.push_back(now() - begin);
        late += r.report.pins_held ? 0 : 1;
        for (std::size_t v = 0; v < r.x.size(); ++v) farthest = std::max(farthest, glm::distance(r.x[v], before[v]));
        before = r.x;
    }
    std::sort(seconds.begin(), seconds.end());
    std::printf(
        "  drag  %d frames of bending: median %.1f ms, longest %.1f ms, handles behind in %d, farthest move in a "
        "frame %.3f of the length\n",
        frames, 1e3 * seconds[frames / 2], 1e3 * seconds.back(), late, farthest / handles.length);
}

} // namespace

int main(int argc, char** argv)
try
{
    double share = 0.013;
    std::chrono::duration<double> frame(0.05);
    for (int i = 1; i < argc; ++i)
    {
        const std::string a = argv[i];
        if (a == "--thickness" && i + 1 < argc)
            share = std::atof(argv[++i]);
        else if (a == "--frame" && i + 1 < argc)
            frame = std::chrono::duration<double>(std::atof(argv[++i]) / 1000);
        else
            run(a, share, frame);
    }
    return 0;
}
catch (const std::exception& e)
{
    std::fprintf(stderr, "%s\n", e.what());
    return 1;
}
