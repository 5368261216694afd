// SPDX-License-Identifier: MIT
#pragma once

/// Maps of meshes: all that reads, constrains, makes, judges and writes them, in the order of the layers. What lies
/// below has headers of its own: <taut/compute/handler.hpp> for kernels, <taut/solve/minimize.hpp> for solvers,
/// <taut/symbolic/recording.hpp> for derivatives.
#include <taut/version.hpp>

#include <taut/core/error.hpp>
#include <taut/core/types.hpp>

#include <taut/compute/queue.hpp>

#include <taut/mesh/mesh.hpp>
#include <taut/mesh/validate.hpp>

#include <taut/energy/algebra.hpp>
#include <taut/energy/check_gradient.hpp>
#include <taut/energy/isometric.hpp>

#include <taut/exact/cell_validity.hpp>
#include <taut/exact/crossings.hpp>
#include <taut/measure/quality.hpp>

#include <taut/constrain/constraints.hpp>

#include <taut/io/cell_faces.hpp>
#include <taut/io/cut_seams.hpp>
#include <taut/io/make_untangle_problem.hpp>
#include <taut/io/pins.hpp>
#include <taut/io/prob.hpp>
#include <taut/io/read_surface.hpp>
#include <taut/io/read_volume.hpp>
#include <taut/io/write_files.hpp>
#include <taut/io/write_map.hpp>
#include <taut/io/write_obj.hpp>
#include <taut/io/write_volume.hpp>

#include <taut/map/deform.hpp>
#include <taut/map/deform_refined.hpp>
#include <taut/map/interpolate.hpp>
#include <taut/map/parameterize.hpp>
#include <taut/map/session.hpp>
#include <taut/map/smooth.hpp>
#include <taut/untangle/untangle.hpp>
#include <taut/untangle/untangle_refined.hpp>
