#pragma once

#include <pent/mesher/step_limits.h>
#include <pent/mesher/surface.h>

#include <cstdint>
#include <filesystem>
#include <string>

namespace pent::mesher {

/// What fills the surface.
enum class Generator {
    Auto,    ///< TetGen with the surface kept, else with it subdivided, else Mesh_3.
    TetGen,  ///< Constrained Delaunay refinement [si2015]: the surface exactly, and fast.
    Mesh3,   ///< CGAL's Delaunay refinement [cgal2022]: rounder cells, the surface nearly.
};

struct TetrahedraOptions {
    Generator generator = Generator::Auto;
    /// TetGen: upper bound for circumradius over shortest edge, where the surface allows it; above
    /// 1, smaller gives rounder and more tetrahedra.
    double radius_edge_ratio = 1.414;
    /// Aimed at between neighboring vertices, m: bounds the volume of a tetrahedron by that of a
    /// regular one with this edge. 0: no bound (TetGen), the mean edge of the surface (Mesh_3).
    double edge_length = 0;
    /// TetGen: keeps every triangle of the surface as it is; otherwise they may be subdivided.
    bool keep_surface = true;
    std::int64_t max_added_points = 2'000'000;  ///< TetGen runs away without a bound.
    StepLimits limits = {};                     ///< For each run of TetGen or Mesh_3.
    /// The worker program; empty: pent-tetgen beside the running program, else in
    /// ../libexec/pent beside its folder.
    std::filesystem::path worker;
};

/// Tetrahedra that fill a surface, and how they were made.
struct Tetrahedra {
    SimplexMesh<3> mesh;      ///< From TetGen: the points of the surface first, in their order.
    std::string generator;    ///< As in "TetGen pq1.414Y".
    std::string failures;     ///< Of what was tried before, one line; empty if nothing failed.
    double volume_error = 0;  ///< |volume of the tets - volume of the surface| / the latter.
};

/// Fills a closed surface with tetrahedra.
///
/// Cavities stay empty. The tetrahedra are positively oriented, none flatter than a mean ratio of
/// 1e-4 (see quality.h), and fill the surface's volume to 1e-6 of it (TetGen) or 5% (Mesh_3).
/// @param surface  Clean (see check_surface) and oriented (see orient).
/// Throws an Error if that cannot be had from the generator, with the reason of each that was
/// tried: worker missing, failed or past a limit; volume or shape out of bounds.
[[nodiscard]] Tetrahedra tetrahedralize(const Surface& surface,
                                        const TetrahedraOptions& options = {});

}  // namespace pent::mesher
