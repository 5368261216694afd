// SPDX-License-Identifier: MIT
#pragma once

/// Meshes of triangles and of tetrahedra: types, arrays, validation, boundaries.
#include <taut/impl/core/types.hpp>
#include <taut/impl/mesh/arrays.hpp>
#include <taut/impl/mesh/boundary.hpp>
#include <taut/impl/mesh/cell_data.hpp>
#include <taut/impl/mesh/describe.hpp>
#include <taut/impl/mesh/facets.hpp>
#include <taut/impl/mesh/hinge.hpp>
#include <taut/impl/mesh/ideal.hpp>
#include <taut/impl/mesh/mesh.hpp>
#include <taut/impl/mesh/tetrahedron.hpp>
#include <taut/impl/mesh/thin_shell.hpp>
#include <taut/impl/mesh/triangle.hpp>
#include <taut/impl/mesh/validate.hpp>
