#include "linear/factorization.h"

#include <pent/dimensions.h>

#include <algorithm>
#include <span>
#include <utility>

namespace pent::simulator {

namespace {

using Matrix = Eigen::MatrixXd;

// A stored block at its place in the lower triangle of the permuted matrix.
struct Entry {
    std::uint32_t row;
    std::int64_t block;
    bool is_transposed;
};

// The blocks of one part of the matrix, sorted by permuted column.
template <int Dim, typename Scalar>
class Entries {
public:
    Entries(const BlockMatrix<Dim, Scalar>& A, const Elimination& elimination)
        : A_(&A), order_(elimination.order), start_(elimination.order.size() + 1, 0) {
        const BlockPattern& pattern = A.pattern();
        entries_.resize(pattern.columns.size());
        const auto visit = [&](const auto& act) {
            for (std::size_t row = 0; row < elimination.order.size(); ++row) {
                for (auto k = pattern.row_start[row]; k < pattern.row_start[row + 1]; ++k) {
                    const std::uint32_t r = elimination.place[row];
                    const std::uint32_t c =
                        elimination.place[pattern.columns[static_cast<std::size_t>(k)]];
                    act(std::min(r, c), Entry{std::max(r, c), k, r < c});
                }
            }
        };
        visit([&](std::uint32_t column, const Entry&) { ++start_[column + 1]; });
        for (std::size_t i = 0; i + 1 < start_.size(); ++i) {
            start_[i + 1] += start_[i];
        }
        std::vector<std::size_t> next(start_.begin(), start_.end() - 1);
        visit([&](std::uint32_t column, const Entry& entry) { entries_[next[column]++] = entry; });
    }

