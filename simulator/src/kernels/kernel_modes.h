#pragma once

#include "kernels/kernel_vertices.h"
#include "linear/block_kernels.h"
#include "linear/rigid_mode_order.h"

// Rigid modes of aggregates: RigidModes has the formulas, one child at a time.
//
// What a child at x (relative to the middle) turns with plane p < q is mode k. Sums over children
// keep the products of x and the numbers of the child, and take the differences that are modes at
// the end.

namespace pent::simulator {
namespace {  // NOLINT(google-build-namespaces): see kernel_lanes.h

template <int Dim, bool IsVectorized>
void sum_forces(const AggregateChildren& children, const double* r, double* modes) {
    using Vertex = typename VertexOf<Dim, IsVectorized>::Type;
    Vertex sum = {};
    Vertex turned[Dim] = {};  // x_p r
    for (std::size_t i = 0; i < children.count; ++i) {
        const std::size_t child = children.members[i];
        const auto force = loaded<Vertex>(r + child * Dim);
        const double* x = children.arms + child * children.arm_stride;
        sum += force;
        for (int p = 0; p < Dim; ++p) {
            turned[p] += force * x[p];
        }
    }
    store(sum, modes);
    for_each_plane<Dim>([&](int p, int q, int k) { modes[k] = turned[p][q] - turned[q][p]; });
}

template <int Dim, bool IsVectorized>
void add_motions(const AggregateChildren& children, const double* modes, double* x) {
    using Vertex = typename VertexOf<Dim, IsVectorized>::Type;
    const auto shift = loaded<Vertex>(modes);
    Vertex turn[Dim] = {};  // what a unit of x_p is moved by
    for_each_plane<Dim>([&](int p, int q, int k) {
        turn[p][q] = modes[k];
        turn[q][p] = -modes[k];
    });
    for (std::size_t i = 0; i < children.count; ++i) {
        const std::size_t child = children.members[i];
        const double* arm = children.arms + child * children.arm_stride;
        Vertex motion = shift;
        for (int p = 0; p < Dim; ++p) {
            motion += turn[p] * arm[p];
        }
        store(loaded<Vertex>(x + child * Dim) + motion, x + child * Dim);
    }
}

// One row of aggregates of T^T H T, see GalerkinRow. What a child has is in vectors of Dim rows:
// those of the axes, then, where it has modes of its own, those of rotations, the last of which
// ends with the rows: some may be in two, and computed twice.
template <int Dim, int Rows, bool IsVectorized>
struct Galerkin {
    using Vertex = typename VertexOf<Dim, IsVectorized>::Type;
    static constexpr int kColumns = kModes<Dim>;
    static constexpr int kVectors = (Rows + Dim - 1) / Dim;
    static constexpr int row_of(int vector) {
        return vector + 1 < kVectors ? Dim * vector : Rows - Dim;
    }

    // H T of a child, added up over the children of one aggregate.
    struct Product {
        Vertex at[kColumns][kVectors];
    };

    // T^T of that, but for the differences that rotations are. Of a column: the axes, those times
    // each coordinate of the arm, and rotations times its ratio.
    struct Sum {
        Vertex at[kColumns][Dim + kVectors];
    };

    static_assert(sizeof(Product) + sizeof(Sum) == kGalerkinScratch<Dim, Rows> * sizeof(double));

    template <typename Scalar>
    static void add_times(const Scalar* block, const double* arm, Product& product) {
        add_part_times<0>(block, arm, product);
        if constexpr (kVectors > 1) {
            add_part_times<1>(block, arm, product);
        }
        if constexpr (kVectors > 2) {
            add_part_times<2>(block, arm, product);
        }
    }

    // The rows of one vector.
    template <int Vector, typename Scalar>
    static void add_part_times(const Scalar* block, const double* arm, Product& product) {
        static_assert(kVectors <= 3);
        Vertex axes[Dim];
        if constexpr (Rows == Dim) {
            load_columns(block, axes);
        } else {
            block += row_of(Vector);
            for (int c = 0; c < Dim; ++c) {
                load(block + c * Rows, axes[c]);
            }
        }
        for (int c = 0; c < Dim; ++c) {
            product.at[c][Vector] += axes[c];
        }
        for_each_plane<Dim>([&](int p, int q, int k) {
            Vertex sum = product.at[k][Vector] + axes[q] * arm[p] - axes[p] * arm[q];
            if constexpr (Rows > Dim) {
                sum += loaded<Vertex>(block + k * Rows) * arm[Dim];
            }
            product.at[k][Vector] = sum;
        });
    }

