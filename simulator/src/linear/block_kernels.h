#pragma once

#include <cstddef>
#include <cstdint>

namespace pent::simulator {

/// Rows [begin, end) of a symmetric block matrix.
template <typename Scalar>
struct BlockRows {
    const Scalar* values = nullptr;  ///< Of vertices as in block_order.h, of modes by columns.
    const std::int64_t* row_start =
        nullptr;                             ///< Blocks of row i: [row_start[i], row_start[i + 1]).
    const std::uint32_t* columns = nullptr;  ///< Of blocks.
    std::int64_t begin = 0;
    std::int64_t end = 0;
};

/// Parts of rows [begin, end) of a block matrix: the blocks [first[i], last[i]) of row i.
template <typename Scalar>
struct BlockSpans {
    const Scalar* values = nullptr;  ///< Blocks, column-major.
    const std::int64_t* first = nullptr;
    const std::int64_t* last = nullptr;
    const std::uint32_t* columns = nullptr;  ///< Of blocks.
    std::int64_t begin = 0;
    std::int64_t end = 0;
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
    const double* arms = nullptr;  ///< Of all children: Arm::x, then the ratio.
    std::size_t arm_stride = 0;    ///< Numbers from one child's to the next.
};

/// A matrix in one part or two, of which blocks on and above the diagonal count.
template <typename Scalar>
struct SymmetricParts {
    BlockRows<Scalar> own;
    BlockRows<Scalar> coupling;  ///< Of no values where there is none.
};

/// One row of P^T H P, where A = H + H^T but for columns of other ranks: the upper triangle of A
/// with its diagonal halved, and those columns whole. P is the rigid modes of aggregates, A a
/// matrix over their children. Sums have the precision of the blocks: preconditioners need no more.
template <typename Scalar>
struct GalerkinRow {
    const std::uint32_t* members = nullptr;   ///< Of the aggregate whose row it is.
    std::size_t count = 0;                    ///< Of members.
    const Scalar* arms = nullptr;             ///< Of all children: Dim coordinates, then the ratio.
    const std::uint32_t* of_child = nullptr;  ///< Aggregates of all children.
    const std::uint32_t* places = nullptr;    ///< Of aggregates among the blocks of the row.
    std::size_t blocks = 0;                   ///< Of the row.
    std::uint32_t* touched = nullptr;         ///< Room for as many places.
    std::uint8_t* uses = nullptr;             ///< What places are used for: zero; left zero.
    Scalar* scratch = nullptr;                ///< kGalerkinScratch numbers a block.
};

/// For children of Rows dofs each: a product with a block of their rows and what is made of it.
template <int Dim, int Rows>
inline constexpr std::size_t kGalerkinScratch =
    Rows == Dim ? Dim* Dim*(4 + 4 * 4)
                : Dim*(Dim + 1) / 2 * Dim*(Dim + 2 * ((Rows + Dim - 1) / Dim));

/// The inner loops of linear algebra.
struct BlockKernels {
    /// y += A x for Dim x Dim blocks. Rows hold the upper triangle, the diagonal block first; their
    /// blocks count in both triangles.
    void (*multiply_float)(const BlockRows<float>& rows, const double* x, double* y);
    void (*multiply_double)(const BlockRows<double>& rows, const double* x, double* y);

    /// y = A x for blocks of Dim (Dim + 1) / 2 rows, that many modes. Sums have the precision of
    /// the blocks: preconditioners need no more.
    void (*multiply_modes_float)(const BlockSpans<float>& rows, const float* x, float* y);
    void (*multiply_modes_double)(const BlockSpans<double>& rows, const double* x, double* y);

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

    /// Stores the blocks of one row of P^T H P. Blocks of A are of vertices, or of modes.
    void (*galerkin_float)(const GalerkinRow<float>& row,
                           const SymmetricParts<float>& A,
                           float* blocks);
    void (*galerkin_double)(const GalerkinRow<double>& row,
                            const SymmetricParts<double>& A,
                            double* blocks);
    void (*galerkin_modes_float)(const GalerkinRow<float>& row,
                                 const SymmetricParts<float>& A,
                                 float* blocks);
    void (*galerkin_modes_double)(const GalerkinRow<double>& row,
                                  const SymmetricParts<double>& A,
                                  double* blocks);
};

}  // namespace pent::simulator
