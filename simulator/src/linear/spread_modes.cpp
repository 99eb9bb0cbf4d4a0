#include "linear/spread_modes.h"

#include "linear/aggregate_matrix.h"
#include "linear/aggregates.h"
#include "linear/gathered_solver.h"
#include "linear/rigid_modes.h"

#include <pent/dimensions.h>

#include <Eigen/Eigenvalues>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numeric>
#include <utility>

namespace pent::simulator {

namespace {

// Of the levels of a hierarchy, that whose aggregates are the coarse space: aggregates of several
// dozen dofs are few enough for a matrix of another library, and as good as smaller ones.
constexpr std::size_t kLevel = 1;

// Combinations of motions that are shorter than the longest by this, squared, are rounding.
constexpr double kDependent = 1e-10;

// Rows and columns that have rows alone.
BlockPattern own_part(const BlockPattern& pattern) {
    BlockPattern own;
    own.row_start.push_back(0);
    for (std::size_t row = 0; row + 1 < pattern.row_start.size(); ++row) {
        for (std::int64_t k = pattern.row_start[row]; k < pattern.row_start[row + 1]; ++k) {
            const std::uint32_t column = pattern.columns[static_cast<std::size_t>(k)];
            if (column < pattern.rows()) {
                own.columns.push_back(column);
            }
        }
        own.row_start.push_back(static_cast<std::int64_t>(own.columns.size()));
    }
    return own;
}

// What the aggregates of a level have for dofs.
Aggregates flatten(const std::vector<Aggregates>& levels, std::size_t level) {
    Aggregates flat = levels.front();
    for (std::size_t l = 1; l <= level; ++l) {
        for (std::uint32_t& aggregate : flat.of_child) {
            aggregate = levels[l].of_child[aggregate];
        }
    }
    flat.members.assign(levels[level].members.size(), {});
    for (std::uint32_t dof = 0; dof < flat.of_child.size(); ++dof) {
        flat.members[flat.of_child[dof]].push_back(dof);
    }
    return flat;
}

// Where an aggregate is: the middle of its vertices, and their root mean square distance from it.
template <int Dim>
struct Place {
    Eigen::Matrix<double, Dim, 1> middle = Eigen::Matrix<double, Dim, 1>::Zero();
    double size = 1;  // m; 1 for a single vertex
};

template <int Dim>
std::vector<Place<Dim>> places_of(const Aggregates& aggregates, const BlockVector<Dim>& positions) {
    std::vector<Place<Dim>> places(aggregates.members.size());
    for (std::size_t a = 0; a < places.size(); ++a) {
        const auto count = static_cast<double>(aggregates.members[a].size());
        for (const std::uint32_t dof : aggregates.members[a]) {
            places[a].middle += positions.col(dof) / count;
        }
        double spread = 0;
        for (const std::uint32_t dof : aggregates.members[a]) {
            spread += (positions.col(dof) - places[a].middle).squaredNorm() / count;
        }
        places[a].size = spread > 0 ? std::sqrt(spread) : 1;
    }
    return places;
}

// Aggregates of this rank, and behind them those of others that have ghosts.
template <int Dim>
struct Neighborhood {
    Aggregates aggregates;  // of all dofs; those of others have no members
    std::vector<Arm<Dim>> arms;
    std::vector<std::int64_t> numbers;  // of the aggregates, counted over all ranks
};

template <int Dim>
Neighborhood<Dim> look_around(const Aggregates& own,
                              std::int64_t first,
                              const std::vector<Place<Dim>>& places,
                              const BlockVector<Dim>& positions,
                              const std::vector<std::uint32_t>& ghosts,
                              GhostExchange& exchange) {
    const auto dofs = static_cast<std::size_t>(positions.cols());
    Neighborhood<Dim> all{own, std::vector<Arm<Dim>>(dofs), {}};
    // Number of the aggregate, then the arm.
    Eigen::Matrix<double, Dim + 1, Eigen::Dynamic> told(Dim + 1, positions.cols());
    for (std::uint32_t dof = 0; dof < own.of_child.size(); ++dof) {
        const Place<Dim>& place = places[own.of_child[dof]];
        all.arms[dof].x = (positions.col(dof) - place.middle) / place.size;
        told(0, dof) = static_cast<double>(first + own.of_child[dof]);
        told.template bottomRows<Dim>().col(dof) = all.arms[dof].x;
    }
    exchange.update(told.data(), Dim + 1);
    for (std::size_t a = 0; a < own.members.size(); ++a) {
        all.numbers.push_back(first + static_cast<std::int64_t>(a));
    }
    const auto own_count = static_cast<std::ptrdiff_t>(all.numbers.size());
    for (const std::uint32_t ghost : ghosts) {
        all.numbers.push_back(static_cast<std::int64_t>(told(0, ghost)));
    }
    std::sort(all.numbers.begin() + own_count, all.numbers.end());
    all.numbers.erase(std::unique(all.numbers.begin() + own_count, all.numbers.end()),
                      all.numbers.end());
    all.aggregates.members.resize(all.numbers.size());
    all.aggregates.of_child.resize(dofs, 0);
    for (const std::uint32_t ghost : ghosts) {
        const auto at = std::lower_bound(all.numbers.begin() + own_count, all.numbers.end(),
                                         static_cast<std::int64_t>(told(0, ghost)));
        all.aggregates.of_child[ghost] = static_cast<std::uint32_t>(at - all.numbers.begin());
        all.arms[ghost].x = told.template bottomRows<Dim>().col(ghost);
    }
    return all;
}

// Modes that an aggregate does not have (rotations of a single vertex), or that say the same twice
// (of vertices on a line), are made definite at the size of rounding.
template <typename Scalar>
double definite(double diagonal) {
    constexpr double kShift = sizeof(Scalar) == sizeof(float) ? 2e-6 : 1e-10;
    return diagonal > 0 ? (1 + kShift) * diagonal : 1;
}

// The rows of this rank.
template <int Dim, typename Scalar>
SpreadMatrix spread(const AggregateMatrix<Dim, Scalar>& A,
                    const std::vector<std::int64_t>& numbers,
                    std::size_t rows,
                    std::int64_t first) {
    constexpr int kSize = kModes<Dim>;
    SpreadMatrix spread;
    spread.block_size = kSize;
    spread.first_row = first;
    spread.row_start.push_back(0);
    std::vector<std::pair<std::int64_t, std::int64_t>> of_row;  // number and block
    for (std::size_t row = 0; row < rows; ++row) {
        of_row.clear();
        for (std::int64_t k = A.pattern->row_start[row]; k < A.pattern->row_start[row + 1]; ++k) {
            of_row.emplace_back(numbers[A.pattern->columns[static_cast<std::size_t>(k)]], k);
        }
        std::sort(of_row.begin(), of_row.end());
        for (const auto& [number, k] : of_row) {
            Eigen::Matrix<double, kSize, kSize, Eigen::RowMajor> block =
                A.block(k).template cast<double>();
            for (int i = 0; number == numbers[row] && i < kSize; ++i) {
                block(i, i) = definite<Scalar>(block(i, i));
            }
            spread.columns.push_back(number);
            spread.values.insert(spread.values.end(), block.data(), block.data() + block.size());
        }
        spread.row_start.push_back(static_cast<std::int64_t>(spread.columns.size()));
    }
    return spread;
}

// Rigid motions of everything, in terms of the modes of aggregates, orthonormal over all ranks.
template <int Dim>
Eigen::MatrixXd rigid_motions(const std::vector<Place<Dim>>& places, const Sharing& sharing) {
    constexpr int kSize = kModes<Dim>;
    Eigen::MatrixXd motions =
        Eigen::MatrixXd::Zero(kSize * static_cast<Eigen::Index>(places.size()), kSize);
    for (std::size_t a = 0; a < places.size(); ++a) {
        auto own = motions.middleRows<kSize>(kSize * static_cast<Eigen::Index>(a));
        int plane = Dim;
        for (int p = 0; p < Dim; ++p) {
            own(p, p) = 1;
            for (int q = p + 1; q < Dim; ++q, ++plane) {
                own(plane, plane) = places[a].size;
                own(q, plane) = places[a].middle[p];
                own(p, plane) = -places[a].middle[q];
            }
        }
    }
    // By the eigenvectors of their products, columns in units of their lengths.
    std::vector<double> sums(kSize * kSize);
    Eigen::Map<Eigen::MatrixXd> products(sums.data(), kSize, kSize);
    products = motions.transpose() * motions;
    sharing.sum(sums);
    const Eigen::VectorXd scales = products.diagonal().cwiseSqrt().cwiseInverse();
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(scales.asDiagonal() * products
                                                               * scales.asDiagonal());
    const Eigen::Index dropped =
        (eigen.eigenvalues().array() < kDependent * eigen.eigenvalues().maxCoeff()).count();
    const Eigen::MatrixXd independent = eigen.eigenvectors().rightCols(kSize - dropped);
    const Eigen::VectorXd lengths = eigen.eigenvalues().tail(kSize - dropped).cwiseSqrt();
    return motions * (scales.asDiagonal() * independent * lengths.cwiseInverse().asDiagonal());
}

template <int Dim>
std::unique_ptr<SpreadSolver> solver_of(SpreadMatrix matrix,
                                        const std::vector<std::int64_t>& rows,
                                        const std::vector<Place<Dim>>& places,
                                        const Sharing& sharing) {
    const auto total = std::accumulate(rows.begin(), rows.end(), std::int64_t{0});
    if (total * matrix.block_size <= GatheredSolver::kMaxRows) {
        return std::make_unique<GatheredSolver>(sharing, matrix, rows);
    }
    matrix.near_kernel = rigid_motions<Dim>(places, sharing);
    return sharing.ranks().make_solver(matrix);
}

template <int Dim>
class WithSpreadModes final : public Preconditioner<Dim> {
public:
    // @param own  Must outlive this.
    WithSpreadModes(const Aggregates& own,
                    std::vector<Arm<Dim>> arms,
                    std::unique_ptr<SpreadSolver> coarse,
                    std::unique_ptr<Preconditioner<Dim>> smoother)
        : own_(&own),
          arms_(std::move(arms)),
          coarse_(std::move(coarse)),
          smoother_(std::move(smoother)) {}

