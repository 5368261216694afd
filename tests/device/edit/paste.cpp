// SPDX-License-Identifier: MIT
#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

#include <doctest/doctest.h>

#include <support/edit_meshes.hpp>
#include <support/shared_context.hpp>
#include <support/temporary_folder.hpp>
#include <taut/impl/charts/paste/write_paste.hpp>
#include <taut/impl/core/mesh/validate.hpp>
#include <taut/mesh.hpp>
#include <taut/surface_file.hpp>

using namespace taut;

namespace
{

constexpr taut::mesh_requirements closed{.open = false, .one_boundary = false};

/// The mushroom with some of the plane around it.
feature mushroom()
{
    return feature(geodesic_disk(test::mushroom(20), 0, 2.2));
}

} // namespace

TEST_CASE("paste: a closed surface stays closed, and what is far away stays as it was")
{
    queue q(test::shared_context());
    const auto target = test::sphere(4);
    const taut::idx onto = 4;
    paste p(q, target, mushroom(), onto, {.pose = {.scale = 0.4}});
    const auto result = p.surface();
    CHECK(check(result, closed).empty()); // also Euler's formula
    const auto seam = measure_seam(result, p.first_gap(), p.first_feature());
    CHECK(seam.manifold);
    CHECK(seam.boundary_edges == 0);
    CHECK(seam.degenerate == 0);

    // Vertices of the target in their order, those far from the feature bit for bit.
    taut::idx last = -1;
    std::size_t untouched = 0;
    for (std::size_t v = 0; v < p.origins().size(); ++v)
    {
        const taut::idx from = p.origins()[v];
        if (from < 0) continue;
        CHECK(from > last);
        last = from;
        const vec3& x = target.points()[std::size_t(from)];
        if (glm::distance(x, target.points()[std::size_t(onto)]) < 1.2) continue;
        CHECK(result.points()[v] == x);
        ++untouched;
    }
    CHECK(untouched > 500);
    for (std::size_t f = 0; f < p.kept_faces().size(); ++f)
        for (std::size_t k = 0; k < 3; ++k)
            CHECK(p.origins()[std::size_t(p.cells()[f][k])] == target.cells()[std::size_t(p.kept_faces()[f])][k]);
    CHECK(p.target().points() == target.points()); // undo
}

TEST_CASE("paste: hard keeps the shape of the feature, soft lays its rim on the target")
{
    queue q(test::shared_context());
    const auto part = mushroom();
    paste p(q, test::sphere(4), part, 4, {.pose = {.scale = 0.4}});
    const auto& own = part.region;
    const std::size_t first = p.points().size() - own.surface.points().size();
    for (std::size_t v = 0; v < own.surface.points().size(); ++v)
        CHECK(glm::distance(p.points()[first + v], p.transform()(own.surface.points()[v])) < 1e-12);
    const vec3 top = p.points()[first]; // of the hat
    CHECK(glm::dot(top, vec3(0, 0, 1)) > 1.3);

    p.pose({.scale = 0.4, .softness = 1});
    for (const taut::idx v : own.rim)
        CHECK(std::abs(glm::length(p.points()[first + std::size_t(v)]) - 1) < 0.01); // on the sphere
    CHECK(glm::distance(p.points()[first], top) < 0.1);
    CHECK(check(p.surface(), closed).empty());
}

TEST_CASE("paste: a pose costs one kernel, three where it is soft, and changes coordinates alone")
{
    queue q(test::shared_context());
    const auto part = mushroom();
    paste p(q, test::sphere(4), part, 4, {.pose = {.scale = 0.4}});
    const auto cells = p.cells();
    const auto at_first = p.points();
    const auto before = q.counters();
    p.pose({.turn = 0.3, .scale = 0.45, .shift = {0.02, 0, 0.01}});
    CHECK(q.counters().launches == before.launches + 1);
    CHECK(q.counters().builds == before.builds);
    CHECK(p.points() != at_first);
    CHECK(p.cells() == cells);
    CHECK(check(p.surface(), closed).empty());
    const std::size_t first = p.points().size() - part.region.surface.points().size();
    const vec3 arm = p.points()[first + 100] - p.points()[first], was = at_first[first + 100] - at_first[first];
    CHECK(glm::length(arm) == doctest::Approx(glm::length(was) * 0.45 / 0.4));

    p.pose({.scale = 0.4, .softness = 0.5}); // the first one maps the feature
    const auto soft = q.counters();
    p.pose({.scale = 0.4, .softness = 0.6});
    CHECK(q.counters().launches == soft.launches + 3);
    p.pose({.scale = 0.4});
    CHECK(p.points() == at_first); // bit for bit
}

