#include "petsc_solver.h"

#include "petsc_error.h"

#include <Eigen/Eigenvalues>

#include <algorithm>
#include <cstddef>
#include <petscmat.h>
#include <vector>

namespace pent::distributed {

namespace {

// Combinations of motions that are shorter than the longest by this, squared, are rounding.
constexpr double kDependent = 1e-10;

// Of all ranks, one after the other, so that it is always the same.
Eigen::MatrixXd sum_over_ranks(MPI_Comm comm, const Eigen::MatrixXd& own) {
    int ranks = 0;
    MPI_Comm_size(comm, &ranks);
    Eigen::MatrixXd all(own.size(), ranks);
    const auto count = static_cast<int>(own.size());
    MPI_Allgather(own.data(), count, MPI_DOUBLE, all.data(), count, MPI_DOUBLE, comm);
    Eigen::MatrixXd sum = Eigen::MatrixXd::Zero(own.rows(), own.cols());
    for (int rank = 0; rank < ranks; ++rank) {
        sum.reshaped() += all.col(rank);
    }
    return sum;
}

// By the eigenvectors of their products, columns in units of their lengths.
Eigen::MatrixXd orthonormal(MPI_Comm comm, const Eigen::MatrixXd& motions) {
    const Eigen::MatrixXd products = sum_over_ranks(comm, motions.transpose() * motions);
    const Eigen::VectorXd scales = products.diagonal().cwiseSqrt().cwiseInverse();
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(scales.asDiagonal() * products
                                                               * scales.asDiagonal());
    const Eigen::Index kept =
        (eigen.eigenvalues().array() >= kDependent * eigen.eigenvalues().maxCoeff()).count();
    const Eigen::VectorXd lengths = eigen.eigenvalues().tail(kept).cwiseSqrt();
    return motions
           * (scales.asDiagonal() * eigen.eigenvectors().rightCols(kept)
              * lengths.cwiseInverse().asDiagonal());
}

}  // namespace

PetscSolver::PetscSolver(MPI_Comm comm, const simulator::SpreadMatrix& matrix) {
    make_matrix(comm, matrix);
    tell_near_kernel(comm, orthonormal(comm, matrix.near_kernel));
    check(MatCreateVecs(matrix_, &solution_, &right_));
    check(PCCreate(comm, &cycle_));
    check(PCSetOptionsPrefix(cycle_, kPrefix));
    check(PCSetType(cycle_, PCGAMG));
    check(PCSetOperators(cycle_, matrix_, matrix_));
    check(PCSetFromOptions(cycle_));
    check(PCSetUp(cycle_));
}

PetscSolver::~PetscSolver() {
    PCDestroy(&cycle_);
    VecDestroy(&right_);
    VecDestroy(&solution_);
    MatDestroy(&matrix_);
}

void PetscSolver::make_matrix(MPI_Comm comm, const simulator::SpreadMatrix& matrix) {
    const auto size = static_cast<std::size_t>(matrix.block_size);
    std::vector<PetscInt> start = {0};
    std::vector<PetscInt> columns;
    std::vector<PetscScalar> values;
    columns.reserve(matrix.columns.size() * size * size);
    values.reserve(matrix.values.size());
    for (std::size_t row = 0; row + 1 < matrix.row_start.size(); ++row) {
        for (std::size_t i = 0; i < size; ++i) {
            for (auto k = static_cast<std::size_t>(matrix.row_start[row]);
                 k < static_cast<std::size_t>(matrix.row_start[row + 1]); ++k) {
                for (std::size_t j = 0; j < size; ++j) {
                    columns.push_back(static_cast<PetscInt>(matrix.columns[k] * matrix.block_size
                                                            + static_cast<std::int64_t>(j)));
                    values.push_back(matrix.values[(k * size + i) * size + j]);
                }
            }
            start.push_back(static_cast<PetscInt>(columns.size()));
        }
    }
    const auto rows = static_cast<PetscInt>(start.size() - 1);
    check(MatCreate(comm, &matrix_));
    check(MatSetSizes(matrix_, rows, rows, PETSC_DETERMINE, PETSC_DETERMINE));
    check(MatSetBlockSize(matrix_, matrix.block_size));
    check(MatSetType(matrix_, MATAIJ));
    // Each does nothing for a matrix of the other kind.
    check(MatSeqAIJSetPreallocationCSR(matrix_, start.data(), columns.data(), values.data()));
    check(MatMPIAIJSetPreallocationCSR(matrix_, start.data(), columns.data(), values.data()));
    check(MatSetOption(matrix_, MAT_SYMMETRIC, PETSC_TRUE));
    check(MatSetOption(matrix_, MAT_SPD, PETSC_TRUE));
}

void PetscSolver::tell_near_kernel(MPI_Comm comm, const Eigen::MatrixXd& motions) {
    std::vector<Vec> vectors(static_cast<std::size_t>(motions.cols()), nullptr);
    for (std::size_t i = 0; i < vectors.size(); ++i) {
        check(MatCreateVecs(matrix_, &vectors[i], nullptr));
        PetscScalar* entries = nullptr;
        check(VecGetArrayWrite(vectors[i], &entries));
        const auto motion = motions.col(static_cast<Eigen::Index>(i));
        std::copy(motion.begin(), motion.end(), entries);
        check(VecRestoreArrayWrite(vectors[i], &entries));
    }
    MatNullSpace space = nullptr;
    check(MatNullSpaceCreate(comm, PETSC_FALSE, static_cast<PetscInt>(vectors.size()),
                             vectors.data(), &space));
    check(MatSetNearNullSpace(matrix_, space));
    check(MatNullSpaceDestroy(&space));
    for (Vec& vector : vectors) {
        check(VecDestroy(&vector));
    }
}

Eigen::VectorXd PetscSolver::solve(const Eigen::VectorXd& r) {
    PetscScalar* entries = nullptr;
    check(VecGetArrayWrite(right_, &entries));
    std::copy(r.begin(), r.end(), entries);
    check(VecRestoreArrayWrite(right_, &entries));
    check(PCApply(cycle_, right_, solution_));
    Eigen::VectorXd z(r.size());
    const PetscScalar* result = nullptr;
    check(VecGetArrayRead(solution_, &result));
    std::copy_n(result, r.size(), z.begin());
    check(VecRestoreArrayRead(solution_, &result));
    return z;
}

}  // namespace pent::distributed
