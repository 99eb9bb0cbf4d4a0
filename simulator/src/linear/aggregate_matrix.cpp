#include "linear/aggregate_matrix.h"

#include <pent/dimensions.h>

#include <algorithm>
#include <span>

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

constexpr std::int64_t kChunkRows = 16;  // of a task

// Calls work(begin, end) for chunks of rows, at the same time.
template <typename Work>
void for_each_chunk(const Workers& workers, std::int64_t rows, const Work& work) {
    workers.for_each((rows + kChunkRows - 1) / kChunkRows, [&](std::int64_t chunk) {
        work(chunk * kChunkRows, std::min(rows, (chunk + 1) * kChunkRows));
    });
}

// Of children, as kernels take them: coordinates, then the ratio.
template <typename Scalar, int Dim>
std::vector<Scalar> numbers_of(const std::vector<Arm<Dim>>& arms) {
    std::vector<Scalar> numbers;
    numbers.reserve(arms.size() * (Dim + 1));
    for (const Arm<Dim>& arm : arms) {
        for (const double coordinate : arm.x) {
            numbers.push_back(static_cast<Scalar>(coordinate));
        }
        numbers.push_back(static_cast<Scalar>(arm.ratio));
    }
    return numbers;
}

// Rows of aggregates one after the other, with the room that kernels need.
template <int Dim, int Rows, typename Scalar>
class GalerkinRows {
public:
    // Of the rows [begin, end) at most.
    GalerkinRows(const Aggregates& aggregates,
                 const std::vector<Scalar>& arms,
                 const AggregatePattern& pattern,
                 std::int64_t begin,
                 std::int64_t end)
        : aggregates_(&aggregates), arms_(&arms), pattern_(&pattern) {
        std::size_t most = 0;
        std::uint32_t last = 0;
        for (std::int64_t row = begin; row < end; ++row) {
            most = std::max(most, columns_of(row).size());
            last = std::max(last, columns_of(row).back());
        }
        places_.resize(last + std::size_t{1});
        touched_.resize(most);
        uses_.resize(most);
        scratch_.resize(most * kGalerkinScratch<Dim, Rows>);
    }

    [[nodiscard]] GalerkinRow<Scalar> at(std::int64_t row) {
        const std::span<const std::uint32_t> columns = columns_of(row);
        for (std::uint32_t place = 0; place < columns.size(); ++place) {
            places_[columns[place]] = place;
        }
        const auto& members = aggregates_->members[static_cast<std::size_t>(row)];
        return {members.data(), members.size(), arms_->data(),   aggregates_->of_child.data(),
                places_.data(), columns.size(), touched_.data(), uses_.data(),
                scratch_.data()};
    }

private:
    [[nodiscard]] std::span<const std::uint32_t> columns_of(std::int64_t row) const {
        const auto r = static_cast<std::size_t>(row);
        return {pattern_->columns.data() + pattern_->row_start[r],
                pattern_->columns.data() + pattern_->row_start[r + 1]};
    }

    const Aggregates* aggregates_;
    const std::vector<Scalar>* arms_;
    const AggregatePattern* pattern_;
    std::vector<std::uint32_t> places_;
    std::vector<std::uint32_t> touched_;
    std::vector<std::uint8_t> uses_;
    std::vector<Scalar, LineAllocator<Scalar>> scratch_;
};

// A = H + H^T, in place; what is between ranks is whole. Each pair of blocks is one thread's.
template <int Dim, typename Scalar>
void add_transposed(const Workers& workers, AggregateMatrix<Dim, Scalar>& A) {
    const AggregatePattern& pattern = *A.pattern;
    for_each_chunk(workers, pattern.rows(), [&](std::int64_t begin, std::int64_t end) {
        for (auto row = static_cast<std::uint32_t>(begin); row < end; ++row) {
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
        }
    });
}

// @param kernel  Of A and the Scalar, for children of so many Rows.
template <int Dim, int Rows, typename Scalar, typename Kernel>
AggregateMatrix<Dim, Scalar> product_of(const Workers& workers,
                                        const Kernel& kernel,
                                        const SymmetricParts<Scalar>& A,
                                        const Aggregates& aggregates,
                                        const std::vector<Arm<Dim>>& arms,
                                        const AggregatePattern& pattern) {
    using Result = AggregateMatrix<Dim, Scalar>;
    Result result;
    result.pattern = &pattern;
    result.values.resize(pattern.columns.size() * Result::kEntries);
    const std::vector<Scalar> numbers = numbers_of<Scalar>(arms);
    for_each_chunk(workers, pattern.rows(), [&](std::int64_t begin, std::int64_t end) {
        GalerkinRows<Dim, Rows, Scalar> rows(aggregates, numbers, pattern, begin, end);
        for (std::int64_t row = begin; row < end; ++row) {
            const std::int64_t first = pattern.row_start[static_cast<std::size_t>(row)];
            kernel(rows.at(row), A, result.values.data() + first * Result::kEntries);
        }
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
                                              const BlockKernels& kernels,
                                              const BlockMatrix<Dim, Scalar>& A,
                                              const Aggregates& aggregates,
                                              const std::vector<Arm<Dim>>& arms,
                                              const AggregatePattern& pattern) {
    SymmetricParts<Scalar> parts{A.all_rows(), {}};
    if (A.coupling() != nullptr) {
        parts.coupling = A.coupling()->all_rows();
    }
    if constexpr (sizeof(Scalar) == sizeof(float)) {
        return product_of<Dim, Dim>(workers, kernels.galerkin_float, parts, aggregates, arms,
                                    pattern);
    } else {
        return product_of<Dim, Dim>(workers, kernels.galerkin_double, parts, aggregates, arms,
                                    pattern);
    }
}

template <int Dim, typename Scalar>
AggregateMatrix<Dim, Scalar> galerkin_product(const Workers& workers,
                                              const BlockKernels& kernels,
                                              const AggregateMatrix<Dim, Scalar>& A,
                                              const Aggregates& aggregates,
                                              const std::vector<Arm<Dim>>& arms,
                                              const AggregatePattern& pattern) {
    const SymmetricParts<Scalar> parts{A.all_rows(), {}};
    if constexpr (sizeof(Scalar) == sizeof(float)) {
        return product_of<Dim, kModes<Dim>>(workers, kernels.galerkin_modes_float, parts,
                                            aggregates, arms, pattern);
    } else {
        return product_of<Dim, kModes<Dim>>(workers, kernels.galerkin_modes_double, parts,
                                            aggregates, arms, pattern);
    }
}

#define PENT_INSTANTIATE(Dim, Scalar)                                                            \
    template struct AggregateMatrix<Dim, Scalar>;                                                \
    template AggregateMatrix<Dim, Scalar> galerkin_product(                                      \
        const Workers&, const BlockKernels&, const BlockMatrix<Dim, Scalar>&, const Aggregates&, \
        const std::vector<Arm<Dim>>&, const AggregatePattern&);                                  \
    template AggregateMatrix<Dim, Scalar> galerkin_product(                                      \
        const Workers&, const BlockKernels&, const AggregateMatrix<Dim, Scalar>&,                \
        const Aggregates&, const std::vector<Arm<Dim>>&, const AggregatePattern&);
PENT_FOR_EACH_DIMENSION(PENT_INSTANTIATE, float)
PENT_FOR_EACH_DIMENSION(PENT_INSTANTIATE, double)
#undef PENT_INSTANTIATE

}  // namespace pent::simulator