    void apply(const Workers& workers,
               const BlockVector<Dim>& r,
               BlockVector<Dim>& z) const override {
        smoother_->apply(workers, r, z);
        add_correction(workers, r, z);
    }

    bool correct(const Workers& workers,
                 const BlockVector<Dim>& r,
                 BlockVector<Dim>& x) const override {
        add_correction(workers, r, x);
        return true;
    }

private:
    static constexpr int kSize = kModes<Dim>;
    using Modes = RigidModes<Dim, Dim>;

    // x += P C P^T r.
    void add_correction(const Workers& workers,
                        const BlockVector<Dim>& r,
                        BlockVector<Dim>& x) const {
        const auto count = static_cast<Eigen::Index>(own_->members.size());
        Eigen::VectorXd forces(kSize * count);
        workers.for_each(count, [&](Eigen::Index a) {
            typename Modes::Modes sum = Modes::Modes::Zero();
            for (const std::uint32_t dof : own_->members[static_cast<std::size_t>(a)]) {
                sum += Modes::force(r.col(dof), arms_[dof]);
            }
            forces.segment<kSize>(kSize * a) = sum;
        });
        const Eigen::VectorXd motions = coarse_->solve(forces);
        workers.for_each(count, [&](Eigen::Index a) {
            const typename Modes::Modes own = motions.segment<kSize>(kSize * a);
            for (const std::uint32_t dof : own_->members[static_cast<std::size_t>(a)]) {
                x.col(dof) += Modes::motion(own, arms_[dof]);
            }
        });
    }

