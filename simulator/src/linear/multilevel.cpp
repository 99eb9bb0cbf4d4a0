#include "linear/aggregate_places.h"
#include "linear/gauss_seidel.h"
#include "linear/preconditioner.h"
#include "linear/shared_coarse_solver.h"

#include <pent/dimensions.h>

#include <algorithm>
#include <utility>

namespace pent::simulator {

namespace {

// Over-correction [braess1995]: a smooth error, approximated by rigid pieces that meet in jumps,
// seems stiffer than it is, so that coarse corrections come out too small. Below 2, see cycle().
constexpr double kCorrection = 1.8;

template <int Dim, typename Scalar>
class Multilevel final : public Preconditioner<Dim> {
public:
    Multilevel(const Workers& workers,
               const BlockKernels& kernels,
               const BlockMatrix<Dim, Scalar>& matrix,
               const Hierarchy& hierarchy,
               const BlockVector<Dim>& positions,
               std::unique_ptr<Preconditioner<Dim>> smoother)
        : kernels_(&kernels),
          halo_(hierarchy.halo),
          smoother_(std::move(smoother)),
          levels_(hierarchy.levels.size()) {
        AggregatePlaces<Dim> places;             // of the next finer level
        GhostExchange* exchange = halo_.ghosts;  // of the children
        for (std::size_t l = 0; l < levels_.size(); ++l) {
            const HierarchyLevel& made = hierarchy.levels[l];
            Level& level = levels_[l];
            level.aggregates = &made.aggregates;
            const ChildPlaces<Dim> children =
                l == 0 ? ChildPlaces<Dim>(positions) : ChildPlaces<Dim>(places);
            AggregatePlaces<Dim> own = places_of(workers, made.aggregates, children);
            const Arms<Dim> arms = arms_of(workers, made.aggregates, children, own, exchange);
            level.matrix = l == 0 ? galerkin_product(workers, kernels, matrix, made.aggregates,
                                                     arms, made.pattern)
                                  : galerkin_product(workers, kernels, levels_[l - 1].matrix,
                                                     made.aggregates, arms, made.pattern);
            level.arms.resize(made.aggregates.children());
            made.aggregates.for_each(workers, [&](std::uint32_t a) {
                std::size_t place = made.aggregates.first_of(a);
                for (const std::uint32_t child : made.aggregates.members(a)) {
                    level.arms[place++] = arms[child];
                }
            });
            exchange = made.exchange.get();
            level.matrix.ghosts = exchange;
            places = std::move(own);
            if (l + 1 < levels_.size()) {
                level.smoother = GaussSeidel<Dim, Scalar>(workers, level.matrix);
                level.matrix.fit(shares_);
            }
        }
        coarsest_ = SharedCoarseSolver<Dim, Scalar>(workers, levels_.back().matrix,
                                                    hierarchy.levels.back(), places, halo_.sharing);
    }

    // On the mesh smoother and coarse correction are added, not applied one after the other, which
    // would take further products with the largest matrix: they are what an iteration costs most.
    double apply(const Workers& workers,
                 const BlockVector<Dim>& r,
                 BlockVector<Dim>& z) const override {
        const double smoothed = smoother_->apply(workers, r, z);
        Vector coarse;
        Vector correction;
        const double scale = restrict_finest(workers, r, coarse);
        if (levels_.size() == 1) {
            coarsest_.solve(workers, coarse, correction);
        } else {
            cycle(workers, 0, coarse, correction);
        }
        prolong_finest(workers, scale, correction, z);
        return smoothed
               + scale * scale
                     * coarse.template cast<double>().dot(
                         correction.head(coarse.size()).template cast<double>());
    }

    // By the coarsest level alone, whose exact solution cannot make the error larger in the norm
    // of A.
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
    using Vector = typename AggregateMatrix<Dim, Scalar>::Vector;
    using Coarse = RigidModes<Dim, kSize>;

    struct Level {
        const Aggregates* aggregates = nullptr;
        Arms<Dim> arms;  // in the order of the members, see Aggregates::first_of()
        AggregateMatrix<Dim, Scalar> matrix;
        GaussSeidel<Dim, Scalar> smoother;  // not on the coarsest level
    };

    // Calls work(aggregate, members, arms) with the arms of the members.
    template <typename Work>
    static void for_each_aggregate(const Workers& workers, const Level& level, const Work& work) {
        level.aggregates->for_each(workers, [&](std::uint32_t a) {
            work(a, level.aggregates->members(a),
                 level.arms.data() + level.aggregates->first_of(a));
        });
    }

