#pragma once

#include <cstddef>
#include <cstdint>

namespace pent::simulator {

/// Rows [begin, end) of a symmetric block matrix, in plain pointers.
template <typename Scalar>
struct BlockRows {
    const Scalar* values = nullptr;  ///< As in block_order.h.
    const std::int64_t* row_start =
        nullptr;                             ///< Blocks of row i: [row_start[i], row_start[i + 1]).
    const std::uint32_t* columns = nullptr;  ///< Of blocks.
    std::int64_t begin = 0;
    std::int64_t end = 0;
};

/// Rows [begin, end) of a symmetric matrix over modes of which the lower triangle is stored.
///
/// A product or sweep reads every block once: where A_ij x_j is computed for row i, A_ij^T x_i is
/// computed as well and kept as the share of the block, which row j adds when its turn comes.
template <typename Scalar>
struct ModeRows {
    const Scalar* values = nullptr;  ///< Blocks by mode_entry() of block_order.h.
    /// Blocks of row i: [row_start[i], row_start[i + 1]). Those before diagonal[i] are of the lower
    /// triangle, those behind it of ghost columns.
    const std::int64_t* row_start = nullptr;
    const std::int64_t* diagonal = nullptr;
    const std::uint32_t* columns = nullptr;  ///< Of blocks.
    /// Blocks below the diagonal in column i: above[above_start[i]] to above[above_start[i + 1]].
    const std::int64_t* above_start = nullptr;
    const std::uint32_t* above = nullptr;
    Scalar* shares = nullptr;  ///< Of each block: as many numbers as it has columns.
    std::int64_t begin = 0;
    std::int64_t end = 0;
};

/// What Gauss-Seidel sweeps need of the diagonal blocks D; for t see GaussSeidel.
template <typename Scalar>
struct ModeDiagonal {
    const Scalar* inverses = nullptr;  ///< Of (1 + t) D, stored as blocks are.
    const Scalar* kept = nullptr;      ///< t / (1 + t) of each row; null where t is zero.
};

/// Gauss-Seidel sweeps and products with a matrix over modes, A = L + D + L^T and blocks of ghost
/// columns. Sums have the precision of the blocks: preconditioners need no more.
template <typename Scalar>
struct ModeKernels {
    /// z = (1 + t)^-1 D^-1 (r - L z), left = t D z, and the shares of z. The z that L z needs must
    /// be there: all linked rows before these.
    void (*sweep_forth)(const ModeRows<Scalar>& rows,
                        const ModeDiagonal<Scalar>& diagonal,
                        const Scalar* r,
                        Scalar* z,
                        Scalar* left);
    /// z += (1 + t)^-1 D^-1 (r - A z), and the shares of z. Those that L^T z is summed from must be
    /// there: all linked rows behind these.
    void (*sweep_back)(const ModeRows<Scalar>& rows,
                       const ModeDiagonal<Scalar>& diagonal,
                       const Scalar* r,
                       Scalar* z);
    /// left = r - (L + D) x, and the shares of x.
    void (*subtract_below)(const ModeRows<Scalar>& rows,
                           const Scalar* r,
                           const Scalar* x,
                           Scalar* left);
    /// left -= L^T x, from the shares, and the products of ghost columns with x.
    void (*subtract_above)(const ModeRows<Scalar>& rows, const Scalar* x, Scalar* left);
    /// block += other^T.
    void (*add_transposed)(const Scalar* other, Scalar* block);
};

/// Extrusion columns [begin, end) of dofs, each of which is solved for as a whole, and their
/// banded factors, see kernel_columns.h.
///
/// @tparam Number  float to fill them in, const float to solve with them.
template <typename Number>
struct ColumnFactors {
    const std::uint32_t* column_start =
        nullptr;                  ///< Unknowns of column c: [column_start[c], column_start[c + 1]).
    std::size_t band = 0;         ///< Layers up to this far apart are coupled; at most 2.
    Number* inverses = nullptr;   ///< D_k^-1 of every dof k, in the order of block_order.h.
    Number* couplings = nullptr;  ///< E_k,j of every dof k, j = 1 .. band, in that order, too.
    std::int64_t begin = 0;
    std::int64_t end = 0;
};

/// The children of one aggregate.
struct AggregateChildren {
    const std::uint32_t* members = nullptr;
    std::size_t count = 0;
    const double* arms = nullptr;  ///< Of each: Arm::x, then Arm::ratio.
};

/// A matrix, and what couples beyond its pattern: see BlockMatrix::coupling().
template <typename Scalar>
struct SymmetricParts {
    BlockRows<Scalar> own;
    BlockRows<Scalar> coupling;  ///< values is null where there is none.
};

/// One row of the Galerkin product P^T H P, P being the rigid modes of aggregates and H what is
/// stored of a matrix A over their children: one triangle, with halved diagonal blocks, and ghost
/// columns in full. Among the rows of this rank A = H + H^T, so that P^T A P is P^T H P plus its
/// transpose. Sums have the precision of the blocks: preconditioners need no more.
template <typename Scalar>
struct GalerkinRow {
    const std::uint32_t* members = nullptr;   ///< Children of the aggregate whose row it is.
    std::size_t count = 0;                    ///< Of members.
    const Scalar* arms = nullptr;             ///< Of all children: Dim coordinates, then the ratio.
    const std::uint32_t* of_child = nullptr;  ///< Aggregates of all children.
    const std::uint32_t* places = nullptr;    ///< Of each aggregate among the blocks of the row.
    std::size_t blocks = 0;                   ///< Of the row.
    std::size_t above = 0;                    ///< How many of them, the last, are above the
                                              ///< diagonal.
    std::uint32_t* touched = nullptr;         ///< Scratch: a number for each block.
    std::uint8_t* uses = nullptr;             ///< Scratch, the same: given as zeros, left as zeros.
    Scalar* scratch = nullptr;                ///< Scratch: kGalerkinScratch numbers for each block.
};

/// For children of Rows unknowns each: what sums of products take, see kernel_galerkin.h.
template <int Dim, int Rows>
inline constexpr std::size_t kGalerkinScratch =
    Rows == Dim ? Dim* Dim*(4 + 4 * 4)
                : Dim*(Dim + 1) / 2 * Dim*(Dim + 2 * ((Rows + Dim - 1) / Dim));

/// A front of the multifrontal method, column-major: the columns to eliminate, which is the panel
/// (its square part at the diagonal, then the rows below), and the update for the rows below.
///
/// Each column has kFrontRoom further rows of zeros, as kernels work on whole registers of rows.
struct Front {
    double* panel = nullptr;  ///< width + below rows, width columns.
    std::size_t panel_stride = 0;
    std::size_t width = 0;
    std::size_t below = 0;
    double* update = nullptr;  ///< below x below.
    std::size_t update_stride = 0;
};

inline constexpr std::size_t kFrontRoom = 7;

/// The inner loops of linear algebra.
struct BlockKernels {
    /// y += A x for Dim x Dim blocks. Rows hold the upper triangle, the diagonal block first; their
    /// blocks count in both triangles.
    void (*multiply_float)(const BlockRows<float>& rows, const double* x, double* y);
    void (*multiply_double)(const BlockRows<double>& rows, const double* x, double* y);