    // panel += the columns of a supernode; local has the place of each row in the front.
    void add_to(Matrix& panel,
                const Supernode& node,
                const std::vector<std::uint32_t>& local) const {
        for (std::uint32_t j = 0; j < node.width; ++j) {
            for (std::size_t e = start_[node.begin + j]; e < start_[node.begin + j + 1]; ++e) {
                const Entry& entry = entries_[e];
                const Eigen::Matrix<double, Dim, Dim> block =
                    A_->compensated_block(order_[entry.row], entry.block);
                auto target = panel.block<Dim, Dim>(Dim * local[entry.row], Dim * j);
                if (entry.is_transposed) {
                    target += block.transpose();
                } else {
                    target += block;
                }
            }
        }
    }

private:
    const BlockMatrix<Dim, Scalar>* A_;
    std::span<const std::uint32_t> order_;
    std::vector<std::size_t> start_;
    std::vector<Entry> entries_;
};

// Extend-add: adds the update of a child to the panel and to the update of its parent.
template <int Dim>
void add_update(const Matrix& update,
                const std::vector<std::uint32_t>& rows,
                const std::vector<std::uint32_t>& local,
                std::uint32_t width,
                Matrix& panel,
                Matrix& own) {
    for (std::size_t j = 0; j < rows.size(); ++j) {
        const std::uint32_t column = local[rows[j]];
        for (std::size_t i = j; i < rows.size(); ++i) {
            const std::uint32_t row = local[rows[i]];
            const auto block = update.block<Dim, Dim>(Dim * static_cast<Eigen::Index>(i),
                                                      Dim * static_cast<Eigen::Index>(j));
            if (column < width) {
                panel.block<Dim, Dim>(Dim * row, Dim * column) += block;
            } else {
                own.block<Dim, Dim>(Dim * (row - width), Dim * (column - width)) += block;
            }
        }
    }
}

}  // namespace

template <int Dim>
template <typename Scalar>
std::optional<Factorization<Dim>> Factorization<Dim>::make(const BlockKernels& kernels,
                                                           const BlockMatrix<Dim, Scalar>& A,
                                                           const Elimination& elimination) {
    std::vector<Entries<Dim, Scalar>> parts = {{A, elimination}};
    if (A.coupling() != nullptr) {
        parts.emplace_back(*A.coupling(), elimination);
    }
    const std::vector<Supernode>& nodes = elimination.supernodes;
    std::vector<std::vector<std::size_t>> children(nodes.size());
    std::vector<Matrix> updates(nodes.size());
    std::vector<std::uint32_t> local(elimination.order.size());
    Factorization factors(elimination);
    factors.panels_.reserve(nodes.size());
    for (std::size_t s = 0; s < nodes.size(); ++s) {
        const Supernode& node = nodes[s];
        for (std::uint32_t j = 0; j < node.width; ++j) {
            local[node.begin + j] = j;
        }
        for (std::uint32_t i = 0; i < node.rows.size(); ++i) {
            local[node.rows[i]] = node.width + i;
        }
        const auto width = static_cast<Eigen::Index>(Dim * node.width);
        const auto below = static_cast<Eigen::Index>(Dim * node.rows.size());
        constexpr auto kRoom = static_cast<Eigen::Index>(kFrontRoom);
        Matrix& panel = factors.panels_.emplace_back(Matrix::Zero(width + below + kRoom, width));
        Matrix& update = updates[s];
        update.setZero(below + kRoom, below);
        for (const auto& part : parts) {
            part.add_to(panel, node, local);
        }
        for (const std::size_t child : children[s]) {
            add_update<Dim>(updates[child], nodes[child].rows, local, node.width, panel, update);
            updates[child].resize(0, 0);
        }
        if (!kernels.eliminate_front({panel.data(), static_cast<std::size_t>(panel.rows()),
                                      static_cast<std::size_t>(width),
                                      static_cast<std::size_t>(below), update.data(),
                                      static_cast<std::size_t>(update.rows())})) {
            return std::nullopt;
        }
        if (node.parent >= 0) {
            children[static_cast<std::size_t>(node.parent)].push_back(s);
        }
    }
    return factors;
}

template <int Dim>
auto Factorization<Dim>::rows_below(std::size_t s) const {
    return panels_[s].middleRows(
        panels_[s].cols(),
        Dim * static_cast<Eigen::Index>(elimination_->supernodes[s].rows.size()));
}

template <int Dim>
BlockVector<Dim> Factorization<Dim>::solve(const BlockVector<Dim>& b) const {
    const std::vector<Supernode>& nodes = elimination_->supernodes;
    BlockVector<Dim> x(Dim, b.cols());
    for (std::size_t k = 0; k < elimination_->order.size(); ++k) {
        x.col(static_cast<Eigen::Index>(k)) = b.col(elimination_->order[k]);
    }
    BlockVector<Dim> below;
    for (std::size_t s = 0; s < nodes.size(); ++s) {
        const auto width = panels_[s].cols();
        auto own = x.middleCols(nodes[s].begin, nodes[s].width).reshaped();
        Eigen::VectorXd solved = own;
        panels_[s].topRows(width).template triangularView<Eigen::Lower>().solveInPlace(solved);
        own = solved;
        below.resize(Dim, static_cast<Eigen::Index>(nodes[s].rows.size()));
        below.reshaped() = rows_below(s) * solved;
        for (std::size_t i = 0; i < nodes[s].rows.size(); ++i) {
            x.col(nodes[s].rows[i]) -= below.col(static_cast<Eigen::Index>(i));
        }
    }
    for (std::size_t s = nodes.size(); s-- > 0;) {
        const auto width = panels_[s].cols();
        below.resize(Dim, static_cast<Eigen::Index>(nodes[s].rows.size()));
        for (std::size_t i = 0; i < nodes[s].rows.size(); ++i) {
            below.col(static_cast<Eigen::Index>(i)) = x.col(nodes[s].rows[i]);
        }
        auto own = x.middleCols(nodes[s].begin, nodes[s].width).reshaped();
        Eigen::VectorXd solved = own;
        solved -= rows_below(s).transpose() * below.reshaped();
        panels_[s].topRows(width).template triangularView<Eigen::Lower>().transpose().solveInPlace(
            solved);
        own = solved;
    }
    BlockVector<Dim> result(Dim, b.cols());
    for (std::size_t k = 0; k < elimination_->order.size(); ++k) {
        result.col(elimination_->order[k]) = x.col(static_cast<Eigen::Index>(k));
    }
    return result;
}

#define PENT_INSTANTIATE(Dim, Scalar)                                    \
    template std::optional<Factorization<Dim>> Factorization<Dim>::make( \
        const BlockKernels&, const BlockMatrix<Dim, Scalar>&, const Elimination&);
#define PENT_INSTANTIATE_CLASS(Dim) template class Factorization<Dim>;
PENT_FOR_EACH_DIMENSION(PENT_INSTANTIATE_CLASS)
PENT_FOR_EACH_DIMENSION(PENT_INSTANTIATE, float)
PENT_FOR_EACH_DIMENSION(PENT_INSTANTIATE, double)
#undef PENT_INSTANTIATE
#undef PENT_INSTANTIATE_CLASS

}  // namespace pent::simulator
