#pragma once

#include <pent/simulator/ranks.h>

#include <map>
#include <petscsf.h>

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

private:
    PetscSF forest_ = nullptr;
    std::map<int, MPI_Datatype> columns_;  // by the numbers in one
};

}  // namespace pent::distributed
