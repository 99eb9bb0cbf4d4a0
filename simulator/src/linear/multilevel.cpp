#include "linear/coarse_solver.h"
#include "linear/gauss_seidel.h"
#include "linear/preconditioner.h"

#include <pent/dimensions.h>

#include <cmath>
#include <utility>

namespace pent::simulator {

namespace {

// What unsmoothed aggregation finds of a smooth error is too small, since its pieces meet in jumps;
// below 2, see cycle().
constexpr double kCorrection = 1.8;

// Middles and sizes of aggregates; a vertex is its own, of no size.
template <int Dim>
struct Middles {
    BlockVector<Dim> places;
    std::vector<double> sizes;   // root mean square distance of the vertices from the middle, m
    std::vector<double> counts;  // of vertices
};

template <int Dim>
Middles<Dim> middles_of(const Aggregates& aggregates, const Middles<Dim>& children) {
    const std::size_t count = aggregates.members.size();
    Middles<Dim> middles{BlockVector<Dim>::Zero(Dim, aggregates.count()),
                         std::vector<double>(count), std::vector<double>(count)};
    for (std::size_t a = 0; a < count; ++a) {
        auto place = middles.places.col(static_cast<Eigen::Index>(a));
        for (const std::uint32_t child : aggregates.members[a]) {
            place += children.counts[child] * children.places.col(child);
            middles.counts[a] += children.counts[child];
        }
        place /= middles.counts[a];
        double spread = 0;
        for (const std::uint32_t child : aggregates.members[a]) {
            spread += children.counts[child]
                      * ((children.places.col(child) - place).squaredNorm()
                         + children.sizes[child] * children.sizes[child]);
        }
        middles.sizes[a] = std::sqrt(spread / middles.counts[a]);
    }
    return middles;
}

template <int Dim>
std::vector<Arm<Dim>> arms_of(const Aggregates& aggregates,
                              const Middles<Dim>& children,
                              const Middles<Dim>& middles) {
    std::vector<Arm<Dim>> arms(aggregates.of_child.size());
    for (std::size_t child = 0; child < arms.size(); ++child) {
        const std::uint32_t a = aggregates.of_child[child];
        const double size = middles.sizes[a] > 0 ? middles.sizes[a] : 1;
        arms[child].x =
            (children.places.col(static_cast<Eigen::Index>(child)) - middles.places.col(a)) / size;
        arms[child].ratio = children.sizes[child] / size;
    }
    return arms;
}

template <int Dim, typename Scalar>
class Multilevel final : public Preconditioner<Dim> {
public:
    Multilevel(const Workers& workers,
               const BlockKernels& kernels,
               const BlockMatrix<Dim, Scalar>& matrix,
               const Hierarchy& hierarchy,
               const BlockVector<Dim>& positions,
               std::unique_ptr<Preconditioner<Dim>> smoother)
        : kernels_(&kernels), smoother_(std::move(smoother)), levels_(hierarchy.levels.size()) {
        if (matrix.coupling() != nullptr) {
            own_patterns_ = hierarchy.patterns_with(matrix.coupling()->pattern());
        }
        const auto& patterns = own_patterns_.empty() ? hierarchy.patterns : own_patterns_;
        const auto vertices = static_cast<std::size_t>(positions.cols());
        Middles<Dim> children{positions, std::vector<double>(vertices, 0.0),
                              std::vector<double>(vertices, 1.0)};
        for (std::size_t l = 0; l < levels_.size(); ++l) {
            Level& level = levels_[l];
            level.aggregates = &hierarchy.levels[l];
            Middles<Dim> middles = middles_of(*level.aggregates, children);
            level.arms = arms_of(*level.aggregates, children, middles);
            level.matrix = l == 0 ? galerkin_product(workers, matrix, *level.aggregates, level.arms,
                                                     patterns[l])
                                  : galerkin_product(workers, levels_[l - 1].matrix,
                                                     *level.aggregates, level.arms, patterns[l]);
            children = std::move(middles);
            if (l + 1 < levels_.size()) {
                level.smoother = GaussSeidel<Dim, Scalar>(workers, level.matrix);
            }
        }
        coarsest_ = CoarseSolver<Dim, Scalar>(workers, levels_.back().matrix);
    }

