// SPDX-License-Identifier: MIT
#include "shared/stages.hpp"

#include "shared/assessment.hpp"

namespace taut::tools
{

nlohmann::ordered_json to_json(const stage_report& s)
{
    return {{"stage", s.stage},
            {"level", s.level},
            {"vertices", s.vertices},
            {"iterations", s.iterations},
            {"energy_before", finite(s.energy_before)},
            {"energy_after", finite(s.energy_after)},
            {"seconds", s.seconds},
            {"stop", s.stop},
            {"steps_cut", s.steps_cut},
            {"cut_by", s.cut_by},
            {"step_median", finite(s.step_median)}};
}

} // namespace taut::tools