    const Aggregates* own_;
    std::vector<Arm<Dim>> arms_;
    std::unique_ptr<SpreadSolver> coarse_;
    std::unique_ptr<Preconditioner<Dim>> smoother_;
};

}  // namespace

template <int Dim>
SpreadModes<Dim>::SpreadModes(const BlockPattern& pattern, const DofGeometry<Dim>& geometry)
    : geometry_(&geometry) {
    const BlockVector<Dim> rest = geometry.rest.leftCols(pattern.rows());
    const std::vector<Aggregates> levels =
        make_hierarchy<Dim>(own_part(pattern), geometry.column_start, rest);
    if (!levels.empty()) {
        own_ = flatten(levels, std::min(kLevel, levels.size() - 1));
    }
    const Sharing& sharing = *geometry.owners.sharing;
    for (const double count : sharing.list(static_cast<double>(own_.count()))) {
        counts_.push_back(static_cast<std::int64_t>(count));
    }
    first_ =
        std::accumulate(counts_.begin(), counts_.begin() + sharing.ranks().rank(), std::int64_t{0});
}

template <int Dim>
template <typename Scalar>
std::unique_ptr<Preconditioner<Dim>> SpreadModes<Dim>::precondition(
    const Workers& workers,
    const BlockMatrix<Dim, Scalar>& matrix,
    const BlockVector<Dim>& positions,
    const std::vector<std::uint32_t>& ghosts,
    GhostExchange& exchange,
    std::unique_ptr<Preconditioner<Dim>> smoother) const {
    const std::vector<Place<Dim>> places = places_of<Dim>(own_, positions);
    Neighborhood<Dim> around = look_around<Dim>(own_, first_, places, positions, ghosts, exchange);
    const BlockPattern* coupling =
        matrix.coupling() != nullptr ? &matrix.coupling()->pattern() : nullptr;
    const AggregatePattern pattern =
        make_aggregate_pattern(around.aggregates, matrix.pattern(), coupling);
    SpreadMatrix coarse =
        spread<Dim>(galerkin_product(workers, matrix, around.aggregates, around.arms, pattern),
                    around.numbers, own_.members.size(), first_);
    return std::make_unique<WithSpreadModes<Dim>>(
        own_, std::move(around.arms),
        solver_of<Dim>(std::move(coarse), counts_, places, *geometry_->owners.sharing),
        std::move(smoother));
}

#define PENT_INSTANTIATE(Dim, Scalar)                                                            \
    template std::unique_ptr<Preconditioner<Dim>> SpreadModes<Dim>::precondition(                \
        const Workers&, const BlockMatrix<Dim, Scalar>&, const BlockVector<Dim>&,                \
        const std::vector<std::uint32_t>&, GhostExchange&, std::unique_ptr<Preconditioner<Dim>>) \
        const;
PENT_FOR_EACH_DIMENSION(PENT_INSTANTIATE, float)
PENT_FOR_EACH_DIMENSION(PENT_INSTANTIATE, double)
#undef PENT_INSTANTIATE
#define PENT_INSTANTIATE(Dim) template class SpreadModes<Dim>;
PENT_FOR_EACH_DIMENSION(PENT_INSTANTIATE)
#undef PENT_INSTANTIATE

}  // namespace pent::simulator