    // Additive: products with the matrix of the mesh are what an iteration costs most.
    void apply(const Workers& workers,
               const BlockVector<Dim>& r,
               BlockVector<Dim>& z) const override {
        smoother_->apply(workers, r, z);
        Vector coarse;
        Vector correction;
        const double scale = restrict_finest(workers, r, coarse);
        if (levels_.size() == 1) {
            coarsest_.solve(workers, coarse, correction);
        } else {
            cycle(workers, 0, coarse, correction);
        }
        prolong_finest(workers, scale, correction, z);
    }

    // By the coarsest level alone, where what is solved for is solved for exactly.
    bool correct(const Workers& workers,
                 const BlockVector<Dim>& r,
                 BlockVector<Dim>& x) const override {
        std::vector<Vector> coarse(levels_.size());
        const double scale = restrict_finest(workers, r, coarse[0]);
        for (std::size_t l = 1; l < levels_.size(); ++l) {
            restrict_to(workers, levels_[l], coarse[l - 1], coarse[l]);
        }
        Vector correction;
        coarsest_.solve(workers, coarse.back(), correction);
        for (std::size_t l = levels_.size() - 1; l > 0; --l) {
            coarse[l - 1].setZero();
            prolong_from(workers, levels_[l], 1, correction, coarse[l - 1]);
            correction = std::move(coarse[l - 1]);
        }
        prolong_finest(workers, scale, correction, x);
        return true;
    }

private:
    static constexpr int kSize = kModes<Dim>;
    static constexpr int kChunk = 64;  // aggregates of a task
    using Vector = typename AggregateMatrix<Dim, Scalar>::Vector;
    using Finest = RigidModes<Dim, Dim>;
    using Coarse = RigidModes<Dim, kSize>;

    struct Level {
        const Aggregates* aggregates = nullptr;
        std::vector<Arm<Dim>> arms;  // of the children
        AggregateMatrix<Dim, Scalar> matrix;
        GaussSeidel<Dim, Scalar> smoother;  // but for the coarsest
    };

    template <typename Work>
    static void for_each_aggregate(const Workers& workers, const Level& level, const Work& work) {
        const int count = level.aggregates->count();
        workers.for_each((count + kChunk - 1) / kChunk, [&](int chunk) {
            for (int a = chunk * kChunk; a < std::min(count, (chunk + 1) * kChunk); ++a) {
                work(static_cast<std::uint32_t>(a));
            }
        });
    }

    // z near A^-1 r. Sweeps forth and back make no error grow, so that with a correction enlarged
    // by alpha < 2 the spectrum of what this does to A is in (0, alpha], if that of the solver
    // below is in (0, 1]; then two cycles, one on the residual of the other, are in (0, 1] again:
    // all stays symmetric positive definite, and no worse the more levels there are.
    void cycle(const Workers& workers, std::size_t l, const Vector& r, Vector& z) const {
        const Level& level = levels_[l];
        const Level& next = levels_[l + 1];
        Vector left;
        Vector coarse;
        Vector correction;
        level.smoother.sweep_forth(workers, *kernels_, r, z, left);
        restrict_to(workers, next, left, coarse);
        if (l + 2 == levels_.size()) {
            coarsest_.solve(workers, coarse, correction);
        } else {
            cycle(workers, l + 1, coarse, correction);
            next.matrix.multiply(workers, *kernels_, BlockPart::Whole, correction, left);
            left = coarse - left;
            Vector again;
            cycle(workers, l + 1, left, again);
            correction += again;
        }
        prolong_from(workers, next, kCorrection, correction, z);
        level.smoother.sweep_back(workers, *kernels_, r, z);
    }

    // To the aggregates of a level from their children.
    static void restrict_to(const Workers& workers,
                            const Level& level,
                            const Vector& children,
                            Vector& coarse) {
        coarse.resize(kSize * level.aggregates->count());
        for_each_aggregate(workers, level, [&](std::uint32_t a) {
            typename Coarse::Modes sum = Coarse::Modes::Zero();
            for (const std::uint32_t child : level.aggregates->members[a]) {
                sum += Coarse::force(
                    children.template segment<kSize>(kSize * child).template cast<double>(),
                    level.arms[child]);
            }
            coarse.template segment<kSize>(kSize * a) = sum.template cast<Scalar>();
        });
    }