TEST_CASE("paste: the softer, the less the surface bends across the rim, and at 1 hardly")
{
    queue q(test::shared_context());
    // The rim is on the stem, upright.
    paste p(q, test::sphere(4), feature(geodesic_disk(test::mushroom(48), 0, 1.5)), 4, {.pose = {.scale = 0.4}});
    double before = 180, hard = 0;
    for (const double softness : {0.0, 0.5, 1.0})
    {
        p.pose({.scale = 0.4, .softness = softness});
        const auto seam = p.measure_seam();
        CHECK(seam.degenerate == 0);
        CHECK(seam.folded == 0);
        CHECK(seam.median_angle < before);
        before = seam.median_angle;
        if (softness == 0) hard = before;
    }
    CHECK(hard > 60);
    CHECK(before < hard / 3);
    CHECK(p.self_intersections().empty());
}

TEST_CASE("paste: triangles that meet are found, but for those that met before")
{
    queue q(test::shared_context());
    CHECK(paste(q, test::sphere(4), mushroom(), 4, {.pose = {.scale = 0.4}}).self_intersections().empty());
    // Deep in the sphere, the hat comes out on the other side.
    const paste deep(q, test::sphere(4), mushroom(), 4, {.pose = {.scale = 0.4, .shift = {0, 0, -2.35}}});
    const auto pairs = deep.self_intersections();
    CHECK(pairs.size() > 20);
    bool both = false;
    for (const auto& [f, g] : pairs) both = both || (f < deep.first_gap() && g >= deep.first_feature());
    CHECK(both);
    // As a target it has them already.
    const taut::idx far = deep.origins()[0] == 4 ? 1 : 0;
    const paste again(q, deep.surface(), mushroom(), far, {.pose = {.scale = 0.02}});
    CHECK(again.self_intersections().empty());
}

TEST_CASE("paste: where the seam folds, another softness is taken, and where all fold, that is told")
{
    queue q(test::shared_context());
    const auto rough = [](double height, double waves)
    {
        auto points = test::sphere(4).points();
        for (vec3& p : points) p *= 1 + height * std::sin(waves * p.x) * std::sin(waves * p.y) * std::cos(waves * p.z);
        return mesh<triangle>(std::move(points), test::sphere(4).cells());
    };
    paste p(q, rough(0.15, 6), mushroom(), 40, {.pose = {.scale = 0.3}});
    const auto folds = p.folds();
    REQUIRE(!folds.empty());
    CHECK(folds.size() <= std::size_t(p.measure_seam().folded));
    for (const auto& [f, g] : folds) CHECK((f < g && g >= p.first_gap()));
    CHECK(p.unfold());
    CHECK(p.pose().softness > 0);
    CHECK(p.folds().empty());
    const auto taken = p.points();
    CHECK(p.unfold());
    CHECK(p.points() == taken);

    paste hopeless(q, rough(0.25, 9), feature(geodesic_disk(test::mushroom(20), 0, 1.5)), 40,
                   {.pose = {.scale = 0.3, .softness = 0.5}});
    const auto before = hopeless.points();
    CHECK(!hopeless.unfold());
    CHECK(hopeless.points() == before);
    CHECK(!hopeless.folds().empty());
}

TEST_CASE("paste: a soft seam without a map in time is refused, and the hard one stays")
{
    queue q(test::shared_context());
    paste p(q, test::sphere(4), mushroom(), 4, {.pose = {.scale = 0.4}},
            {.time_limit = std::chrono::duration<double>(1e-9)});
    const auto hard = p.points();
    CHECK_THROWS_AS(p.pose({.scale = 0.4, .softness = 1}), paste_error);
    CHECK(p.points() == hard);
    CHECK(p.pose().softness == 0);
    CHECK_THROWS_AS(p.pose({.scale = 0.4, .softness = 0.5}), paste_error);
    CHECK_THROWS_AS(paste(q, test::sphere(4), mushroom(), 4, {}, {.time_limit = std::chrono::duration<double>(-1)}),
                    parameter_error);
}

