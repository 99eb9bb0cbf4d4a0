#pragma once

#include "kernels/kernel_mode_blocks.h"
#include "kernels/kernel_vertices.h"
#include "linear/block_kernels.h"
#include "linear/rigid_mode_order.h"

#include <cstddef>
#include <cstdint>
#include <utility>

// Galerkin products P^T H P with the rigid modes of aggregates, a row of aggregates at a time: see
// GalerkinRow. T_i is the prolongation to child i, see RigidModes. For each child i of the row the
// products H_ij T_j are summed up over the children j of one aggregate (a Product); T_i^T times
// that is then added to the block of that aggregate (a Sum).

namespace pent::simulator {
namespace {  // NOLINT(google-build-namespaces): see kernel_lanes.h

// The numbers of a block in the order of block_order.h: an array, or, below, registers.
template <int Dim, bool IsVectorized, typename Scalar>
struct BlockNumbers {
    Scalar at[Dim * Dim];

    static BlockNumbers load(const Scalar* block) {
        BlockNumbers numbers;
        __builtin_memcpy(numbers.at, block, sizeof numbers.at);
        return numbers;
    }
    // A block with x[j ^ turn] in all of column j; zero where x has no such number.
    static BlockNumbers of_columns(const Scalar* x, int turn) {
        return filled([&](int /*i*/, int j) { return (j ^ turn) < Dim ? x[j ^ turn] : 0; });
    }
    // A block with x[i ^ turn] in all of row i.
    static BlockNumbers of_rows(const Scalar* x, int turn) {
        return filled([&](int i, int /*j*/) { return (i ^ turn) < Dim ? x[i ^ turn] : 0; });
    }
    Scalar entry(int i, int j) const { return at[block_entry<Dim>(i, j)]; }
    void add(const BlockNumbers& other) {
        for (int i = 0; i < Dim * Dim; ++i) {
            at[i] += other.at[i];
        }
    }
    void add_times(const BlockNumbers& other, const BlockNumbers& factors) {
        for (int i = 0; i < Dim * Dim; ++i) {
            at[i] += other.at[i] * factors.at[i];
        }
    }

private:
    // @param number  Of entry (i, j).
    template <typename Number>
    static BlockNumbers filled(const Number& number) {
        BlockNumbers numbers;
        for (int j = 0; j < Dim; ++j) {
            for (int i = 0; i < Dim; ++i) {
                numbers.at[block_entry<Dim>(i, j)] = number(i, j);
            }
        }
        return numbers;
    }
};

template <typename Scalar>
struct BlockNumbers<4, true, Scalar> {
    // At least four numbers wide, since permutations are within fours.
    static constexpr int kWidth = Widest<Scalar>::kCount < 4 ? 4 : Widest<Scalar>::kCount;
    static constexpr int kCount = 16 / kWidth;
    using Some = Pack<Scalar, kWidth>;

    Some at[kCount];

