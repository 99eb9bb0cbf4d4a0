#pragma once

#include "block_matrix.h"
#include "numbering.h"
#include "scene_contacts.h"

#include <pent/parallel.h>

#include <memory>

namespace pent::simulator {

/// A matrix with a pattern of its own.
template <int Dim, typename Scalar>
struct CouplingMatrix {
    explicit CouplingMatrix(BlockPattern own) : pattern(std::move(own)), matrix(pattern) {}
    CouplingMatrix(const CouplingMatrix&) = delete;
    CouplingMatrix& operator=(const CouplingMatrix&) = delete;
    CouplingMatrix(CouplingMatrix&&) = delete;
    CouplingMatrix& operator=(CouplingMatrix&&) = delete;
    ~CouplingMatrix() = default;

    BlockPattern pattern;
    BlockMatrix<Dim, Scalar> matrix;
};

/// All that has a Hessian among the contacts of a state.
template <int Dim>
struct ContactTerms {
    const ContactState<Dim>& state;
    std::vector<LocalHessian<Dim>> moving;  ///< Pairs of a barrier, whose weights move.
};

/// Adds `scale` times the filtered Hessian of all contacts to the matrix of a step.
///
/// Blocks of vertices that share a cell, which are all but those between the two simplices of a pair,
/// go into `matrix`. The others are returned on a pattern of their own: a matrix that is small where
/// little touches, made anew each time, since what touches changes. Each row is summed by one thread
/// in the order of the contacts.
///
/// @param held_shift  Dim x vertices: how far held vertices move, m.
/// @param right       Dim x unknowns: less scale * K_fh held_shift.
/// @return            Null if no block is left over.
template <int Dim, typename Scalar>
[[nodiscard]] std::unique_ptr<CouplingMatrix<Dim, Scalar>> add_contact_hessian(
    const Workers& workers,
    const Numbering& numbering,
    const ContactTerms<Dim>& contacts,
    double scale,
    const Positions<Dim>& held_shift,
    BlockMatrix<Dim, Scalar>& matrix,
    BlockVector<Dim>& right);

}  // namespace pent::simulator
