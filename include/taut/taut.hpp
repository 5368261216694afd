// SPDX-License-Identifier: MIT
#pragma once

/// Everything, in the order of the layers.
#include <taut/version.hpp>

#include <taut/core/error.hpp>
#include <taut/core/types.hpp>

#include <taut/symbolic/differentiate.hpp>
#include <taut/symbolic/loop.hpp>
#include <taut/symbolic/recording.hpp>

#include <taut/compute/handler.hpp>
#include <taut/compute/queue.hpp>
#include <taut/compute/vector_space.hpp>

#include <taut/hierarchy/hierarchy.hpp>
#include <taut/mesh/mesh.hpp>
#include <taut/mesh/validate.hpp>

#include <taut/energy/algebra.hpp>
#include <taut/energy/isometric.hpp>

#include <taut/solve/minimize.hpp>

#include <taut/io/cut_seams.hpp>
#include <taut/io/pins.hpp>
#include <taut/io/prob.hpp>
#include <taut/io/read_surface.hpp>
#include <taut/io/write_files.hpp>
#include <taut/io/write_map.hpp>
#include <taut/io/write_obj.hpp>

#include <taut/constrain/constraints.hpp>
#include <taut/energy/check_gradient.hpp>
#include <taut/exact/crossings.hpp>
#include <taut/io/make_untangle_problem.hpp>
#include <taut/map/parameterize.hpp>
#include <taut/measure/quality.hpp>
#include <taut/untangle/untangle.hpp>
