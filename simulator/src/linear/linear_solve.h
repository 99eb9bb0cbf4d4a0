#pragma once

#include "linear/block_matrix.h"

#include <vector>

namespace pent::simulator {

struct LinearSolveOptions {
    double tolerance = 1e-4;  ///< On |b - A x| / |b|.
    int max_iterations = 3000;
    /// Of the squares of rows in further norms, in which as little may be left: one a row, > 0. On
    /// all ranks as many norms.
    std::vector<Eigen::VectorXd> weights = {};
};

struct LinearSolveReport {
    int iterations = 0;
    double residual = 0;           ///< |b - A x| / |b| computed from x at the end, in the norm in
                                   ///< which that is more; 0 if b = 0.
    bool has_converged = false;    ///< residual <= tolerance.
    bool has_broken_down = false;  ///< A direction p with p . A p <= 0 or not finite turned up.
    bool is_slow = false;          ///< It ended since what else there was would take less.
};

template <int Dim>
struct LinearSolution {
    BlockVector<Dim> x;
    LinearSolveReport report;
};

}  // namespace pent::simulator
