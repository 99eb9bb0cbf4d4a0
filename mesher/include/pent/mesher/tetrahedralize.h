#pragma once

#include <pent/mesher/surface.h>

#include <cstdint>
#include <filesystem>
#include <string>

namespace pent::mesher {

struct TetrahedraOptions {
    /// Upper bound for circumradius over shortest edge, where the surface allows it; above 1,
    /// smaller gives rounder and more tetrahedra.
    double radius_edge_ratio = 1.414;
    /// Aimed at between neighboring vertices, m: bounds the volume of a tetrahedron by that of a
    /// regular one with this edge. 0 for no bound.
    double edge_length = 0;
    /// Keeps every triangle of the surface as it is; otherwise they may be subdivided.
    bool keep_surface = true;
    std::int64_t max_added_points = 2'000'000;  ///< TetGen runs away without a bound.
    std::int64_t memory_mib = 8192;             ///< Limit for the worker's address space.
    std::int64_t cpu_seconds = 600;             ///< Limit for the worker's time.
    /// The worker program; empty: pent-tetgen beside the running program, else in
    /// ../libexec/pent beside its folder.
    std::filesystem::path worker;
};

/// Tetrahedra that fill a surface, and how they were made.
struct Tetrahedra {
    SimplexMesh<3> mesh;      ///< The points of the surface come first, in their order.
    std::string generator;    ///< As in "TetGen pq1.414Y".
    double volume_error = 0;  ///< |volume of the tets - volume of the surface| / the latter.
};

/// Fills a closed surface with tetrahedra by TetGen [si2015], in a worker process.
///
/// Cavities stay empty. The tetrahedra are positively oriented and not degenerate.
/// @param surface  Clean (see check_surface) and oriented (see orient).
/// Throws an Error if the worker is missing, fails, or passes a limit, and if the tetrahedra do not
/// fill the volume that the surface encloses to 1e-6 of it.
[[nodiscard]] Tetrahedra tetrahedralize(const Surface& surface,
                                        const TetrahedraOptions& options = {});

}  // namespace pent::mesher