    static BlockNumbers load(const Scalar* block) {
        BlockNumbers numbers;
        for (int i = 0; i < kCount; ++i) {
            numbers.at[i] = Some::load(block + i * kWidth);
        }
        return numbers;
    }
    static BlockNumbers of_columns(const Scalar* x, int turn) {
        const Some fours = repeated(loaded<FourOf<Scalar>>(x));
        const Some some = turn == 1   ? turned<1>(fours)
                          : turn == 2 ? turned<2>(fours)
                                      : turned<3>(fours);
        BlockNumbers all;
        for (Some& one : all.at) {
            one = some;
        }
        return all;
    }
    // The numbers of diagonal k are in rows column ^ k.
    static BlockNumbers of_rows(const Scalar* x, int turn) {
        const auto by = permuted(loaded<FourOf<Scalar>>(x));
        BlockNumbers all;
        if constexpr (kWidth == 4) {
            for (int k = 0; k < 4; ++k) {
                all.at[k] = Some(by.at[k ^ turn]);
            }
        } else {
            const auto first = joined(by.at[turn], by.at[1 ^ turn]);
            const auto second = joined(by.at[2 ^ turn], by.at[3 ^ turn]);
            if constexpr (kWidth == 8) {
                all.at[0] = Some(first);
                all.at[1] = Some(second);
            } else {
                all.at[0] = Some(joined(first, second));
            }
        }
        return all;
    }
    Scalar entry(int i, int j) const {
        const int at_entry = block_entry<4>(i, j);
        return at[at_entry / kWidth].lanes[at_entry % kWidth];
    }
    void add(const BlockNumbers& other) {
        for (int i = 0; i < kCount; ++i) {
            at[i] += other.at[i];
        }
    }
    void add_times(const BlockNumbers& other, const BlockNumbers& factors) {
        for (int i = 0; i < kCount; ++i) {
            at[i] += other.at[i] * factors.at[i];
        }
    }

private:
    template <typename Vector, std::size_t... Lane>
    static auto joined(const Vector& first,
                       const Vector& second,
                       std::index_sequence<Lane...> /*lanes*/) {
        return __builtin_shufflevector(first, second, static_cast<int>(Lane)...);
    }
    // Concatenated.
    template <typename Vector>
    static auto joined(const Vector& first, const Vector& second) {
        constexpr std::size_t kLanes = sizeof(Vector) / sizeof(Scalar);
        return joined(first, second, std::make_index_sequence<2 * kLanes>());
    }
    // Repeated until the register is full.
    template <typename Vector>
    static Some repeated(const Vector& numbers) {
        if constexpr (sizeof(Vector) == sizeof(Some)) {
            return Some(numbers);
        } else {
            return repeated(joined(numbers, numbers));
        }
    }
    template <std::size_t Turn, std::size_t... Lane>
    static Some turned(const Some& fours, std::index_sequence<Lane...> /*lanes*/) {
        return Some(
            __builtin_shufflevector(fours.lanes, fours.lanes, static_cast<int>(Lane ^ Turn)...));
    }
    // Number j ^ Turn of each four at j.
    template <std::size_t Turn>
    static Some turned(const Some& fours) {
        return turned<Turn>(fours, std::make_index_sequence<kWidth>());
    }
};

// The parts of a Galerkin product for children that are vertices.
//
// The column of H T for the rotation in plane p < q is x_p H_q - x_q H_p, with columns H_p, H_q of
// H and the arm x. With turn = p ^ q both are columns j of H times x[j ^ turn]. So instead of H T
// three whole blocks are summed up, H with column j times x[j ^ turn], turn = 1, 2, 3, beside H
// itself; the rows of T^T H T are treated in the same way; and the differences are taken once at
// the end, in store_block(). So everything is done by products of whole registers.
template <int Dim, bool IsVectorized, typename Scalar>
struct GalerkinOfVertices {
    using Numbers = BlockNumbers<Dim, IsVectorized, Scalar>;
    static constexpr int kDim = Dim;
    static constexpr int kModes = simulator::kModes<Dim>;
    static constexpr int kRows = Dim;
    static constexpr int kTurns = 4;  // turn 0 is H itself

    struct Product {
        Numbers at[kTurns];
    };
    struct Sum {
        Product at[kTurns];
    };

    static void add_times(const Scalar* block, const Scalar* arm, Product& product) {
        const Numbers numbers = Numbers::load(block);
        product.at[0].add(numbers);
#pragma GCC unroll 4
        for (int turn = 1; turn < kTurns; ++turn) {
            product.at[turn].add_times(numbers, Numbers::of_columns(arm, turn));
        }
    }

    struct Rows {
        Numbers at[kTurns];
    };
    static Rows rows_of(const Scalar* arm) {
        Rows rows;
#pragma GCC unroll 4
        for (int turn = 1; turn < kTurns; ++turn) {
            rows.at[turn] = Numbers::of_rows(arm, turn);
        }
        return rows;
    }

    static void add_transposed_times(const Product& product, const Rows& rows, Sum& sum) {
        for (int part = 0; part < kTurns; ++part) {
            const Numbers numbers = product.at[part];
            sum.at[0].at[part].add(numbers);
            for (int turn = 1; turn < kTurns; ++turn) {
                sum.at[turn].at[part].add_times(numbers, rows.at[turn]);
            }
        }
    }