    ModeKernels<float> modes_float;
    ModeKernels<double> modes_double;

    /// Factors the extrusion columns of a matrix. has_failed[c] is 1 for those that are not
    /// positive definite, else 0.
    void (*factor_columns_float)(const BlockRows<float>& matrix,
                                 const ColumnFactors<float>& factors,
                                 std::uint8_t* has_failed);
    void (*factor_columns_double)(const BlockRows<double>& matrix,
                                  const ColumnFactors<float>& factors,
                                  std::uint8_t* has_failed);
    /// Solves for columns: z = (their blocks of the matrix)^-1 r.
    void (*solve_columns)(const ColumnFactors<const float>& factors, const double* r, double* z);

    /// Restriction, modes = P^T r, and prolongation, x += P modes, for one aggregate of vertices.
    void (*sum_forces)(const AggregateChildren& children, const double* r, double* modes);
    void (*add_motions)(const AggregateChildren& children, const double* modes, double* x);

    /// Stores the blocks of one row of P^T H P in the order of mode_entry(), those above the
    /// diagonal in `above`. The children are vertices, or have modes of their own.
    void (*galerkin_float)(const GalerkinRow<float>& row,
                           const SymmetricParts<float>& A,
                           float* blocks,
                           float* above);
    void (*galerkin_double)(const GalerkinRow<double>& row,
                            const SymmetricParts<double>& A,
                            double* blocks,
                            double* above);
    void (*galerkin_modes_float)(const GalerkinRow<float>& row,
                                 const SymmetricParts<float>& A,
                                 float* blocks,
                                 float* above);
    void (*galerkin_modes_double)(const GalerkinRow<double>& row,
                                  const SymmetricParts<double>& A,
                                  double* blocks,
                                  double* above);

    /// Partial Cholesky factorization: the panel [A; B] becomes [L; R] with A = L L^T and
    /// R = B L^-T, and update -= R R^T. Entries above the diagonals are not read, but may be
    /// overwritten. Returns whether all pivots were positive.
    bool (*eliminate_front)(const Front& front);
};

}  // namespace pent::simulator
