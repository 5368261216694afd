// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <taut/constraints.hpp>
#include <taut/errors.hpp>
#include <taut/impl/core/constrain/constraint_error.hpp>
#include <taut/session.hpp>

namespace taut::impl
{

/// State of a session without a device: constraints, and the last map. Derived classes, compiled only where a session
/// is constructed, advance it.
template <class Element>
class session_body
{
public:
    using map = std::vector<vec<Element::dimension>>;

    session_body() = default;
    session_body(const session_body&) = delete;
    session_body& operator=(const session_body&) = delete;
    virtual ~session_body() = default;

    virtual session_result<Element> solve(const session_budget& budget) = 0;

    /// Replaces the constraints and the map. Throws parameter_error, constraint_error; then nothing has changed.
    virtual void restore(const constraints<Element>& asked, const map& x) = 0;

    /// Positions of vertices in the last map. Throws constraint_error.
    map places_of(std::span<const idx> vertices) const
    {
        if (last.x.empty())
            throw constraint_error(constraint_error::no_position, {}, "there is no map yet; call solve() first");
        std::vector<idx> bad;
        map places;
        for (const idx v : vertices)
            if (v < 0 || static_cast<std::size_t>(v) >= last.x.size())
                bad.push_back(v);
            else
                places.push_back(last.x[static_cast<std::size_t>(v)]);
        refuse_vertices(constraint_error::out_of_range, std::move(bad),
                        "that the mesh does not have; it has " + std::to_string(last.x.size()) + ", numbered from 0");
        return places;
    }

    constraints<Element> wanted;
    bool changed = false; ///< wanted, since the last call of solve()
    session_result<Element> last;
};

} // namespace taut::impl