    static void store_block(const Sum& sum, Scalar* block) {
#pragma GCC unroll 4
        for (int j = 0; j < Dim; ++j) {
            store_column(
                sum, [&](const Product& of, int i) { return of.at[0].entry(i, j); }, j, block);
        }
        for_each_plane<Dim>([&](int p, int q, int k) {
            store_column(
                sum,
                [&](const Product& of, int i) {
                    return of.at[p ^ q].entry(i, q) - of.at[p ^ q].entry(i, p);
                },
                k, block);
        });
    }

private:
    // @param entry  entry(of, i) is entry i of this column of H T, given its Product.
    template <typename Entry>
    [[gnu::always_inline]] static void store_column(const Sum& sum,
                                                    const Entry& entry,
                                                    int column,
                                                    Scalar* block) {
#pragma GCC unroll 4
        for (int i = 0; i < Dim; ++i) {
            block[mode_entry<kModes>(i, column)] = entry(sum.at[0], i);
        }
        for_each_plane<Dim>([&](int p, int q, int k) {
            block[mode_entry<kModes>(k, column)] =
                entry(sum.at[p ^ q], q) - entry(sum.at[p ^ q], p);
        });
    }
};

// The same for children that have modes of their own. Columns of kModes rows are handled as vectors
// of Dim rows: the translations, then the rotations. The last vector ends with the last row, and so
// overlaps the one before: a few rows are computed twice.
template <int Dim, bool IsVectorized, typename Scalar>
struct GalerkinOfModes {
    using Vertex = typename VertexOf<Dim, IsVectorized, Scalar>::Type;
    static constexpr int kDim = Dim;
    static constexpr int kModes = simulator::kModes<Dim>;
    static constexpr int kRows = kModes;
    static constexpr int kVectors = (kRows + Dim - 1) / Dim;
    static constexpr int row_of(int vector) {
        return vector + 1 < kVectors ? Dim * vector : kRows - Dim;
    }

    struct Product {
        Vertex at[kModes][kVectors];
    };

    // T^T H T before the differences of rotations are taken. Of each column: the translations, the
    // same times each coordinate of the arm, then the rotations times the ratio of the arm.
    struct Sum {
        Vertex at[kModes][Dim + kVectors];
    };

    static void add_times(const Scalar* block, const Scalar* arm, Product& product) {
        Scalar columns[kModes * kModes];
        for (int entry = 0; entry < kModes * kModes; ++entry) {
            columns[entry] = block[kModePlaces<kModes>.at[entry]];
        }
#pragma GCC unroll 3
        for (int v = 0; v < kVectors; ++v) {
            const Scalar* rows = columns + row_of(v);
            Vertex axes[Dim];  // columns of the translations
            for (int c = 0; c < Dim; ++c) {
                load(rows + c * kRows, axes[c]);
                product.at[c][v] += axes[c];
            }
            for_each_plane<Dim>([&](int p, int q, int k) {
                product.at[k][v] += axes[q] * arm[p] - axes[p] * arm[q]
                                    + loaded<Vertex>(rows + k * kRows) * arm[Dim];
            });
        }
    }

    struct Rows {
        const Scalar* arm;
    };
    static Rows rows_of(const Scalar* arm) {
        return {arm};
    }

    static void add_transposed_times(const Product& product, const Rows& rows, Sum& sum) {
        const Scalar* arm = rows.arm;
        for (int c = 0; c < kModes; ++c) {
            const Vertex axes = product.at[c][0];
            sum.at[c][0] += axes;
            for (int p = 0; p < Dim; ++p) {
                sum.at[c][1 + p] += axes * arm[p];
            }
            for (int v = 1; v < kVectors; ++v) {
                sum.at[c][Dim + v] += product.at[c][v] * arm[Dim];
            }
        }
    }

    static void store_block(const Sum& sum, Scalar* block) {
        for (int c = 0; c < kModes; ++c) {
            const Vertex* of = sum.at[c];
            for (int i = 0; i < Dim; ++i) {
                block[mode_entry<kModes>(i, c)] = of[0][i];
            }
            for_each_plane<Dim>([&](int p, int q, int k) {
                const int v = k < row_of(kVectors - 1) ? k / Dim : kVectors - 1;
                block[mode_entry<kModes>(k, c)] =
                    of[1 + p][q] - of[1 + q][p] + of[Dim + v][k - row_of(v)];
            });
        }
    }
};

// Sums up one row of aggregates.
//
// For each child of the row its blocks are visited in order. Neighboring columns are mostly of one
// aggregate, whose Product then stays in registers from one block to the next.
template <typename Of, typename Scalar>
class GalerkinSum {
    static_assert(sizeof(typename Of::Product) + sizeof(typename Of::Sum)
                  == kGalerkinScratch<Of::kDim, Of::kRows> * sizeof(Scalar));

public:
    explicit GalerkinSum(const GalerkinRow<Scalar>& of)
        : of_(&of),
          sums_(reinterpret_cast<typename Of::Sum*>(of.scratch)),
          products_(reinterpret_cast<typename Of::Product*>(sums_ + of.blocks)) {}