    static void add_transposed_times(const Product& product, const double* arm, Sum& sum) {
        for (int c = 0; c < kColumns; ++c) {
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

    template <typename Scalar>
    static void store_block(const Sum& sum, Scalar* block) {
        for (int c = 0; c < kColumns; ++c, block += kColumns) {
            const Vertex* of = sum.at[c];
            for (int i = 0; i < Dim; ++i) {
                block[i] = static_cast<Scalar>(of[0][i]);
            }
            for_each_plane<Dim>([&](int p, int q, int k) {
                double entry = of[1 + p][q] - of[1 + q][p];
                if constexpr (Rows > Dim) {
                    const int v = k < row_of(kVectors - 1) ? k / Dim : kVectors - 1;
                    entry += of[Dim + v][k - row_of(v)];
                }
                block[k] = static_cast<Scalar>(entry);
            });
        }
    }
};

// Products of a row with all children of an aggregate are added up first: neighbors in the row
// mostly are of one aggregate, and their sum stays in registers.
template <int Dim, int Rows, bool IsVectorized, typename Scalar>
class GalerkinSum {
public:
    using Of = Galerkin<Dim, Rows, IsVectorized>;

    explicit GalerkinSum(const GalerkinRow& of)
        : of_(&of),
          sums_(reinterpret_cast<typename Of::Sum*>(of.scratch)),
          products_(reinterpret_cast<typename Of::Product*>(sums_ + of.blocks)) {
        for (std::size_t block = 0; block < of.blocks; ++block) {
            sums_[block] = {};
        }
    }

    void add(const BlockRows<Scalar>& H) {
        const AggregateChildren& children = of_->children;
        for (std::size_t i = 0; i < children.count; ++i) {
            const std::uint32_t next = children.members[i + 1 < children.count ? i + 1 : i];
            add_row(H, children.members[i], H.values + H.row_start[next] * kEntries);
        }
    }

    void store(Scalar* blocks) const {
        for (std::size_t block = 0; block < of_->blocks; ++block) {
            Of::store_block(sums_[block], blocks + block * Of::kColumns * Of::kColumns);
        }
    }

private:
    static constexpr int kEntries = Rows * Rows;

    [[nodiscard]] const double* arm_of(std::size_t child) const {
        return of_->children.arms + child * of_->children.arm_stride;
    }

    [[nodiscard]] std::uint32_t place_of(std::uint32_t child) const {
        return of_->places[of_->of_child[child]];
    }

    // @param ahead  What will be read next, to be brought near.
    void add_row(const BlockRows<Scalar>& H, std::uint32_t row, const Scalar* ahead) {
        const std::int64_t last = H.row_start[row + 1];
        std::int64_t k = H.row_start[row];
        while (H.columns[k] < row) {
            ++k;
        }
        std::size_t touched = 0;
        while (k < last) {
            const std::uint32_t place = place_of(H.columns[k]);
            typename Of::Product sum;
            if (of_->is_touched[place] != 0) {
                sum = products_[place];
            } else {
                sum = {};
                of_->is_touched[place] = 1;
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
        for (std::size_t t = 0; t < touched; ++t) {
            const std::uint32_t place = of_->touched[t];
            Of::add_transposed_times(products_[place], arm_of(row), sums_[place]);
            of_->is_touched[place] = 0;
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

    const GalerkinRow* of_;
    typename Of::Sum* sums_;
    typename Of::Product* products_;
};

template <int Dim, int Rows, bool IsVectorized, typename Scalar>
void galerkin(const GalerkinRow& of, const SymmetricParts<Scalar>& A, Scalar* blocks) {
    GalerkinSum<Dim, Rows, IsVectorized, Scalar> sum(of);
    sum.add(A.own);
    if (A.coupling.values != nullptr) {
        sum.add(A.coupling);
    }
    sum.store(blocks);
}

}  // namespace
}  // namespace pent::simulator
