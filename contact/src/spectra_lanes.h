#pragma once

// Eigenvalues and eigenvectors of small symmetric matrices side by side.

namespace pent::contact {

/// Matrices side by side.
inline constexpr int kSpectra = 8;

/// Finds the spectra of kSpectra symmetric matrices of the same size, each as if it were alone.
///
/// @param size      Rows of each.
/// @param matrices  [row][column][matrix]; what is below the diagonals is not read. The eigenvalues
///                  take the place of the diagonals, in no order; the rest is of no use after.
/// @param vectors   [vector][component][matrix]: set to the eigenvectors, orthonormal.
///
/// Errors are a few roundings of the norm of the matrix. One that has a number that is not finite
/// gets numbers that are not.
using FindSpectra = void (*)(int size, double* matrices, double* vectors);

}  // namespace pent::contact