    // z = B r with B near A^-1 by a W-cycle: a forward sweep, a coarse correction, enlarged by
    // alpha = kCorrection, and a backward sweep. The correction comes from two cycles on the next
    // coarser level, the second on the residual of the first.
    //
    // Why B is symmetric positive definite for any number of levels: sweeps make no error grow, so
    // if the spectrum of (coarse solver x coarse matrix) is in (0, 1], that of B A is in
    // (0, alpha], alpha < 2. Two such cycles leave the error (I - B A)^2, so that the spectrum of
    // what the next finer level gets, 1 - (1 - x)^2, is in (0, 1] again.
    void cycle(const Workers& workers, std::size_t l, const Vector& r, Vector& z) const {
        const Level& level = levels_[l];
        const Level& next = levels_[l + 1];
        Vector left;
        Vector coarse;
        Vector correction;
        level.smoother.sweep_forth(workers, *kernels_, r, z, left, shares_);
        restrict_to(workers, next, left, coarse);
        if (l + 2 == levels_.size()) {
            coarsest_.solve(workers, coarse, correction);
        } else {
            cycle(workers, l + 1, coarse, correction);
            next.matrix.update_ghosts(correction);
            next.matrix.subtract_product(workers, *kernels_, coarse, correction, left, shares_);
            Vector again;
            cycle(workers, l + 1, left, again);
            correction += again;
        }
        prolong_from(workers, next, kCorrection, correction, z);
        level.smoother.sweep_back(workers, *kernels_, r, z, shares_);
    }

    // Restriction to the aggregates of a level from their children.
    static void restrict_to(const Workers& workers,
                            const Level& level,
                            const Vector& children,
                            Vector& coarse) {
        coarse.resize(kSize * level.aggregates->count());
        for_each_aggregate(workers, level, [&](std::uint32_t a, const auto members, auto arm) {
            typename Coarse::Modes sum = Coarse::Modes::Zero();
            for (const std::uint32_t child : members) {
                sum += Coarse::force(
                    children.template segment<kSize>(kSize * child).template cast<double>(),
                    *arm++);
            }
            coarse.template segment<kSize>(kSize * a) = sum.template cast<Scalar>();
        });
    }

    // Prolongation: adds the motions of aggregates, times a factor, to their children.
    static void prolong_from(const Workers& workers,
                             const Level& level,
                             double factor,
                             const Vector& coarse,
                             Vector& children) {
        for_each_aggregate(workers, level, [&](std::uint32_t a, const auto members, auto arm) {
            const typename Coarse::Modes modes =
                factor * coarse.template segment<kSize>(kSize * a).template cast<double>();
            for (const std::uint32_t child : members) {
                children.template segment<kSize>(kSize * child) +=
                    Coarse::motion(modes, *arm++).template cast<Scalar>();
            }
        });
    }

    // Restriction from the vertices to the finest aggregates. The result is divided by its largest
    // entry, which is returned: however small forces are, they do not underflow in float.
    double restrict_finest(const Workers& workers,
                           const BlockVector<Dim>& r,
                           Vector& coarse) const {
        const Level& level = levels_[0];
        Eigen::VectorXd forces(kSize * level.aggregates->count());
        for_each_aggregate(workers, level, [&](std::uint32_t a, const auto members, auto arms) {
            kernels_->sum_forces(children_of<Dim>(members, arms), r.data(),
                                 forces.data() + kSize * std::size_t{a});
        });
        const double largest = halo_.max(forces.size() > 0 ? forces.cwiseAbs().maxCoeff() : 0);
        const double scale = largest > 0 ? largest : 1;
        coarse = (forces / scale).template cast<Scalar>();
        return scale;
    }

    void prolong_finest(const Workers& workers,
                        double scale,
                        const Vector& coarse,
                        BlockVector<Dim>& x) const {
        const Level& level = levels_[0];
        for_each_aggregate(workers, level, [&](std::uint32_t a, const auto members, auto arms) {
            const typename Coarse::Modes modes =
                scale * coarse.template segment<kSize>(kSize * a).template cast<double>();
            kernels_->add_motions(children_of<Dim>(members, arms), modes.data(), x.data());
        });
    }

    const BlockKernels* kernels_;
    Halo halo_;
    std::unique_ptr<Preconditioner<Dim>> smoother_;
    std::vector<Level> levels_;  // the finest first
    SharedCoarseSolver<Dim, Scalar> coarsest_;
    mutable typename AggregateMatrix<Dim, Scalar>::Shares shares_;  // scratch of all levels
};

}  // namespace

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
