#pragma once

#include <cstddef>
#include <cstdint>

namespace pent::simulator {

/// Rows [begin, end) of a symmetric block matrix.
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
/// What its blocks do above the diagonal is done where they are read for what they do below: the
/// product of the transpose of each and its row is kept as its share, to be summed up by columns.
template <typename Scalar>
struct ModeRows {
    const Scalar* values = nullptr;  ///< Blocks by mode_entry() of block_order.h.
    /// Blocks of row i: [row_start[i], row_start[i + 1]); those before the diagonal are below it,
    /// those behind are of columns of other ranks.
    const std::int64_t* row_start = nullptr;
    const std::int64_t* diagonal = nullptr;
    const std::uint32_t* columns = nullptr;  ///< Of blocks.
    /// Blocks below the diagonal in column i: above[above_start[i]] to above[above_start[i + 1]].
    const std::int64_t* above_start = nullptr;
    const std::uint32_t* above = nullptr;
    Scalar* shares = nullptr;  ///< As many numbers of each block as it has columns.
    std::int64_t begin = 0;
    std::int64_t end = 0;
};

/// What sweeps have of the diagonal blocks D.
template <typename Scalar>
struct ModeDiagonal {
    const Scalar* inverses = nullptr;  ///< Of (1 + t) D, stored as blocks are.
    const Scalar* kept = nullptr;      ///< t / (1 + t) of each row; null where t is zero.
};

/// Sweeps and products with a matrix over modes, A = L + D + L^T and blocks of other ranks. Sums
/// have the precision of the blocks: preconditioners need no more.
template <typename Scalar>
struct ModeKernels {
    /// z = (1 + t)^-1 D^-1 (r - L z), left = t D z, shares of z. What L z takes must be done.
    void (*sweep_forth)(const ModeRows<Scalar>& rows,
                        const ModeDiagonal<Scalar>& diagonal,
                        const Scalar* r,
                        Scalar* z,
                        Scalar* left);
    /// z += (1 + t)^-1 D^-1 (r - A z), shares of z. What L^T z takes, by its shares, must be done.
    void (*sweep_back)(const ModeRows<Scalar>& rows,
                       const ModeDiagonal<Scalar>& diagonal,
                       const Scalar* r,
                       Scalar* z);
    /// left = r - (L + D) x, shares of x.
    void (*subtract_below)(const ModeRows<Scalar>& rows,
                           const Scalar* r,
                           const Scalar* x,
                           Scalar* left);
    /// left -= L^T x by the shares, and what blocks of other ranks make of x.
    void (*subtract_above)(const ModeRows<Scalar>& rows, const Scalar* x, Scalar* left);
    /// block += other^T.
    void (*add_transposed)(const Scalar* other, Scalar* block);
};

/// Columns [begin, end) of dofs that are solved for together, and their factors, see
/// kernel_columns.h.
///
/// @tparam Number  float to fill them in, const float to solve with them.
template <typename Number>
struct ColumnFactors {
    const std::uint32_t* column_start =
        nullptr;                  ///< Unknowns of column c: [column_start[c], column_start[c + 1]).
    std::size_t band = 0;         ///< How far apart in one column dofs are coupled, at most 2.
    Number* inverses = nullptr;   ///< D_k^-1 of every dof k, in the order of block_order.h.
    Number* couplings = nullptr;  ///< E_k,j of every dof, j = 1 .. band, as well.
    std::int64_t begin = 0;
    std::int64_t end = 0;
};

/// The children of one aggregate.
struct AggregateChildren {
    const std::uint32_t* members = nullptr;
    std::size_t count = 0;
    const double* arms = nullptr;  ///< Of each: Arm::x, then the ratio.
};

/// A matrix in one part or two.
template <typename Scalar>
struct SymmetricParts {
    BlockRows<Scalar> own;
    BlockRows<Scalar> coupling;  ///< Of no values where there is none.
};

/// One row of P^T H P, where A = H + H^T but for columns of other ranks: the triangle of A that is
/// stored with its diagonal halved, and those columns whole. P is the rigid modes of aggregates, A
/// a matrix over their children. Sums have the precision of the blocks: preconditioners need no
/// more.
template <typename Scalar>
struct GalerkinRow {
    const std::uint32_t* members = nullptr;   ///< Of the aggregate whose row it is.
    std::size_t count = 0;                    ///< Of members.
    const Scalar* arms = nullptr;             ///< Of all children: Dim coordinates, then the ratio.
    const std::uint32_t* of_child = nullptr;  ///< Aggregates of all children.
    const std::uint32_t* places = nullptr;    ///< Of aggregates among the blocks of the row.
    std::size_t blocks = 0;                   ///< Of the row.
    std::size_t above = 0;                    ///< The last so many are above the diagonal.
    std::uint32_t* touched = nullptr;         ///< Room for as many places.
    std::uint8_t* uses = nullptr;             ///< What places are used for: zero; left zero.
    Scalar* scratch = nullptr;                ///< kGalerkinScratch numbers a block.
};

/// For children of Rows dofs each: a product with a block of their rows and what is made of it.
template <int Dim, int Rows>
inline constexpr std::size_t kGalerkinScratch =
    Rows == Dim ? Dim* Dim*(4 + 4 * 4)
                : Dim*(Dim + 1) / 2 * Dim*(Dim + 2 * ((Rows + Dim - 1) / Dim));

/// A dense part of a sparse matrix while it is factored, by columns: those to eliminate, with
/// the rows that they have at the diagonal and below it.
///
/// Behind the rows of each matrix there are kFrontRoom more, zero: kernels go by registers of rows.
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

    /// Factors columns of a matrix. has_failed[c] is 1 for those that are not positive definite,
    /// else 0.
    void (*factor_columns_float)(const BlockRows<float>& matrix,
                                 const ColumnFactors<float>& factors,
                                 std::uint8_t* has_failed);
    void (*factor_columns_double)(const BlockRows<double>& matrix,
                                  const ColumnFactors<float>& factors,
                                  std::uint8_t* has_failed);
    /// Solves for columns: z of r.
    void (*solve_columns)(const ColumnFactors<const float>& factors, const double* r, double* z);

    /// modes = P^T r and x += P modes for one aggregate of vertices.
    void (*sum_forces)(const AggregateChildren& children, const double* r, double* modes);
    void (*add_motions)(const AggregateChildren& children, const double* modes, double* x);

    /// Stores the blocks of one row of P^T H P by mode_entry(), those above the diagonal apart.
    /// Blocks of A are of vertices, or of modes.
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

    /// [L; R] of a panel [A; B], by A = L L^T and R = B L^-T, and update -= R R^T: of what is above
    /// a diagonal nothing is read, and it may be overwritten. Returns whether all pivots were
    /// positive.
    bool (*eliminate_front)(const Front& front);
};

}  // namespace pent::simulator