    static void prolong_from(const Workers& workers,
                             const Level& level,
                             double factor,
                             const Vector& coarse,
                             Vector& children) {
        for_each_aggregate(workers, level, [&](std::uint32_t a) {
            const typename Coarse::Modes modes =
                factor * coarse.template segment<kSize>(kSize * a).template cast<double>();
            for (const std::uint32_t child : level.aggregates->members[a]) {
                children.template segment<kSize>(kSize * child) +=
                    Coarse::motion(modes, level.arms[child]).template cast<Scalar>();
            }
        });
    }

    // The same between the vertices and the finest aggregates. Returns what the result is in units
    // of: it has entries of up to 1, so that however small forces are, float has them.
    double restrict_finest(const Workers& workers,
                           const BlockVector<Dim>& r,
                           Vector& coarse) const {
        const Level& level = levels_[0];
        Eigen::VectorXd forces(kSize * level.aggregates->count());
        for_each_aggregate(workers, level, [&](std::uint32_t a) {
            typename Finest::Modes sum = Finest::Modes::Zero();
            for (const std::uint32_t dof : level.aggregates->members[a]) {
                sum += Finest::force(r.col(dof), level.arms[dof]);
            }
            forces.segment<kSize>(kSize * a) = sum;
        });
        const double largest = forces.cwiseAbs().maxCoeff();
        const double scale = largest > 0 ? largest : 1;
        coarse = (forces / scale).template cast<Scalar>();
        return scale;
    }

    void prolong_finest(const Workers& workers,
                        double scale,
                        const Vector& coarse,
                        BlockVector<Dim>& x) const {
        const Level& level = levels_[0];
        for_each_aggregate(workers, level, [&](std::uint32_t a) {
            const typename Finest::Modes modes =
                scale * coarse.template segment<kSize>(kSize * a).template cast<double>();
            for (const std::uint32_t dof : level.aggregates->members[a]) {
                x.col(dof) += Finest::motion(modes, level.arms[dof]);
            }
        });
    }

    const BlockKernels* kernels_;
    std::unique_ptr<Preconditioner<Dim>> smoother_;
    std::vector<AggregatePattern> own_patterns_;  // where there is a coupling
    std::vector<Level> levels_;                   // the finest first
    CoarseSolver<Dim, Scalar> coarsest_;
};

}  // namespace

Hierarchy::Hierarchy(std::vector<Aggregates> aggregates, const BlockPattern& fine)
    : levels(std::move(aggregates)), fine_(&fine) {
    patterns = make_patterns(nullptr);
}

std::vector<AggregatePattern> Hierarchy::make_patterns(const BlockPattern* coupling) const {
    std::vector<AggregatePattern> made;
    for (const Aggregates& level : levels) {
        made.push_back(made.empty() ? make_aggregate_pattern(level, *fine_, coupling)
                                    : make_aggregate_pattern(level, made.back()));
    }
    return made;
}

template <int Dim, typename Scalar>
std::unique_ptr<Preconditioner<Dim>> multilevel(const Workers& workers,
                                                const BlockKernels& kernels,
                                                const BlockMatrix<Dim, Scalar>& matrix,
                                                const Hierarchy& hierarchy,
                                                const BlockVector<Dim>& positions,
                                                std::unique_ptr<Preconditioner<Dim>> smoother) {
    return std::make_unique<Multilevel<Dim, Scalar>>(workers, kernels, matrix, hierarchy, positions,
                                                     std::move(smoother));
}

#define PENT_INSTANTIATE(Dim, Scalar)                                                           \
    template std::unique_ptr<Preconditioner<Dim>> multilevel(                                   \
        const Workers&, const BlockKernels&, const BlockMatrix<Dim, Scalar>&, const Hierarchy&, \
        const BlockVector<Dim>&, std::unique_ptr<Preconditioner<Dim>>);
PENT_FOR_EACH_DIMENSION(PENT_INSTANTIATE, float)
PENT_FOR_EACH_DIMENSION(PENT_INSTANTIATE, double)
#undef PENT_INSTANTIATE

}  // namespace pent::simulator
