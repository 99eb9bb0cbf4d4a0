#include "linear/aggregate_matrix.h"

#include "linear/parts.h"

#include <pent/dimensions.h>

#include <algorithm>
#include <array>
#include <numeric>
#include <span>

namespace pent::simulator {

namespace {

// Calls visit(row, k) for each block k below the diagonal.
template <typename Visit>
void for_each_below(const AggregatePattern& pattern, const Visit& visit) {
    for (std::size_t row = 0; row < pattern.diagonal.size(); ++row) {
        for (std::int64_t k = pattern.row_start[row]; k < pattern.diagonal[row]; ++k) {
            visit(row, static_cast<std::size_t>(k));
        }
    }
}

// Greedily: a batch ends before the first row that is linked to one of its rows. Aggregates are
// numbered by color, so there are about as many batches as colors.
void find_batches(AggregatePattern& pattern) {
    pattern.batches = {0};
    for (std::int64_t row = 0; row < pattern.rows(); ++row) {
        const auto at = static_cast<std::size_t>(row);
        const std::int64_t before = pattern.diagonal[at] - 1;
        if (before >= pattern.row_start[at]
            && pattern.columns[static_cast<std::size_t>(before)] >= pattern.batches.back()) {
            pattern.batches.push_back(row);
        }
    }
    pattern.batches.push_back(pattern.rows());
}

// Transposes the lower triangle: a counting sort of its blocks by column.
void list_above(AggregatePattern& pattern) {
    const auto rows = static_cast<std::size_t>(pattern.rows());
    pattern.above_start.assign(rows + 1, 0);
    for_each_below(pattern, [&](std::size_t /*row*/, std::size_t k) {
        ++pattern.above_start[pattern.columns[k] + std::size_t{1}];
    });
    std::partial_sum(pattern.above_start.begin(), pattern.above_start.end(),
                     pattern.above_start.begin());
    pattern.above.resize(static_cast<std::size_t>(pattern.above_start.back()));
    pattern.above_columns.resize(pattern.above.size());
    std::vector<std::int64_t> next = pattern.above_start;
    for_each_below(pattern, [&](std::size_t row, std::size_t k) {
        const auto at = static_cast<std::size_t>(next[pattern.columns[k]]++);
        pattern.above[at] = static_cast<std::uint32_t>(k);
        pattern.above_columns[at] = static_cast<std::uint32_t>(row);
    });
}

// @param for_each_link  Calls its argument with every pair of children that share a block, in one
//                       order or both; the first of a pair is of this rank.
template <typename ForEachLink>
AggregatePattern make_pattern_of(const Aggregates& aggregates, const ForEachLink& for_each_link) {
    const auto rows = static_cast<std::uint32_t>(aggregates.count());
    std::vector<std::vector<std::uint32_t>> found(rows);
    for (std::uint32_t row = 0; row < rows; ++row) {
        found[row].push_back(row);
    }
    for_each_link([&](std::uint32_t child, std::uint32_t other) {
        const std::uint32_t a = aggregates.of_child()[child];
        const std::uint32_t b = aggregates.of_child()[other];
        if (a != b && found[a].back() != b) {  // most repetitions come one after the other
            found[a].push_back(b);
            if (b < rows) {
                found[b].push_back(a);
            }
        }
    });
    for (std::vector<std::uint32_t>& columns : found) {
        std::sort(columns.begin(), columns.end());
        columns.erase(std::unique(columns.begin(), columns.end()), columns.end());
    }
    return {found, aggregates.ghosts()};
}

template <typename Pattern, typename Visit>
void for_each_block(const Pattern& pattern, const Visit& visit) {
    for (std::uint32_t row = 0; row < pattern.rows(); ++row) {
        for (std::int64_t k = pattern.row_start[row]; k < pattern.row_start[row + 1]; ++k) {
            visit(row, pattern.columns[static_cast<std::size_t>(k)]);
        }
    }
}

// Arms as GalerkinRow has them: of each child the coordinates, then the ratio.
template <typename Scalar, int Dim>
std::vector<Scalar, LineAllocator<Scalar>> numbers_of(const Workers& workers,
                                                      const Arms<Dim>& arms) {
    std::vector<Scalar, LineAllocator<Scalar>> numbers(arms.size() * (Dim + 1));
    const auto count = static_cast<std::int64_t>(arms.size());
    for_each_part(workers, 0, count, kLightChunk, [&](std::int64_t begin, std::int64_t end) {
        Scalar* next = numbers.data() + begin * (Dim + 1);
        for (auto child = static_cast<std::size_t>(begin); child < static_cast<std::size_t>(end);
             ++child) {
            for (const double coordinate : arms[child].x) {
                *next++ = static_cast<Scalar>(coordinate);
            }
            *next++ = static_cast<Scalar>(arms[child].ratio);
        }
    });
    return numbers;
}

// Makes one GalerkinRow after another, all with the same scratch.
template <int Dim, int Rows, typename Scalar>
class GalerkinRows {
public:
    // @param rows  That at() will be called for: they decide how much scratch is needed.
    GalerkinRows(const Aggregates& aggregates,
                 const Scalar* arms,
                 const AggregatePattern& pattern,
                 std::span<const std::uint32_t> rows)
        : aggregates_(&aggregates), arms_(arms), pattern_(&pattern) {
        std::uint32_t most = 0;
        std::uint32_t last = 0;
        for (const std::uint32_t row : rows) {
            std::uint32_t count = 0;
            for_each_column(row, [&](std::uint32_t column) {
                last = std::max(last, column);
                ++count;
            });
            most = std::max(most, count);
        }
        places_.resize(last + std::size_t{1});
        touched_.resize(most);
        uses_.resize(most);
        scratch_.resize(most * kGalerkinScratch<Dim, Rows>);
    }

