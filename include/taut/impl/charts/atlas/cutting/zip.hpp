// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <initializer_list>
#include <limits>
#include <vector>

#include <taut/impl/charts/atlas/cutting/patch_newton.hpp>

namespace taut::impl
{

/// What sewing up the last edge of a seam would do: its ends in the plane become one, and the map around follows.
struct zip
{
    double more = std::numeric_limits<double>::infinity(); ///< energy times area; infinity: it cannot be done
    idx side = -1;                                         ///< of the edge, from the tip
    std::array<idx, 2> fans{};                             ///< that become the first of them
    std::vector<idx> triangles;                            ///< around
    std::vector<vec2> uv;                                  ///< of their corners then
};

/// Finds out what zips do to a map.
class zipper
{
public:
    /// largest: triangles of a patch that may follow, about
    zipper(const rest_surface& rest, std::size_t largest)
        : rest_(rest), largest_(largest), cell_mark_(rest.surface.cells().size(), 0)
    {
    }

    /// tip: a vertex inside that one seam side starts at
    zip look(const flat_surface& flat, idx tip)
    {
        zip z;
        for (const idx s : rest_.sides.row(tip))
            if (flat.seam[u(s)]) z.side = s;
        if (z.side < 0) return z;
        const idx right = rest_.twin(z.side);
        a_ = flat.fan[u(rest_surface::end_corner(z.side))];
        b_ = flat.fan[u(rest_surface::start_corner(right))];
        z.fans = {a_, b_};
        if (a_ == b_) // an edge that is not open
        {
            z.more = 0;
            return z;
        }
        side_ = z.side;
        gather(flat, tip, rest_.end(z.side));
        z.triangles = patch_.triangles;
        const double before = patch_.energy(rest_, patch_.x);
        vec2 at(0.0);
        if (!place(at)) return z;
        merge(at);
        const double after = newton_.run(rest_, patch_, 4, 1e-4);
        if (!(after < std::numeric_limits<double>::infinity())) return z;
        z.more = after - before;
        z.uv.reserve(3 * z.triangles.size());
        for (const auto& t : patch_.cells)
            for (const idx v : t) z.uv.push_back(patch_.x[u(v)]);
        return z;
    }

    /// What apply() changes, to take it back.
    struct undo
    {
        std::vector<vec2> uv;
        std::vector<idx> corners; // of the second fan
        idx cells = 0;            // of the first one
        double energy = 0;
    };

    undo remember(const flat_surface& flat, const zip& z) const
    {
        undo b;
        for (const idx c : z.triangles)
            for (std::size_t k = 0; k < 3; ++k) b.uv.push_back(flat.uv[3 * u(c) + k]);
        for (const idx s : rest_.sides.row(rest_.end(z.side)))
            if (const idx k = rest_surface::start_corner(s); flat.fan[u(k)] == z.fans[1]) b.corners.push_back(k);
        b.cells = flat.fan_cells[u(z.fans[0])];
        b.energy = flat.energy;
        return b;
    }

    void take_back(flat_surface& flat, const zip& z, const undo& b) const
    {
        set_seam(rest_, flat.seam, z.side, 1);
        for (const idx k : b.corners) flat.fan[u(k)] = z.fans[1];
        flat.fan_cells[u(z.fans[0])] = b.cells;
        flat.fan_cells[u(z.fans[1])] = z.fans[0] == z.fans[1] ? b.cells : static_cast<idx>(b.corners.size());
        for (std::size_t i = 0; i < z.triangles.size(); ++i)
            for (std::size_t k = 0; k < 3 && !z.uv.empty(); ++k) flat.uv[3 * u(z.triangles[i]) + k] = b.uv[3 * i + k];
        flat.energy = b.energy;
    }

    /// Sews it up.
    void apply(flat_surface& flat, const zip& z) const
    {
        set_seam(rest_, flat.seam, z.side, 0);
        if (z.fans[0] != z.fans[1])
        {
            for (const idx s : rest_.sides.row(rest_.end(z.side)))
                if (idx& f = flat.fan[u(rest_surface::start_corner(s))]; f == z.fans[1]) f = z.fans[0];
            flat.fan_cells[u(z.fans[0])] += flat.fan_cells[u(z.fans[1])];
            flat.fan_cells[u(z.fans[1])] = 0;
        }
        for (std::size_t i = 0; i < z.triangles.size(); ++i)
            for (std::size_t k = 0; k < 3 && !z.uv.empty(); ++k) flat.uv[3 * u(z.triangles[i]) + k] = z.uv[3 * i + k];
        flat.energy += z.more / rest_.total;
    }

private:
    static constexpr double infinite = std::numeric_limits<double>::infinity();
    static std::size_t u(idx i) { return static_cast<std::size_t>(i); }