TEST_CASE("paste: again and again, on a plane, and on a feature that was pasted")
{
    queue q(test::shared_context());
    const auto once = paste(q, test::sphere(4), mushroom(), 4, {.pose = {.scale = 0.4}}).surface();
    const auto twice = paste(q, once, mushroom(), 0, {.pose = {.turn = 1, .scale = 0.3, .softness = 0.5}}).surface();
    CHECK(check(twice, closed).empty());
    const paste third(q, twice, mushroom(), twice.vertex_count() - 1, {.pose = {.scale = 0.02}});
    CHECK(check(third.surface(), closed).empty());

    const paste flat(q, test::grid(30, 30), mushroom(), 15 * 31 + 15, {.pose = {.scale = 0.2}});
    CHECK(check(flat.surface()).empty()); // a disk
    CHECK(flat.report().way == "projected");
    for (const vec3& x : flat.points()) CHECK(x.z > -1e-9);
}

TEST_CASE("paste: a feature whose triangles hang on its rim, and one smaller than a triangle of the target")
{
    queue q(test::shared_context());
    const auto m = test::grid(12, 12);
    std::vector<taut::idx> faces{2 * (5 * 12 + 8)}; // a tooth: a single triangle on the rim of a square
    for (int j = 4; j < 8; ++j)
        for (int i = 4; i < 8; ++i) faces.insert(faces.end(), {2 * (j * 12 + i), 2 * (j * 12 + i) + 1});
    const feature part(region_of_faces(m, faces));
    CHECK(std::count(part.region.vertices.begin(), part.region.vertices.end(), -1) > 0);
    for (const double scale : {1.0, 0.02})
    {
        const paste p(q, test::sphere(3), part, 4, {.pose = {.scale = scale}});
        CHECK(check(p.surface(), closed).empty());
    }
}

TEST_CASE("paste: what finds no place is refused with the reason")
{
    queue q(test::shared_context());
    const auto grid = test::grid(20, 20);
    CHECK_THROWS_AS(paste(q, grid, mushroom(), -1), region_error);
    CHECK_THROWS_AS(paste(q, grid, mushroom(), 10 * 21 + 10, {.pose = {.scale = 10}}),
                    paste_error); // beyond the boundary
    CHECK_THROWS_AS(paste(q, test::torus(30, false), mushroom(), 0, {.pose = {.scale = 2}}), error); // around the tube
    CHECK_THROWS_AS(paste(q, grid, mushroom(), 0, {.pose = {.softness = 2}}), parameter_error);
    CHECK_THROWS_AS(paste(q, grid, mushroom(), 0, {.reach = 1}), parameter_error);
    CHECK_THROWS_AS(feature(region_of_faces(test::bowtie(), std::array<taut::idx, 2>{0, 1})), region_error);
}

TEST_CASE("paste: the file has the texture coordinates of both surfaces")
{
    queue q(test::shared_context());
    const test::temporary_folder folder;
    const auto with_texcoords = [](mesh<triangle> m)
    {
        std::vector<vec2> uv;
        for (const vec3& x : m.points()) uv.emplace_back(x.x, x.y);
        auto cells = m.cells();
        return io::surface_file{
            .surface = std::move(m), .texcoords = std::move(uv), .texcoord_cells = std::move(cells)};
    };
    const auto target = with_texcoords(test::sphere(3)), source = with_texcoords(test::mushroom(12));
    const paste p(q, target.surface, feature(geodesic_disk(source.surface, 0, 2.2)), 4, {.pose = {.scale = 0.4}});
    io::atomic_file out(folder / "pasted.obj");
    p.write(out, target, source);
    out.commit();
    const auto read = io::read_surface_file(folder / "pasted.obj");
    CHECK(read.surface.points() == p.points());
    CHECK(read.surface.cells() == p.cells());
    const std::size_t kept = p.kept_faces().size(), f = std::size_t(p.first_feature());
    CHECK(read.texcoord(kept - 1, 0) == target.texcoord(std::size_t(p.kept_faces()[kept - 1]), 0));
    CHECK(read.texcoord(f, 2) == source.texcoord(std::size_t(p.part().region.faces[0]), 2));
    CHECK_THROWS_AS(read.texcoord(std::size_t(p.first_gap()), 0), io::texcoord_error);
}