    [[nodiscard]] GalerkinRow<Scalar> at(std::uint32_t row) {
        std::uint32_t count = 0;
        for_each_column(row, [&](std::uint32_t column) { places_[column] = count++; });
        const std::span<const std::uint32_t> members = aggregates_->members(row);
        const auto above =
            static_cast<std::size_t>(pattern_->above_start[row + 1] - pattern_->above_start[row]);
        return {members.data(), members.size(), arms_, aggregates_->of_child().data(),
                places_.data(), count,          above, touched_.data(),
                uses_.data(),   scratch_.data()};
    }

private:
    template <typename Visit>
    void for_each_column(std::uint32_t row, const Visit& visit) const {
        for_each_in_row(*pattern_, row,
                        [&](std::uint32_t column, std::int64_t /*block*/, bool /*is_transposed*/) {
                            visit(column);
                        });
    }

    const Aggregates* aggregates_;
    const Scalar* arms_;
    const AggregatePattern* pattern_;
    // By column; set only for those of the row at hand.
    std::vector<std::uint32_t, LineAllocator<std::uint32_t>> places_;
    std::vector<std::uint32_t> touched_;
    std::vector<std::uint8_t> uses_;
    std::vector<Scalar, LineAllocator<Scalar>> scratch_;
};

// Completes A = P^T H P + (P^T H P)^T in place. Kernels have stored the lower triangle of P^T H P
// in A and the upper one in `above`; the transposes of the latter, and of the diagonal blocks, are
// added to A. Ghost columns are complete already. No two threads write to the same block.
template <int Dim, typename Scalar>
void add_transposed(const Workers& workers,
                    const BlockKernels& kernels,
                    const std::vector<Scalar, LineAllocator<Scalar>>& above,
                    AggregateMatrix<Dim, Scalar>& A) {
    constexpr std::int64_t kEntries = AggregateMatrix<Dim, Scalar>::kEntries;
    const AggregatePattern& pattern = *A.pattern;
    const auto& add = mode_kernels_of<Scalar>(kernels).add_transposed;
    for_each_part(workers, 0, pattern.rows(), kModeRows, [&](std::int64_t begin, std::int64_t end) {
        for (auto row = static_cast<std::size_t>(begin); row < static_cast<std::size_t>(end);
             ++row) {
            Scalar* diagonal = A.values.data() + pattern.diagonal[row] * kEntries;
            std::array<Scalar, std::size_t{kEntries}> half = {};
            std::copy_n(diagonal, kEntries, half.data());
            add(half.data(), diagonal);
            for (std::int64_t i = pattern.above_start[row]; i < pattern.above_start[row + 1]; ++i) {
                add(above.data() + i * kEntries,
                    A.values.data() + pattern.above[static_cast<std::size_t>(i)] * kEntries);
            }
        }
    });
}

// @param kernel  The Galerkin kernel for this Scalar and for children of Rows unknowns.
template <int Dim, int Rows, typename Scalar, typename Kernel>
AggregateMatrix<Dim, Scalar> product_of(const Workers& workers,
                                        const BlockKernels& kernels,
                                        const Kernel& kernel,
                                        const SymmetricParts<Scalar>& A,
                                        const Aggregates& aggregates,
                                        const Arms<Dim>& arms,
                                        const AggregatePattern& pattern) {
    using Result = AggregateMatrix<Dim, Scalar>;
    Result result;
    result.pattern = &pattern;
    result.values.resize(pattern.columns.size() * Result::kEntries);
    std::vector<Scalar, LineAllocator<Scalar>> above(pattern.above.size() * Result::kEntries);
    const auto numbers = numbers_of<Scalar>(workers, arms);
    aggregates.for_each_part(workers, kModeRows, [&](std::span<const std::uint32_t> part) {
        GalerkinRows<Dim, Rows, Scalar> rows(aggregates, numbers.data(), pattern, part);
        for (const std::uint32_t row : part) {
            kernel(rows.at(row), A,
                   result.values.data() + pattern.row_start[row] * Result::kEntries,
                   above.data() + pattern.above_start[row] * Result::kEntries);
        }
    });
    add_transposed(workers, kernels, above, result);
    return result;
}

}  // namespace

AggregatePattern::AggregatePattern(const std::vector<std::vector<std::uint32_t>>& linked,
                                   std::uint32_t of_others)
    : row_start{0}, ghosts(of_others) {
    for (std::uint32_t row = 0; row < linked.size(); ++row) {
        for (const std::uint32_t column : linked[row]) {
            if (column == row) {
                diagonal.push_back(static_cast<std::int64_t>(columns.size()));
            }
            if (column <= row || column >= linked.size()) {
                columns.push_back(column);
            }
        }
        row_start.push_back(static_cast<std::int64_t>(columns.size()));
    }
    list_above(*this);
    find_batches(*this);
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
void AggregateMatrix<Dim, Scalar>::subtract_product(const Workers& workers,
                                                    const BlockKernels& kernels,
                                                    const Vector& r,
                                                    const Vector& x,
                                                    Vector& left,
                                                    Shares& shares) const {
    left.resize(r.size());
    for_each_part(workers, 0, pattern->rows(), kModeRows,
                  [&](std::int64_t begin, std::int64_t end) {
                      mode_kernels_of<Scalar>(kernels).subtract_below(
                          mode_rows(begin, end, shares), r.data(), x.data(), left.data());
                  });
    subtract_above(workers, kernels, x, left, shares);
}

template <int Dim, typename Scalar>
void AggregateMatrix<Dim, Scalar>::subtract_above(const Workers& workers,
                                                  const BlockKernels& kernels,
                                                  const Vector& x,
                                                  Vector& left,
                                                  Shares& shares) const {
    for_each_part(workers, 0, pattern->rows(), kModeRows,
                  [&](std::int64_t begin, std::int64_t end) {
                      mode_kernels_of<Scalar>(kernels).subtract_above(mode_rows(begin, end, shares),
                                                                      x.data(), left.data());
                  });
}

template <int Dim, typename Scalar>
AggregateMatrix<Dim, Scalar> galerkin_product(const Workers& workers,
                                              const BlockKernels& kernels,
                                              const BlockMatrix<Dim, Scalar>& A,
                                              const Aggregates& aggregates,
                                              const Arms<Dim>& arms,
                                              const AggregatePattern& pattern) {
    SymmetricParts<Scalar> parts{A.all_rows(), {}};
    if (A.coupling() != nullptr) {
        parts.coupling = A.coupling()->all_rows();
    }
    if constexpr (sizeof(Scalar) == sizeof(float)) {
        return product_of<Dim, Dim>(workers, kernels, kernels.galerkin_float, parts, aggregates,
                                    arms, pattern);
    } else {
        return product_of<Dim, Dim>(workers, kernels, kernels.galerkin_double, parts, aggregates,
                                    arms, pattern);
    }
}

template <int Dim, typename Scalar>
AggregateMatrix<Dim, Scalar> galerkin_product(const Workers& workers,
                                              const BlockKernels& kernels,
                                              const AggregateMatrix<Dim, Scalar>& A,
                                              const Aggregates& aggregates,
                                              const Arms<Dim>& arms,
                                              const AggregatePattern& pattern) {
    const SymmetricParts<Scalar> parts{A.all_rows(), {}};
    if constexpr (sizeof(Scalar) == sizeof(float)) {
        return product_of<Dim, kModes<Dim>>(workers, kernels, kernels.galerkin_modes_float, parts,
                                            aggregates, arms, pattern);
    } else {
        return product_of<Dim, kModes<Dim>>(workers, kernels, kernels.galerkin_modes_double, parts,
                                            aggregates, arms, pattern);
    }
}

#define PENT_INSTANTIATE(Dim, Scalar)                                                            \
    template struct AggregateMatrix<Dim, Scalar>;                                                \
    template AggregateMatrix<Dim, Scalar> galerkin_product(                                      \
        const Workers&, const BlockKernels&, const BlockMatrix<Dim, Scalar>&, const Aggregates&, \
        const Arms<Dim>&, const AggregatePattern&);                                              \
    template AggregateMatrix<Dim, Scalar> galerkin_product(                                      \
        const Workers&, const BlockKernels&, const AggregateMatrix<Dim, Scalar>&,                \
        const Aggregates&, const Arms<Dim>&, const AggregatePattern&);
PENT_FOR_EACH_DIMENSION(PENT_INSTANTIATE, float)
PENT_FOR_EACH_DIMENSION(PENT_INSTANTIATE, double)
#undef PENT_INSTANTIATE

}  // namespace pent::simulator
