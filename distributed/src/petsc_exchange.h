#pragma once

#include <pent/simulator/ranks.h>

#include <map>
#include <petscsf.h>
#include <utility>

namespace pent::distributed {

/// A star forest: its roots are the columns of this rank, its leaves the ghosts.
class PetscExchange final : public simulator::GhostExchange {
public:
    PetscExchange(MPI_Comm comm, const simulator::Ghosts& ghosts);
    ~PetscExchange() override;
    PetscExchange(const PetscExchange&) = delete;
    PetscExchange& operator=(const PetscExchange&) = delete;
    PetscExchange(PetscExchange&&) = delete;
    PetscExchange& operator=(PetscExchange&&) = delete;

    void update(double* values, int rows) override;
    void update(float* values, int rows) override;

private:
    void update(void* values, MPI_Datatype number, int rows);

    PetscSF forest_ = nullptr;
    // By the numbers in one and the bytes of each.
    std::map<std::pair<int, int>, MPI_Datatype> columns_;
};

}  // namespace pent::distributed
