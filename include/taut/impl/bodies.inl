// SPDX-License-Identifier: MIT
// The bodies of the parts that the headers of a program ask for: those of src/core, files and charts in one unit. A second header may ask
// for more.

// What a part calls of others.
#ifdef TAUT_PART_ATLAS
#define TAUT_PART_PARAMETERIZE
#define TAUT_PART_PACKING
#endif
#ifdef TAUT_PART_PASTE
#define TAUT_PART_PARAMETERIZE
#endif
#ifdef TAUT_PART_BAKE
#define TAUT_PART_COMPUTE
#endif
#ifdef TAUT_PART_GLTF
#define TAUT_PART_FILE
#endif
#ifdef TAUT_PART_DEFORM
#define TAUT_PART_PARAMETERIZE
#define TAUT_PART_UNTANGLE
#define TAUT_PART_VOLUME
#endif
#ifdef TAUT_PART_PARAMETERIZE
#define TAUT_PART_UNTANGLE_TRIANGLE
#endif
#ifdef TAUT_PART_UNTANGLE
#define TAUT_PART_UNTANGLE_TRIANGLE
#endif
#ifdef TAUT_PART_UNTANGLE_TRIANGLE
#define TAUT_PART_START
#endif
#ifdef TAUT_PART_VOLUME
#define TAUT_PART_START
#endif
#ifdef TAUT_PART_START
#define TAUT_PART_COMPUTE
#endif
#ifdef TAUT_PART_VOLUME_FILE
#define TAUT_PART_SURFACE_FILE
#endif
#ifdef TAUT_PART_SURFACE_FILE
#define TAUT_PART_FILE
#endif

// Meshes, energies, exact predicates: of all.
#include <taut/impl/core/compute/program/private_folder.ipp>
#include <taut/impl/core/constrain/constraints.ipp>
#include <taut/impl/core/constrain/untangle_problem.ipp>
#include <taut/impl/core/core/error.ipp>
#include <taut/impl/core/core/parallel.ipp>
#include <taut/impl/core/energy/default_energy.ipp>
#include <taut/impl/core/exact/branch_points.ipp>
#include <taut/impl/core/exact/cell_validity.ipp>
#include <taut/impl/core/exact/certify.ipp>
#include <taut/impl/core/exact/collapses.ipp>
#include <taut/impl/core/exact/convex_polygons.ipp>
#include <taut/impl/core/exact/crossings.ipp>
#include <taut/impl/core/exact/predicates.ipp>
#include <taut/impl/core/measure/distortion.ipp>
#include <taut/impl/core/measure/quality.ipp>
#include <taut/impl/core/measure/shape_quality.ipp>
#include <taut/impl/core/mesh/boundary.ipp>
#include <taut/impl/core/mesh/cell_data.ipp>
#include <taut/impl/core/mesh/describe.ipp>
#include <taut/impl/core/mesh/mesh.ipp>
#include <taut/impl/core/mesh/manifold.ipp>
#include <taut/impl/core/mesh/order.ipp>
#include <taut/impl/core/mesh/tetrahedron.ipp>
#include <taut/impl/core/mesh/validate.ipp>
#include <taut/impl/core/solve/report.ipp>
#include <taut/impl/core/symbolic/apply.ipp>
#include <taut/impl/core/symbolic/build.ipp>
#include <taut/impl/core/symbolic/cons_table.ipp>
#include <taut/impl/core/symbolic/emit.ipp>
#include <taut/impl/core/symbolic/evaluate.ipp>
#include <taut/impl/core/symbolic/power.ipp>
#include <taut/impl/core/symbolic/recording.ipp>
#include <taut/impl/core/symbolic/reverse.ipp>
#include <taut/impl/core/symbolic/row_compiler.ipp>
#include <taut/impl/core/symbolic/statement_writer.ipp>

#ifdef TAUT_PART_COMPUTE
#include <taut/impl/core/compute/host/programs/vectors.ipp>
#include <taut/impl/core/compute/choose_device.ipp>
#include <taut/impl/core/compute/device.ipp>
#include <taut/impl/core/compute/device_memory.ipp>
#include <taut/impl/core/compute/drivers.ipp>
#include <taut/impl/core/compute/errors.ipp>
#include <taut/impl/core/compute/gather.ipp>
#include <taut/impl/core/compute/host/row_launch.ipp>
#include <taut/impl/core/compute/kernel.ipp>
#include <taut/impl/core/compute/program/build_excerpt.ipp>
#include <taut/impl/core/compute/program/joined_source.ipp>
#include <taut/impl/core/compute/program/signature.ipp>
#include <taut/impl/core/compute/queue.ipp>
#include <taut/impl/core/compute/queue_state.ipp>
#include <taut/impl/core/compute/real_buffer.ipp>
#include <taut/impl/core/compute/record.ipp>
#include <taut/impl/core/compute/reductions.ipp>
#include <taut/impl/core/compute/vector_space.ipp>
#endif

