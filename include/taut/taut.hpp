// SPDX-License-Identifier: MIT
#pragma once

/// Maps of meshes: all that reads, constrains, makes, judges and writes them, in the order of the layers. What lies
/// below has headers of its own: <taut/impl/compute/handler.hpp> for kernels, <taut/impl/solve/minimize.hpp> for solvers,
/// <taut/impl/symbolic/recording.hpp> for derivatives.
#include <taut/version.hpp>

#include <taut/impl/core/error.hpp>
#include <taut/impl/core/types.hpp>

#include <taut/impl/compute/queue.hpp>

#include <taut/impl/mesh/mesh.hpp>
#include <taut/impl/mesh/validate.hpp>

#include <taut/impl/energy/algebra.hpp>
#include <taut/impl/energy/check_gradient.hpp>
#include <taut/impl/energy/isometric.hpp>

#include <taut/impl/exact/cell_validity.hpp>
#include <taut/impl/exact/crossings.hpp>
#include <taut/impl/measure/quality.hpp>

#include <taut/impl/constrain/constraints.hpp>

#include <taut/impl/io/cell_faces.hpp>
#include <taut/impl/io/cut_seams.hpp>
#include <taut/impl/io/make_untangle_problem.hpp>
#include <taut/impl/io/pins.hpp>
#include <taut/impl/io/prob.hpp>
#include <taut/impl/io/read_surface.hpp>
#include <taut/impl/io/read_volume.hpp>
#include <taut/impl/io/write_files.hpp>
#include <taut/impl/io/write_map.hpp>
#include <taut/impl/io/write_obj.hpp>
#include <taut/impl/io/write_volume.hpp>

#include <taut/impl/map/deform.hpp>
#include <taut/impl/map/deform_refined.hpp>
#include <taut/impl/map/interpolate.hpp>
#include <taut/impl/map/parameterize.hpp>
#include <taut/impl/map/session.hpp>
#include <taut/impl/map/smooth.hpp>
#include <taut/impl/untangle/untangle.hpp>
#include <taut/impl/untangle/untangle_refined.hpp>
