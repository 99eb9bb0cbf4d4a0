#pragma once

#include "report.h"

#include <string>
#include <vector>

namespace pent::simulator::bench {

/// The inner loops on the beam: forces, projected Hessian with assembly for each instruction set,
/// product, preconditioner.
[[nodiscard]] std::vector<Case> kernel_cases(int threads);

/// Whole steps: the beam with linear_euler and newton_euler, a 3D body in free fall, and a small
/// beam beside the dense oracle.
[[nodiscard]] std::vector<Case> step_cases(int threads);

/// Time per step and memory of compact boxes from 75,000 to 4 million pentachora, with the
/// exponents of their growth; in Markdown.
[[nodiscard]] std::string growth(int threads);

}  // namespace pent::simulator::bench