    void add(const BlockRows<Scalar>& H) {
        for (std::size_t i = 0; i < of_->count; ++i) {
            const std::uint32_t next = of_->members[i + 2 < of_->count ? i + 2 : i];
            add_row(H, of_->members[i], H.values + H.row_start[next] * kEntries);
        }
    }

    // Many blocks of the row get nothing from H, and are zero: all of A that they are made of is in
    // the triangle that is not stored, and is added by the row of the other aggregate.
    void store(Scalar* blocks, Scalar* above) const {
        constexpr int kStored = Of::kModes * Of::kModes;
        for (std::size_t place = 0; place < of_->blocks; ++place, blocks += kStored) {
            if (place == of_->blocks - of_->above) {
                blocks = above;
            }
            if (of_->uses[place] == kNone) {
                __builtin_memset(blocks, 0, kStored * sizeof(Scalar));
            } else {
                Of::store_block(sums_[place], blocks);
                of_->uses[place] = kNone;
            }
        }
    }

private:
    static constexpr int kEntries = Of::kRows * Of::kRows;
    // What there is for a block of the row: nothing, a Sum, or that and a Product of this child.
    static constexpr std::uint8_t kNone = 0;
    static constexpr std::uint8_t kSum = 1;
    static constexpr std::uint8_t kProduct = 2;

    [[nodiscard]] const Scalar* arm_of(std::size_t child) const {
        return of_->arms + child * (Of::kDim + 1);
    }

    [[nodiscard]] std::uint32_t place_of(std::uint32_t child) const {
        return of_->places[of_->of_child[child]];
    }

    // @param row    A child.
    // @param ahead  Blocks that will be read soon, to be prefetched.
    void add_row(const BlockRows<Scalar>& H, std::uint32_t row, const Scalar* ahead) {
        const std::int64_t last = H.row_start[row + 1];
        std::int64_t k = H.row_start[row];
        std::size_t touched = 0;
        while (k < last) {
            const std::uint32_t place = place_of(H.columns[k]);
            typename Of::Product sum;
            if (of_->uses[place] == kProduct) {
                sum = products_[place];
            } else {
                if (of_->uses[place] == kNone) {
                    sums_[place] = {};
                }
                sum = {};
                of_->uses[place] = kProduct;
                of_->touched[touched++] = place;
            }
            do {
                __builtin_prefetch(ahead);
                ahead += kEntries;
                add_block(H, row, k, sum);
                ++k;
            } while (k < last && place_of(H.columns[k]) == place);
            products_[place] = sum;
        }
        const auto rows = Of::rows_of(arm_of(row));
        for (std::size_t t = 0; t < touched; ++t) {
            const std::uint32_t place = of_->touched[t];
            Of::add_transposed_times(products_[place], rows, sums_[place]);
            of_->uses[place] = kSum;
        }
    }

    void add_block(const BlockRows<Scalar>& H,
                   std::uint32_t row,
                   std::int64_t k,
                   typename Of::Product& sum) const {
        const Scalar* block = H.values + k * kEntries;
        const std::uint32_t column = H.columns[k];
        if (column != row) {
            Of::add_times(block, arm_of(column), sum);
            return;
        }
        Scalar half[kEntries];
        for (int entry = 0; entry < kEntries; ++entry) {
            half[entry] = block[entry] / 2;
        }
        Of::add_times(half, arm_of(column), sum);
    }

    const GalerkinRow<Scalar>* of_;
    typename Of::Sum* sums_;
    typename Of::Product* products_;
};

template <typename Of, typename Scalar>
void galerkin(const GalerkinRow<Scalar>& of,
              const SymmetricParts<Scalar>& A,
              Scalar* blocks,
              Scalar* above) {
    GalerkinSum<Of, Scalar> sum(of);
    sum.add(A.own);
    if (A.coupling.values != nullptr) {
        sum.add(A.coupling);
    }
    sum.store(blocks, above);
}

}  // namespace
}  // namespace pent::simulator
