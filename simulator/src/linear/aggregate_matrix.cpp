#include "linear/aggregate_matrix.h"

#include <pent/dimensions.h>

#include <algorithm>

namespace pent::simulator {

namespace {

// As long as the next row is linked to none of the batch.
void find_batches(AggregatePattern& pattern) {
    pattern.batches = {0};
    for (std::int64_t row = 0; row < pattern.rows(); ++row) {
        const auto at = static_cast<std::uint32_t>(row);
        pattern.diagonal.push_back(pattern.find(at, at));
        pattern.above.push_back(pattern.diagonal.back() + 1);
        const std::int64_t before = pattern.diagonal.back() - 1;
        if (before >= pattern.row_start[at]
            && pattern.columns[static_cast<std::size_t>(before)] >= pattern.batches.back()) {
            pattern.batches.push_back(row);
        }
    }
    pattern.batches.push_back(pattern.rows());
}

// @param for_each_link  Calls its argument with every pair of children that share a block, once at
//                       least, one way round or both.
template <typename ForEachLink>
AggregatePattern make_pattern_of(const Aggregates& aggregates, const ForEachLink& for_each_link) {
    const auto rows = static_cast<std::uint32_t>(aggregates.count());
    std::vector<std::vector<std::uint32_t>> found(rows);
    for (std::uint32_t row = 0; row < rows; ++row) {
        found[row].push_back(row);
    }
    for_each_link([&](std::uint32_t child, std::uint32_t other) {
        const std::uint32_t a = aggregates.of_child[child];
        const std::uint32_t b = aggregates.of_child[other];
        if (a != b && found[a].back() != b) {  // most repetitions come one after the other
            found[a].push_back(b);
            if (b < rows) {
                found[b].push_back(a);
            }
        }
    });
    AggregatePattern pattern;
    pattern.ghosts = aggregates.ghosts;
    pattern.row_start.push_back(0);
    for (std::vector<std::uint32_t>& columns : found) {
        std::sort(columns.begin(), columns.end());
        const auto last = std::unique(columns.begin(), columns.end());
        pattern.columns.insert(pattern.columns.end(), columns.begin(), last);
        pattern.row_start.push_back(static_cast<std::int64_t>(pattern.columns.size()));
    }
    find_batches(pattern);
    return pattern;
}

template <typename Pattern, typename Visit>
void for_each_block(const Pattern& pattern, const Visit& visit) {
    for (std::uint32_t row = 0; row < pattern.rows(); ++row) {
        for (std::int64_t k = pattern.row_start[row]; k < pattern.row_start[row + 1]; ++k) {
            visit(row, pattern.columns[static_cast<std::size_t>(k)]);
        }
    }
}

// One row of P^T H P, where A = H + H^T: the upper triangle of A with its diagonal halved, and all
// blocks in columns of other ranks.
template <int Dim, int Rows>
class RowProduct {
public:
    RowProduct(const Aggregates& aggregates,
               const std::vector<Arm<Dim>>& arms,
               const AggregatePattern& pattern,
               std::uint32_t row)
        : aggregates_(&aggregates),
          arms_(&arms),
          columns_(pattern.columns.data() + pattern.row_start[row],
                   pattern.columns.data() + pattern.row_start[row + 1]),
          members_(&aggregates.members[row]),
          blocks_(columns_.size(), Sum::Zero()),
          parts_(columns_.size(), Product::Zero()) {}

    // Products of a row with all children of an aggregate are added up first.
    template <typename Pattern, typename Matrix>
    void add(const Pattern& pattern, const Matrix& A) {
        for (const std::uint32_t row : *members_) {
            touched_.clear();
            for (std::int64_t k = pattern.row_start[row]; k < pattern.row_start[row + 1]; ++k) {
                const std::uint32_t column = pattern.columns[static_cast<std::size_t>(k)];
                if (column < row) {
                    continue;
                }
                Eigen::Matrix<double, Rows, Rows> block = A.block(k).template cast<double>();
                if (column == row) {
                    block *= 0.5;
                }
                const std::size_t at = place_of(aggregates_->of_child[column]);
                if (std::find(touched_.begin(), touched_.end(), at) == touched_.end()) {
                    touched_.push_back(at);
                }
                parts_[at] += RigidModes<Dim, Rows>::times(block, (*arms_)[column]);
            }
            for (const std::size_t at : touched_) {
                RigidModes<Dim, Rows>::add_transposed_times(parts_[at], (*arms_)[row], blocks_[at]);
                parts_[at].setZero();
            }
        }
    }

