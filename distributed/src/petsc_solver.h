#pragma once

#include <pent/simulator/ranks.h>

#include <petscpc.h>

namespace pent::distributed {

/// One cycle of PETSc's algebraic multigrid (GAMG) on a matrix that ranks share.
class PetscSolver final : public simulator::SpreadSolver {
public:
    /// What its options in PETSc's database begin with.
    static constexpr const char* kPrefix = "pent_";

    PetscSolver(MPI_Comm comm, const simulator::SpreadMatrix& matrix);
    ~PetscSolver() override;
    PetscSolver(const PetscSolver&) = delete;
    PetscSolver& operator=(const PetscSolver&) = delete;
    PetscSolver(PetscSolver&&) = delete;
    PetscSolver& operator=(PetscSolver&&) = delete;

    [[nodiscard]] Eigen::VectorXd solve(const Eigen::VectorXd& r) override;

private:
    void make_matrix(MPI_Comm comm, const simulator::SpreadMatrix& matrix);
    void tell_near_kernel(MPI_Comm comm, const Eigen::MatrixXd& motions);

    Mat matrix_ = nullptr;
    PC cycle_ = nullptr;
    Vec right_ = nullptr;
    Vec solution_ = nullptr;
};

}  // namespace pent::distributed
