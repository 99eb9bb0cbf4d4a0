#pragma once

#include <pent/parallel.h>
#include <pent/simulator/ranks.h>

#include <Eigen/Core>

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>

namespace pent::simulator {

struct SimulationOptions {
    int threads = 1;  ///< At least 1. Results do not depend on it.
    std::optional<TaskSystem> tasks =
        {};  ///< The host's, in place of `threads` of ours. Results do not depend on it.
    std::string isa =
        {};  ///< "scalar", "baseline", "avx2" or "avx512"; empty for the best there is.
    /// Processes that take the steps together; null for one alone. All give the same scene, meshes
    /// and options, and call all that follows alike.
    std::shared_ptr<const Ranks> ranks = {};
    /// Bytes that a direct solve may take, >= 0; a scene whose solve would take more is refused. 0
    /// for no limit. The simulator does not ask the machine: see machine_memory().
    std::int64_t memory = 0;
    /// Told of the path that Newton's method takes in a step: all positions (Dim x vertices, m)
    /// where it starts, with true, and every iterate, with false. For plots of convergence, and
    /// proofs that nothing crosses on the way.
    std::function<void(const Eigen::MatrixXd& positions, bool is_start)> on_iterate = {};
};

/// How big a simulation is.
struct SimulationSize {
    std::int64_t vertices = 0;
    std::int64_t cells = 0;
    std::int64_t free_vertices = 0;  ///< Those with unknowns now: Dim each.
    std::int64_t elements = 0;       ///< Cells, edges or quadratic cells, with a free
                                     ///< vertex near; others cost nothing.
    std::int64_t matrix_blocks = 0;  ///< Dim x Dim blocks stored, upper triangle.
    std::int64_t own_vertices = 0;   ///< Of this rank; of one alone all.
    std::int64_t ghosts = 0;         ///< Vertices of others that this rank's matrix has.
    std::int64_t element_bytes = 0;  ///< Of elements; part of `bytes`.
    std::int64_t matrix_bytes = 0;   ///< Of the matrix; part of `bytes`.
    std::int64_t contact_bytes = 0;  ///< Of surfaces and trees for contact; part of `bytes`.
    std::int64_t bytes = 0;          ///< Of what grows with the mesh, in memory.
};

}  // namespace pent::simulator
