#include "linear/shared_coarse_solver.h"

#include <pent/dimensions.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numeric>
#include <utility>

namespace pent::simulator {

namespace {

// The rows of this rank, of both triangles, with columns counted over all ranks.
//
// @param first  First row of each rank.
template <int Dim, typename Scalar>
SpreadMatrix spread(const AggregateMatrix<Dim, Scalar>& A,
                    const Ghosts& ghosts,
                    const std::vector<std::int64_t>& first,
                    std::size_t rank) {
    constexpr int kSize = kModes<Dim>;
    const AggregatePattern& pattern = *A.pattern;
    SpreadMatrix spread;
    spread.block_size = kSize;
    spread.first_row = first[rank];
    spread.row_start.push_back(0);
    const auto number = [&](std::int64_t column) {
        if (column < pattern.rows()) {
            return first[rank] + column;
        }
        const auto ghost = static_cast<std::size_t>(column - pattern.rows());
        return first[ghosts.owners[ghost]] + ghosts.places[ghost];
    };
    struct Entry {
        std::int64_t column;
        std::int64_t block;
        bool is_transposed;
    };
    std::vector<Entry> of_row;
    for (std::uint32_t row = 0; row < pattern.rows(); ++row) {
        of_row.clear();
        for_each_in_row(pattern, row,
                        [&](std::uint32_t column, std::int64_t k, bool is_transposed) {
                            of_row.push_back({number(column), k, is_transposed});
                        });
        std::sort(of_row.begin(), of_row.end(),
                  [](const Entry& a, const Entry& b) { return a.column < b.column; });
        for (const Entry& entry : of_row) {
            Eigen::Matrix<double, kSize, kSize, Eigen::RowMajor> block =
                A.block(entry.block).template cast<double>();
            if (entry.is_transposed) {
                block.transposeInPlace();
            }
            spread.columns.push_back(entry.column);
            spread.values.insert(spread.values.end(), block.data(), block.data() + block.size());
        }
        spread.row_start.push_back(static_cast<std::int64_t>(spread.columns.size()));
    }
    return spread;
}

// Concatenates what each rank has, in their order.
std::vector<double> gather(const Sharing& sharing, const std::vector<double>& own) {
    std::vector<std::int64_t> sizes;
    for (const double size : sharing.list(static_cast<double>(own.size()))) {
        sizes.push_back(static_cast<std::int64_t>(size));
    }
    return sharing.ranks().gather(own, sizes);
}

// Gathers the rows of all ranks and factors them, the same on all.
template <int Dim, typename Scalar>
CoarseSolver<Dim, Scalar> factor(const Workers& workers,
                                 const Sharing& sharing,
                                 const SpreadMatrix& own) {
    using Matrix = AggregateMatrix<Dim, Scalar>;
    using Rows = Eigen::Matrix<double, kModes<Dim>, kModes<Dim>, Eigen::RowMajor>;
    std::vector<double> blocks;  // how many each row has
    for (std::size_t row = 0; row + 1 < own.row_start.size(); ++row) {
        blocks.push_back(static_cast<double>(own.row_start[row + 1] - own.row_start[row]));
    }
    const std::vector<double> counts = gather(sharing, blocks);
    const std::vector<double> columns = gather(sharing, {own.columns.begin(), own.columns.end()});
    const std::vector<double> values = gather(sharing, own.values);
    std::vector<std::vector<std::uint32_t>> linked;
    std::vector<std::size_t> stored;  // blocks of the lower triangle
    std::size_t k = 0;
    for (const double count : counts) {
        const auto row = static_cast<double>(linked.size());
        linked.emplace_back();
        for (const std::size_t end = k + static_cast<std::size_t>(count); k < end; ++k) {
            linked.back().push_back(static_cast<std::uint32_t>(columns[k]));
            if (columns[k] <= row) {
                stored.push_back(k);
            }
        }
    }
    const AggregatePattern pattern(linked, 0);
    Matrix whole;
    whole.pattern = &pattern;
    whole.values.resize(stored.size() * Matrix::kEntries);
    for (std::size_t block = 0; block < stored.size(); ++block) {
        whole.set_block(static_cast<std::int64_t>(block),
                        Eigen::Map<const Rows>(values.data() + stored[block] * Matrix::kEntries)
                            .template cast<Scalar>());
    }
    return {workers, whole};
}

template <typename Scalar>
void make_diagonal_definite(SpreadMatrix& matrix) {
    const auto size = static_cast<std::size_t>(matrix.block_size);
    for (std::size_t row = 0; row + 1 < matrix.row_start.size(); ++row) {
        const auto number = matrix.first_row + static_cast<std::int64_t>(row);
        const auto begin = matrix.columns.begin() + matrix.row_start[row];
        const auto end = matrix.columns.begin() + matrix.row_start[row + 1];
        const auto diagonal =
            static_cast<std::size_t>(std::lower_bound(begin, end, number) - matrix.columns.begin());
        Eigen::Map<Eigen::MatrixXd> block(matrix.values.data() + diagonal * size * size,
                                          matrix.block_size, matrix.block_size);
        make_definite<Scalar>(block);
    }
}

// The rigid motions of all aggregates together, in the modes of each: the near kernel.
template <int Dim>
Eigen::MatrixXd rigid_motions(const AggregatePlaces<Dim>& places) {
    constexpr int kSize = kModes<Dim>;
    Eigen::MatrixXd motions = Eigen::MatrixXd::Zero(kSize * places.middles.cols(), kSize);
    for (Eigen::Index a = 0; a < places.middles.cols(); ++a) {
        const double size = places.sizes[static_cast<std::size_t>(a)];
        auto own = motions.middleRows<kSize>(kSize * a);
        int plane = Dim;
        for (int p = 0; p < Dim; ++p) {
            own(p, p) = 1;
            for (int q = p + 1; q < Dim; ++q, ++plane) {
                own(plane, plane) = size > 0 ? size : 1;
                own(q, plane) = places.middles(p, a);
                own(p, plane) = -places.middles(q, a);
            }
        }
    }
    return motions;
}

}  // namespace

template <int Dim, typename Scalar>
SharedCoarseSolver<Dim, Scalar>::SharedCoarseSolver(const Workers& workers,
                                                    const AggregateMatrix<Dim, Scalar>& A,
                                                    const HierarchyLevel& level,
                                                    const AggregatePlaces<Dim>& places,
                                                    const Sharing* sharing)
    : sharing_(sharing) {
    if (sharing == nullptr) {
        whole_ = CoarseSolver<Dim, Scalar>(workers, A);
        return;
    }
    std::vector<std::int64_t> first = {0};
    for (const double count : sharing->list(level.aggregates.count())) {
        sizes_.push_back(kModes<Dim> * static_cast<std::int64_t>(count));
        first.push_back(first.back() + static_cast<std::int64_t>(count));
    }
    const auto rank = static_cast<std::size_t>(sharing->ranks().rank());
    first_ = static_cast<Eigen::Index>(kModes<Dim> * first[rank]);
    SpreadMatrix own = spread(A, level.ghosts, first, rank);
    if (first.back() <= static_cast<std::int64_t>(CoarseSolver<Dim, Scalar>::kMaxDense)) {
        whole_ = factor<Dim, Scalar>(workers, *sharing, own);
        return;
    }
    make_diagonal_definite<Scalar>(own);
    own.near_kernel = rigid_motions<Dim>(places);
    spread_ = sharing->ranks().make_solver(own);
}

template <int Dim, typename Scalar>
void SharedCoarseSolver<Dim, Scalar>::solve(const Workers& workers,
                                            const Vector& r,
                                            Vector& z) const {
    if (sharing_ == nullptr) {
        whole_.solve(workers, r, z);
        return;
    }
    Eigen::VectorXd own = r.template cast<double>();
    if (spread_ != nullptr) {
        z = spread_->solve(own).template cast<Scalar>();
        return;
    }
    const std::vector<double> all =
        sharing_->ranks().gather({own.data(), static_cast<std::size_t>(own.size())}, sizes_);
    Vector solved;
    whole_.solve(
        workers,
        Eigen::Map<const Eigen::VectorXd>(all.data(), static_cast<Eigen::Index>(all.size()))
            .template cast<Scalar>(),
        solved);
    z = solved.segment(first_, r.size());
}

#define PENT_INSTANTIATE(Dim)                      \
    template class SharedCoarseSolver<Dim, float>; \
    template class SharedCoarseSolver<Dim, double>;
PENT_FOR_EACH_DIMENSION(PENT_INSTANTIATE)
#undef PENT_INSTANTIATE

}  // namespace pent::simulator
