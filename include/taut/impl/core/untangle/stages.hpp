// SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <span>
#include <string>
#include <utility>

#include <taut/errors.hpp>
#include <taut/impl/core/untangle/coarse_stage.hpp>
#include <taut/impl/core/untangle/element_newton.hpp>
#include <taut/impl/core/untangle/harmonic_stage.hpp>
#include <taut/impl/core/untangle/newton_stage.hpp>
#include <taut/impl/core/untangle/proofs/proof_stage.hpp>
#include <taut/impl/core/untangle/pull_stage.hpp>

namespace taut::impl
{

/// The stages of the plane that need no device:
///
/// coarse: a coarse level alone, and its map prolonged. harmonic: the harmonic map alone. newton: from the harmonic
/// map, towards the shapes at rest. pull: from an injective map, whose elements stay positive while springs pull it to
/// the fixed coordinates. stretch: the same towards regular triangles, with detours where the springs have jammed.
///
/// In the best order for an entirely pinned outline, with which a map without flips has no branch points; else those
/// that create none come first.
inline untangle_stages<triangle> host_stages(bool outline_pinned)
{
    untangle_stages<triangle> stages;
    const auto pull = [&] { stages.push_back(std::make_unique<pull_stage>(pull_stage_params{"pull"})); };
    const auto stretch = [&](int share) {
        stages.push_back(std::make_unique<pull_stage>(pull_stage_params{"stretch", true, 0.1, true, share}));
    };
    const auto harmonic_and_newton = [&]
    {
        stages.push_back(std::make_unique<harmonic_stage<triangle>>());
        stages.push_back(std::make_unique<newton_stage<triangle>>());
    };
    stages.push_back(std::make_unique<coarse_stage>());
    if (outline_pinned) harmonic_and_newton();
    pull();
    stretch(outline_pinned ? 1 : 10); // what it does not solve on a free boundary, others hardly ever do
    if (!outline_pinned) harmonic_and_newton();
    return stages;
}

/// The stages in space that need no device.
inline untangle_stages<tetrahedron> solid_host_stages()
{
    untangle_stages<tetrahedron> stages;
    stages.push_back(std::make_unique<harmonic_stage<tetrahedron>>());
    stages.push_back(std::make_unique<proof_stage>());
    return stages;
}

/// Those of the stages that have these names, in the order of the names; all of them if there is no name.
/// Throws parameter_error for a name that no stage has.
template <class Element>
untangle_stages<Element> chosen(untangle_stages<Element> all, std::span<const std::string> names)
{
    if (names.empty()) return all;
    untangle_stages<Element> result;
    for (const std::string& name : names)
    {
        auto found = all.end();
        for (auto s = all.begin(); s != all.end(); ++s)
            if (*s && (*s)->name() == name) found = s;
        if (found == all.end())
        {
            std::string known;
            for (const auto& s : all)
                if (s) known += (known.empty() ? "" : ", ") + std::string(s->name());
            throw parameter_error("stages",
                                  "no stage is called '" + name + "' or it is named twice; left are " + known);
        }
        result.push_back(std::move(*found));
    }
    return result;
}

} // namespace taut::impl