    template <typename Scalar>
    void store(Scalar* values) const {
        for (const Sum& block : blocks_) {
            Eigen::Map<Eigen::Matrix<Scalar, kModes<Dim>, kModes<Dim>>>{values} =
                block.template cast<Scalar>();
            values += Sum::SizeAtCompileTime;
        }
    }

private:
    using Product = typename RigidModes<Dim, Rows>::Product;
    using Sum = typename RigidModes<Dim, Rows>::Square;

    [[nodiscard]] std::size_t place_of(std::uint32_t aggregate) const {
        return static_cast<std::size_t>(
            std::lower_bound(columns_.begin(), columns_.end(), aggregate) - columns_.begin());
    }

    const Aggregates* aggregates_;
    const std::vector<Arm<Dim>>* arms_;
    std::vector<std::uint32_t> columns_;
    const std::vector<std::uint32_t>* members_;
    std::vector<Sum> blocks_;
    std::vector<Product> parts_;
    std::vector<std::size_t> touched_;
};

template <typename Work>
void for_each_row(const Workers& workers, std::int64_t rows, const Work& work) {
    constexpr std::int64_t kChunk = 16;
    workers.for_each((rows + kChunk - 1) / kChunk, [&](std::int64_t chunk) {
        for (std::int64_t row = chunk * kChunk; row < std::min(rows, (chunk + 1) * kChunk); ++row) {
            work(static_cast<std::uint32_t>(row));
        }
    });
}

// A = H + H^T, in place; what is between ranks is whole. Each pair of blocks is one thread's.
template <int Dim, typename Scalar>
void add_transposed(const Workers& workers, AggregateMatrix<Dim, Scalar>& A) {
    const AggregatePattern& pattern = *A.pattern;
    for_each_row(workers, pattern.rows(), [&](std::uint32_t row) {
        for (std::int64_t k = pattern.diagonal[row]; k < pattern.row_start[row + 1]; ++k) {
            const std::uint32_t column = pattern.columns[static_cast<std::size_t>(k)];
            if (column >= pattern.rows()) {
                break;
            }
            auto upper = A.block(k);
            auto lower = A.block(pattern.find(column, row));
            const typename AggregateMatrix<Dim, Scalar>::Block sum = upper + lower.transpose();
            upper = sum;
            lower = sum.transpose();
        }
    });
}

// @param add  Adds all there is to a RowProduct.
template <int Dim, int Rows, typename Scalar, typename Add>
AggregateMatrix<Dim, Scalar> product_of(const Workers& workers,
                                        const Aggregates& aggregates,
                                        const std::vector<Arm<Dim>>& arms,
                                        const AggregatePattern& pattern,
                                        const Add& add) {
    using Result = AggregateMatrix<Dim, Scalar>;
    Result result;
    result.pattern = &pattern;
    result.values.resize(pattern.columns.size() * Result::kEntries);
    for_each_row(workers, pattern.rows(), [&](std::uint32_t row) {
        RowProduct<Dim, Rows> product(aggregates, arms, pattern, row);
        add(product);
        product.store(result.values.data() + pattern.row_start[row] * Result::kEntries);
    });
    add_transposed(workers, result);
    return result;
}

}  // namespace

std::int64_t AggregatePattern::find(std::uint32_t row, std::uint32_t column) const {
    const auto first = columns.begin() + row_start[row];
    const auto last = columns.begin() + row_start[row + 1];
    return std::lower_bound(first, last, column) - columns.begin();
}

AggregatePattern make_aggregate_pattern(const Aggregates& aggregates,
                                        const BlockPattern& children,
                                        const BlockPattern* coupling) {
    return make_pattern_of(aggregates, [&](const auto& visit) {
        for_each_block(children, visit);
        if (coupling != nullptr) {
            for_each_block(*coupling, visit);
        }
    });
}

AggregatePattern make_aggregate_pattern(const Aggregates& aggregates,
                                        const AggregatePattern& children) {
    return make_pattern_of(aggregates, [&](const auto& visit) { for_each_block(children, visit); });
}

template <int Dim, typename Scalar>
void AggregateMatrix<Dim, Scalar>::multiply(const Workers& workers,
                                            const BlockKernels& kernels,
                                            BlockPart part,
                                            const Vector& x,
                                            Vector& y) const {
    constexpr std::int64_t kRows = 64;  // of a task
    const std::int64_t rows = pattern->rows();
    y.resize(static_cast<Eigen::Index>(kModes<Dim> * rows));
    workers.for_each((rows + kRows - 1) / kRows, [&](std::int64_t chunk) {
        multiply_rows(kernels, part, {chunk * kRows, std::min((chunk + 1) * kRows, rows)}, x.data(),
                      y.data());
    });
}

template <int Dim, typename Scalar>
void AggregateMatrix<Dim, Scalar>::multiply_rows(
    const BlockKernels& kernels, BlockPart part, RowRange rows, const Scalar* x, Scalar* y) const {
    const std::int64_t* start = pattern->row_start.data();
    BlockSpans<Scalar> spans{values.data(),           start,      start + 1,
                             pattern->columns.data(), rows.begin, rows.end};
    if (part == BlockPart::BelowDiagonal) {
        spans.last = pattern->diagonal.data();
    } else if (part == BlockPart::AboveDiagonal) {
        spans.first = pattern->above.data();
    }
    if constexpr (sizeof(Scalar) == sizeof(float)) {
        kernels.multiply_modes_float(spans, x, y);
    } else {
        kernels.multiply_modes_double(spans, x, y);
    }
}

template <int Dim, typename Scalar>
AggregateMatrix<Dim, Scalar> galerkin_product(const Workers& workers,
                                              const BlockMatrix<Dim, Scalar>& A,
                                              const Aggregates& aggregates,
                                              const std::vector<Arm<Dim>>& arms,
                                              const AggregatePattern& pattern) {
    return product_of<Dim, Dim, Scalar>(workers, aggregates, arms, pattern,
                                        [&](RowProduct<Dim, Dim>& product) {
                                            product.add(A.pattern(), A);
                                            if (A.coupling() != nullptr) {
                                                product.add(A.coupling()->pattern(), *A.coupling());
                                            }
                                        });
}

template <int Dim, typename Scalar>
AggregateMatrix<Dim, Scalar> galerkin_product(const Workers& workers,
                                              const AggregateMatrix<Dim, Scalar>& A,
                                              const Aggregates& aggregates,
                                              const std::vector<Arm<Dim>>& arms,
                                              const AggregatePattern& pattern) {
    return product_of<Dim, kModes<Dim>, Scalar>(
        workers, aggregates, arms, pattern,
        [&](RowProduct<Dim, kModes<Dim>>& product) { product.add(*A.pattern, A); });
}

#define PENT_INSTANTIATE(Dim, Scalar)                                           \
    template struct AggregateMatrix<Dim, Scalar>;                               \
    template AggregateMatrix<Dim, Scalar> galerkin_product(                     \
        const Workers&, const BlockMatrix<Dim, Scalar>&, const Aggregates&,     \
        const std::vector<Arm<Dim>>&, const AggregatePattern&);                 \
    template AggregateMatrix<Dim, Scalar> galerkin_product(                     \
        const Workers&, const AggregateMatrix<Dim, Scalar>&, const Aggregates&, \
        const std::vector<Arm<Dim>>&, const AggregatePattern&);
PENT_FOR_EACH_DIMENSION(PENT_INSTANTIATE, float)
PENT_FOR_EACH_DIMENSION(PENT_INSTANTIATE, double)
#undef PENT_INSTANTIATE

}  // namespace pent::simulator