#ifdef TAUT_PART_START
#include <taut/impl/core/compute/host/programs/blocks.ipp>
#include <taut/impl/core/sparse/cell_pattern.ipp>
#include <taut/impl/core/sparse/block_assembly.ipp>
#include <taut/impl/core/sparse/block_matrix.ipp>
#include <taut/impl/core/sparse/block_transfer.ipp>
#include <taut/impl/core/sparse/dense_inverse.ipp>
#include <taut/impl/core/sparse/elimination_solver.ipp>
#include <taut/impl/core/sparse/elimination_tree.ipp>
#include <taut/impl/core/sparse/front_cholesky.ipp>
#include <taut/impl/core/sparse/multigrid.ipp>
#include <taut/impl/core/sparse/multigrid_plan.ipp>
#include <taut/impl/core/sparse/transfer_lists.ipp>
#include <taut/impl/core/sparse/transfer_weights.ipp>
#include <taut/impl/core/hierarchy/collapse.ipp>
#include <taut/impl/core/hierarchy/make_hierarchy.ipp>
#include <taut/impl/core/hierarchy/reinsert.ipp>
#include <taut/impl/core/hierarchy/rings.ipp>
#include <taut/impl/core/hierarchy/thinning.ipp>
#include <taut/impl/core/objective/objective.ipp>
#include <taut/impl/core/objective/nonlinear_elimination.ipp>
#include <taut/impl/core/start/barycentric_map.ipp>
#include <taut/impl/core/start/boundary_polygon.ipp>
#include <taut/impl/core/start/outline.ipp>
#include <taut/impl/core/start/tube_map.ipp>
#endif

#ifdef TAUT_PART_UNTANGLE_TRIANGLE
#include <taut/impl/core/compute/host/programs/untangle.ipp>
#include <taut/impl/core/untangle/coarse_stage.ipp>
#include <taut/impl/core/untangle/convex_corners.ipp>
#include <taut/impl/core/untangle/element_newton.ipp>
#include <taut/impl/core/untangle/proofs/infeasible.ipp>
#include <taut/impl/core/untangle/proofs/pinned_boundary.ipp>
#include <taut/impl/core/untangle/pull_stage.ipp>
#include <taut/impl/core/untangle/result.ipp>
#include <taut/impl/core/untangle/untangle_triangle.ipp>
#endif

#ifdef TAUT_PART_PARAMETERIZE
#include <taut/impl/core/map/parameterize.ipp>
#include <taut/impl/core/map/mapped.ipp>
#include <taut/impl/core/map/session/session.ipp>
#include <taut/impl/core/map/session/map_session.ipp>
#endif

#ifdef TAUT_PART_VOLUME
#include <taut/impl/core/objective/volume_objective.ipp>
#endif

#ifdef TAUT_PART_UNTANGLE
#include <taut/impl/core/untangle/untangle_tetrahedron.ipp>
#endif

#ifdef TAUT_PART_DEFORM
#include <taut/impl/core/map/deform.ipp>
#include <taut/impl/core/map/deform_refined.ipp>
#include <taut/impl/core/map/session/shape_session.ipp>
#include <taut/impl/core/map/smooth.ipp>
#endif

#ifdef TAUT_PART_FILE
#include <taut/impl/files/file/write_files.ipp>
#include <taut/impl/files/file/file_target.ipp>
#include <taut/impl/files/file/read_file.ipp>
#if defined(__unix__) || defined(__APPLE__)
#include <taut/impl/files/file/posix_file.ipp>
#endif
#endif

#ifdef TAUT_PART_SURFACE_FILE
#include <taut/impl/files/surface/cut_seams.ipp>
#include <taut/impl/files/surface/pins.ipp>
#include <taut/impl/files/surface/prob.ipp>
#include <taut/impl/files/surface/read_surface.ipp>
#include <taut/impl/files/surface/write_obj.ipp>
#endif

#ifdef TAUT_PART_VOLUME_FILE
#include <taut/impl/files/volume/make_untangle_problem.ipp>
#include <taut/impl/files/volume/new_volume.ipp>
#include <taut/impl/files/volume/read_volume.ipp>
#include <taut/impl/files/volume/subdivided.ipp>
#include <taut/impl/files/volume/volume_file.ipp>
#include <taut/impl/files/volume/write_volume.ipp>
#endif

#ifdef TAUT_PART_PACKING
#include <taut/impl/charts/packing/certificate.ipp>
#include <taut/impl/charts/packing/pack.ipp>
#endif

#ifdef TAUT_PART_ATLAS
#include <taut/impl/core/compute/host/programs/charts.ipp>
#include <taut/impl/charts/atlas/flatten_charts.ipp>
#include <taut/impl/charts/atlas/make_atlas.ipp>
#include <taut/impl/charts/atlas/charts.ipp>
#include <taut/impl/charts/atlas/segment.ipp>
#include <taut/impl/charts/atlas/symmetry/find_symmetry.ipp>
#endif

#ifdef TAUT_PART_REPAIR
#include <taut/impl/charts/repair/repair_surface.ipp>
#endif

#ifdef TAUT_PART_BAKE
#include <taut/impl/core/compute/host/programs/bake.ipp>
#include <taut/impl/charts/bake/bake.ipp>
#include <taut/impl/charts/bake/compare_textures.ipp>
#include <taut/impl/charts/bake/tangent_frames.ipp>
#endif

#ifdef TAUT_PART_PASTE
#include <taut/impl/core/compute/host/programs/rbf.ipp>
#include <taut/impl/core/compute/host/programs/feature_map.ipp>
#include <taut/impl/charts/paste/feature.ipp>
#include <taut/impl/charts/paste/feature_map.ipp>
#include <taut/impl/charts/paste/geodesic_distances.ipp>
#include <taut/impl/charts/paste/parameterize_feature.ipp>
#include <taut/impl/charts/paste/paste.ipp>
#include <taut/impl/charts/paste/rbf.ipp>
#include <taut/impl/charts/paste/region.ipp>
#include <taut/impl/charts/paste/tessellate.ipp>
#endif

#ifdef TAUT_PART_GLTF
#include <taut/impl/files/gltf/images.ipp>
#include <taut/impl/files/gltf/read_gltf.ipp>
#include <taut/impl/files/gltf/scene.ipp>
#include <taut/impl/files/gltf/write_gltf.ipp>
#endif
