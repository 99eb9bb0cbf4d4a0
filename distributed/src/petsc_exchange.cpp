#include "petsc_exchange.h"

#include "petsc_error.h"

#include <vector>

namespace pent::distributed {

PetscExchange::PetscExchange(MPI_Comm comm, const simulator::Ghosts& ghosts) {
    std::vector<PetscInt> leaves(ghosts.columns.begin(), ghosts.columns.end());
    std::vector<PetscSFNode> roots(leaves.size());
    for (std::size_t i = 0; i < roots.size(); ++i) {
        roots[i].rank = static_cast<PetscInt>(ghosts.owners[i]);
        roots[i].index = static_cast<PetscInt>(ghosts.places[i]);
    }
    check(PetscSFCreate(comm, &forest_));
    check(PetscSFSetGraph(forest_, static_cast<PetscInt>(ghosts.own_columns),
                          static_cast<PetscInt>(leaves.size()), leaves.data(), PETSC_COPY_VALUES,
                          roots.data(), PETSC_COPY_VALUES));
    check(PetscSFSetUp(forest_));
}

PetscExchange::~PetscExchange() {
    for (auto& [key, column] : columns_) {
        MPI_Type_free(&column);
    }
    PetscSFDestroy(&forest_);
}

void PetscExchange::update(double* values, int rows) {
    update(values, MPI_DOUBLE, rows);
}

void PetscExchange::update(float* values, int rows) {
    update(values, MPI_FLOAT, rows);
}

void PetscExchange::update(void* values, MPI_Datatype number, int rows) {
    int bytes = 0;
    MPI_Type_size(number, &bytes);
    MPI_Datatype& column = columns_.try_emplace({rows, bytes}, MPI_DATATYPE_NULL).first->second;
    if (column == MPI_DATATYPE_NULL) {
        MPI_Type_contiguous(rows, number, &column);
        MPI_Type_commit(&column);
    }
    check(PetscSFBcastBegin(forest_, column, values, values, MPI_REPLACE));
    check(PetscSFBcastEnd(forest_, column, values, values, MPI_REPLACE));
}

}  // namespace pent::distributed
