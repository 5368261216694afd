// SPDX-License-Identifier: MIT
#pragma once

#include <utility>

#include <taut/impl/files/surface/prob.hpp>
#include <taut/impl/files/surface/prob_bodies.hpp>
#include <taut/impl/files/volume/builder.hpp>
#include <taut/surface_file.hpp>

namespace taut::io::impl
{

/// Reads an untangling problem: its points are the initial map, its group "fixed" what that holds.
class problem_reader
{
public:
    explicit problem_reader(volume_file& file) : to_(file), in_(file.bytes, file.path) {}

    void read()
    {
        in_.read_rest();
        if (in_.map_dimension() == 2)
            read_map<triangle>(cell_kind::triangle);
        else
            read_map<tetrahedron>(cell_kind::tetrahedron);
    }

private:
    template <class Element>
    void read_map(cell_kind kind)
    {
        volume_file& file = to_.file();
        prob_file<Element> problem = in_.read_map<Element>();
        to_.set_places({}, false, Element::dimension);
        file.places.offsets = in_.take_places();
        file.points.reserve(problem.initial.size());
        for (const auto& x : problem.initial)
        {
            vec3 p(0.0);
            for (int k = 0; k < Element::dimension; ++k) p[k] = x[k];
            file.points.push_back(p);
        }
        file.rest = std::move(problem.rest);
        for (const auto& cell : problem.cells) to_.add_cell(kind, cell);
        if (!problem.fixed.empty())
            file.groups.push_back({"fixed", 0, unique_vertices(std::move(problem.fixed), file.points.size())});
        to_.finish();
    }

    volume_builder to_;
    prob_reader in_;
};

} // namespace taut::io::impl
