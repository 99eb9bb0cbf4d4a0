#pragma once

#include <pent/simulator/ranks.h>

#include <mpi.h>

namespace pent::distributed {

/// The processes of a communicator. Numbers go by MPI, ghosts and solves by PETSc.
class MpiRanks final : public simulator::Ranks {
public:
    /// @param comm  Of this alone; must outlive it.
    explicit MpiRanks(MPI_Comm comm);

    [[nodiscard]] int count() const override { return count_; }
    [[nodiscard]] int rank() const override { return rank_; }
    [[nodiscard]] std::vector<double> gather(std::span<const double> own,
                                             std::span<const std::int64_t> sizes) const override;
    [[nodiscard]] std::unique_ptr<simulator::GhostExchange> make_exchange(
        const simulator::Ghosts& ghosts) const override;
    [[nodiscard]] std::unique_ptr<simulator::SpreadSolver> make_solver(
        const simulator::SpreadMatrix& matrix) const override;
    [[nodiscard]] simulator::RankTraffic take_traffic() const override;

private:
    MPI_Comm comm_;
    int count_ = 1;
    int rank_ = 0;
    mutable simulator::RankTraffic own_;     // of gather(), sent by this rank
    mutable simulator::RankTraffic before_;  // PETSc's count when last asked
};

}  // namespace pent::distributed
