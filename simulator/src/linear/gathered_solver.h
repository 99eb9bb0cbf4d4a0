#pragma once

#include "linear/sharing.h"

#include <Eigen/Cholesky>

#include <cstdint>
#include <vector>

namespace pent::simulator {

/// Solves with a spread matrix of few rows: every rank has all of it, and its dense factors. One
/// message each way in place of the dozens of a method that leaves rows where they are.
class GatheredSolver final : public SpreadSolver {
public:
    /// The most rows, of numbers, that are few.
    static constexpr std::int64_t kMaxRows = 600;

    /// @param sharing  Must outlive this.
    /// @param rows     Of blocks, of each rank.
    GatheredSolver(const Sharing& sharing,
                   const SpreadMatrix& matrix,
                   const std::vector<std::int64_t>& rows);

    [[nodiscard]] Eigen::VectorXd solve(const Eigen::VectorXd& r) override;

private:
    const Sharing* sharing_;
    std::vector<std::int64_t> sizes_;  // numbers of each rank
    Eigen::Index first_;               // of this rank
    Eigen::LLT<Eigen::MatrixXd> factors_;
};

}  // namespace pent::simulator
