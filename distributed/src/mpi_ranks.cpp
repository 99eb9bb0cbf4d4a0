#include "mpi_ranks.h"

#include "petsc_exchange.h"
#include "petsc_solver.h"

#include <pent/error.h>

#include <algorithm>
#include <limits>
#include <petsclog.h>
#include <string>

namespace pent::distributed {

namespace {

// Counted by PETSc of all that goes through it on this rank.
simulator::RankTraffic petsc_traffic() {
    return {.messages = static_cast<std::int64_t>(petsc_isend_ct + petsc_send_ct),
            .bytes = static_cast<std::int64_t>(petsc_isend_len + petsc_send_len),
            .reductions = static_cast<std::int64_t>(petsc_allreduce_ct)};
}

}  // namespace

MpiRanks::MpiRanks(MPI_Comm comm) : comm_(comm) {
    MPI_Comm_size(comm_, &count_);
    MPI_Comm_rank(comm_, &rank_);
}

std::vector<double> MpiRanks::gather(std::span<const double> own,
                                     std::span<const std::int64_t> sizes) const {
    std::vector<int> counts;
    std::vector<int> starts;
    std::int64_t total = 0;
    for (const std::int64_t size : sizes) {
        counts.push_back(static_cast<int>(size));
        starts.push_back(static_cast<int>(total));
        total += size;
    }
    if (total > std::numeric_limits<int>::max()) {
        throw Error("the scene has " + std::to_string(total)
                    + " coordinates; at most 2147483647 can go through MPI at a time");
    }
    std::vector<double> all(static_cast<std::size_t>(total));
    const bool is_even = std::all_of(counts.begin(), counts.end(),
                                     [&](int count) { return count == counts.front(); });
    if (is_even) {
        MPI_Allgather(own.data(), counts.front(), MPI_DOUBLE, all.data(), counts.front(),
                      MPI_DOUBLE, comm_);
    } else {
        MPI_Allgatherv(own.data(), static_cast<int>(own.size()), MPI_DOUBLE, all.data(),
                       counts.data(), starts.data(), MPI_DOUBLE, comm_);
    }
    ++own_.reductions;
    own_.bytes += static_cast<std::int64_t>(own.size_bytes()) * (count_ - 1);
    return all;
}

std::unique_ptr<simulator::GhostExchange> MpiRanks::make_exchange(
    const simulator::Ghosts& ghosts) const {
    return std::make_unique<PetscExchange>(comm_, ghosts);
}

std::unique_ptr<simulator::SpreadSolver> MpiRanks::make_solver(
    const simulator::SpreadMatrix& matrix) const {
    return std::make_unique<PetscSolver>(comm_, matrix);
}

simulator::RankTraffic MpiRanks::take_traffic() const {
    const simulator::RankTraffic petsc = petsc_traffic();
    std::int64_t sums[2] = {petsc.messages - before_.messages,
                            petsc.bytes - before_.bytes + own_.bytes};
    const std::int64_t reductions = petsc.reductions - before_.reductions + own_.reductions;
    MPI_Allreduce(MPI_IN_PLACE, sums, 2, MPI_INT64_T, MPI_SUM, comm_);
    before_ = petsc_traffic();
    own_ = {};
    return {.messages = sums[0], .bytes = sums[1], .reductions = reductions};
}

}  // namespace pent::distributed
