#pragma once

#include "linear/block_matrix.h"

#include <vector>

namespace pent::simulator {

struct LinearSolveOptions {
    double tolerance = 1e-4;  ///< On |b - A x| / |b|, in the Euclidean norm and in those below.
    int max_iterations = 3000;
    /// Further norms, |r|^2 = sum of weight * |r_i|^2 over rows i: of each its weights, one a row,
    /// > 0. All ranks have as many norms.
    std::vector<Eigen::VectorXd> weights = {};
};

struct LinearSolveReport {
    int iterations = 0;
    double residual = 0;           ///< |b - A x| / |b| computed from x at the end, the largest over
                                   ///< all norms; 0 if b = 0.
    bool has_converged = false;    ///< residual <= tolerance; of a direct solve, which takes none,
                                   ///< whether the residual is finite.
    bool has_broken_down = false;  ///< A direction p with p . A p <= 0 or not finite turned up.
    bool is_slow = false;          ///< Given up, as the alternative would take less time.
};

template <int Dim>
struct LinearSolution {
    BlockVector<Dim> x;
    LinearSolveReport report;
};

}  // namespace pent::simulator
