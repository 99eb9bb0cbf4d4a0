#pragma once

#include <pent/simulator/ranks.h>
#include <pent/simulator/scene.h>

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace pent::runs {

/// One part of the model of a scene.
struct Term {
    std::string name = {};  ///< "elasticity of octopus", "contact between bodies", ...
    bool is_on = false;
    std::string why = {};       ///< What in the scene switches it on or off, and its numbers.
    std::int64_t unknowns = 0;  ///< Scalars it solves for; 0 for a force on those of others.
    std::int64_t bytes = 0;     ///< Memory of its own; 0 where it has none.
    double seconds = 0;         ///< Of a step; 0 where it costs nothing worth naming.
};

/// What will be modeled, at what cost, and what to think about before running.
struct Explanation {
    std::vector<Term> terms;
    std::vector<std::string> advice;  ///< What could be left out or is missing, a line each.
    std::int64_t unknowns = 0;        ///< Scalars.
    std::int64_t bytes = 0;           ///< Of what grows with the meshes.
    double seconds_per_step = 0;      ///< Measured on one step in memory.
    double seconds = 0;               ///< The same for all steps of the scene.
};

/// Sets the scene up, takes one step in memory to time it, and writes nothing.
///
/// The time of a step changes in the course of a scene, with contact and with iterations. Throws an
/// Error as Simulation does.
///
/// @param threads  At least 1.
/// @param ranks    Processes that will run it together and explain it together; null for one alone.
[[nodiscard]] Explanation explain(const simulator::Scene& scene,
                                  int threads,
                                  const std::shared_ptr<const simulator::Ranks>& ranks = nullptr);

/// The explanation as a table and lines, for people.
[[nodiscard]] std::string explanation_text(const Explanation& explanation);

}  // namespace pent::runs