    /// Makes the patch around the edge that is sewn up, as it is before.
    void gather(const flat_surface& flat, idx tip, idx other)
    {
        if (fan_mark_.size() < flat.fan_cells.size())
        {
            fan_mark_.resize(flat.fan_cells.size(), 0);
            number_.resize(flat.fan_cells.size(), -1);
        }
        ++now_;
        patch_.triangles.clear();
        patch_.cells.clear();
        patch_.x.clear();
        fans_.clear();
        const auto take = [&](idx c)
        {
            if (cell_mark_[u(c)] == now_) return;
            cell_mark_[u(c)] = now_;
            patch_.triangles.push_back(c);
        };
        for (const idx s : rest_.sides.row(other))
            if (const idx f = flat.fan[u(rest_surface::start_corner(s))]; f == a_ || f == b_) take(s / 3);
        for (const idx s : rest_.sides.row(tip)) take(s / 3);
        for (std::size_t i = 0; i < patch_.triangles.size() && patch_.triangles.size() < largest_; ++i)
            for (idx k = 3 * patch_.triangles[i]; k < 3 * patch_.triangles[i] + 3; ++k)
                for (const idx s : rest_.sides.row(rest_.vertex(k)))
                    if (flat.fan[u(rest_surface::start_corner(s))] == flat.fan[u(k)]) take(s / 3);
        cells_of_.clear();
        for (const idx c : patch_.triangles)
        {
            std::array<idx, 3> t{};
            for (std::size_t k = 0; k < 3; ++k)
            {
                const idx f = flat.fan[3 * u(c) + k];
                if (fan_mark_[u(f)] != now_)
                {
                    fan_mark_[u(f)] = now_;
                    number_[u(f)] = static_cast<idx>(fans_.size());
                    fans_.push_back(f);
                    cells_of_.push_back(0);
                    patch_.x.push_back(flat.uv[3 * u(c) + k]);
                }
                t[k] = number_[u(f)];
                ++cells_of_[u(t[k])];
            }
            patch_.cells.push_back(t);
        }
        number_moving(flat);
    }

    /// What has all of its triangles here moves, but for the two ends that are led together.
    void number_moving(const flat_surface& flat)
    {
        patch_.moving = 0;
        patch_.slot.assign(fans_.size(), -1);
        for (std::size_t v = 0; v < fans_.size(); ++v)
            if (cells_of_[v] == flat.fan_cells[u(fans_[v])] && fans_[v] != a_ && fans_[v] != b_)
                patch_.slot[v] = patch_.moving++;
        left_ = number_[u(a_)];
        right_ = number_[u(b_)];
        tip_ = number_[u(flat.fan[u(rest_surface::start_corner(side_))])];
    }

    /// The energy of the triangles at both ends, if these were at p.
    double ring_energy(const vec2& p) const
    {
        double sum = 0;
        for (std::size_t i = 0; i < patch_.cells.size() && sum < infinite; ++i)
            if (at_end(i)) sum += energy_with(i, p, p);
        return sum;
    }

    bool at_end(std::size_t i) const
    {
        const auto& t = patch_.cells[i];
        const auto is_end = [this](idx v) { return v == left_ || v == right_; };
        return is_end(t[0]) || is_end(t[1]) || is_end(t[2]);
    }

    double energy_with(std::size_t i, const vec2& left, const vec2& right) const
    {
        std::array<vec2, 3> x;
        for (std::size_t k = 0; k < 3; ++k)
        {
            const idx v = patch_.cells[i][k];
            x[k] = v == left_ ? left : (v == right_ ? right : patch_.x[u(v)]);
        }
        const auto c = u(patch_.triangles[i]);
        return rest_.weight[c] * isometric_energy(rest_.inverse[c], x[0], x[1], x[2]);
    }

    /// A place for both ends without a flip, of little energy. If there is none yet, they are led to each other, and
    /// the patch follows.
    bool place(vec2& best)
    {
        double least = infinite;
        const auto consider = [&](const vec2& p)
        {
            if (const double e = ring_energy(p); e < least)
            {
                least = e;
                best = p;
            }
        };
        const auto consider_all = [&](std::initializer_list<double> along)
        {
            const vec2 tip = patch_.x[u(tip_)], middle = 0.5 * (patch_.x[u(left_)] + patch_.x[u(right_)]);
            for (const double t : along) consider(tip + t * (middle - tip));
        };
        consider_all({1.0, 1.2, 1.5, 0.7, 2.0});
        const vec2 x = patch_.x[u(left_)], y = patch_.x[u(right_)];
        for (const double t : {0.0, 0.25, 0.75, 1.0}) consider(x + t * (y - x));
        constexpr int turns = 6;
        for (int turn = 0; turn < turns && !(least < infinite); ++turn)
        {
            if (!approach()) return false;
            newton_.run(rest_, patch_, 4, 1e-3);
            consider_all({1.0, 1.3, 0.8, 1.6});
        }
        return least < infinite;
    }

    /// Moves both ends towards their middle, as far as no triangle at them becomes too bad.
    bool approach()
    {
        constexpr double bad = 1e4;
        const vec2 x = patch_.x[u(left_)], y = patch_.x[u(right_)], middle = 0.5 * (x + y);
        for (const double t : {0.9, 0.6, 0.4, 0.25, 0.1})
        {
            const vec2 p = x + t * (middle - x), q = y + t * (middle - y);
            bool good = true;
            for (std::size_t i = 0; i < patch_.cells.size() && good; ++i)
                if (at_end(i)) good = energy_with(i, p, q) < bad * rest_.weight[u(patch_.triangles[i])];
            if (!good) continue;
            patch_.x[u(left_)] = p;
            patch_.x[u(right_)] = q;
            return true;
        }
        return false;
    }

    /// The two ends become the left one, at p, which moves if all of its triangles are here.
    void merge(const vec2& p)
    {
        patch_.x[u(left_)] = p;
        for (auto& t : patch_.cells)
            for (idx& v : t)
                if (v == right_) v = left_;
        patch_.slot[u(left_)] = patch_.moving++; // the ring of both is in the patch
    }

    const rest_surface& rest_;
    std::size_t largest_;
    std::vector<idx> cell_mark_, fan_mark_, number_; // number_: of a fan in the patch
    std::vector<idx> fans_, cells_of_;               // of the patch: its fans, how many triangles of theirs it has
    idx side_ = -1, now_ = 0, a_ = 0, b_ = 0, left_ = 0, right_ = 0, tip_ = 0;
    map_patch patch_;
    patch_newton newton_;
};

} // namespace taut::impl
