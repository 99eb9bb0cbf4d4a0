#include "linear/gathered_solver.h"

#include <numeric>

namespace pent::simulator {

namespace {

constexpr double kMinShift = 1e-6;

}  // namespace

GatheredSolver::GatheredSolver(const Sharing& sharing,
                               const SpreadMatrix& matrix,
                               const std::vector<std::int64_t>& rows)
    : sharing_(&sharing), first_(matrix.first_row * matrix.block_size) {
    for (const std::int64_t count : rows) {
        sizes_.push_back(count * matrix.block_size);
    }
    const auto total = std::accumulate(sizes_.begin(), sizes_.end(), Eigen::Index{0});
    const Eigen::Index size = matrix.block_size;
    // It is symmetric: rows of this rank are columns, which lie one behind the other.
    Eigen::MatrixXd own = Eigen::MatrixXd::Zero(total, size * matrix.rows());
    for (Eigen::Index row = 0; row < matrix.rows(); ++row) {
        const auto at = static_cast<std::size_t>(row);
        for (std::int64_t k = matrix.row_start[at]; k < matrix.row_start[at + 1]; ++k) {
            own.block(size * matrix.columns[static_cast<std::size_t>(k)], size * row, size, size) =
                Eigen::Map<const Eigen::MatrixXd>(matrix.values.data() + k * size * size, size,
                                                  size);
        }
    }
    std::vector<std::int64_t> lengths;
    for (const std::int64_t numbers : sizes_) {
        lengths.push_back(numbers * total);
    }
    const std::vector<double> all =
        sharing.ranks().gather({own.data(), static_cast<std::size_t>(own.size())}, lengths);
    Eigen::MatrixXd whole = Eigen::Map<const Eigen::MatrixXd>(all.data(), total, total);
    factors_.compute(whole);
    // What rounding has left indefinite is made definite: the diagonal is above zero.
    for (double shift = kMinShift; factors_.info() != Eigen::Success && shift < 1e6; shift *= 10) {
        whole.diagonal() *= 1 + shift;
        factors_.compute(whole);
    }
}

Eigen::VectorXd GatheredSolver::solve(const Eigen::VectorXd& r) {
    const std::vector<double> all =
        sharing_->ranks().gather({r.data(), static_cast<std::size_t>(r.size())}, sizes_);
    const Eigen::VectorXd z = factors_.solve(
        Eigen::Map<const Eigen::VectorXd>(all.data(), static_cast<Eigen::Index>(all.size())));
    return z.segment(first_, r.size());
}

}  // namespace pent::simulator
