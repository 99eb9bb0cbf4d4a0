// The parts of ContactPotential that only a barrier has: how far a step may go, how stiff it is,
// what crosses.

#include "potentials/contact_potential.h"
#include "potentials/contact_scene.h"

#include <pent/dimensions.h>

#include <algorithm>

namespace pent::simulator {

namespace {

// Parts of the activation distance. With a gap below the first a step starts with the stiffness
// that balances all other forces there; an iteration that ends with one below the second, and less
// than before, doubles the stiffness.
constexpr double kDeep = 0.1;
constexpr double kTight = 0.01;

// With all gaps above this part of the largest coordinate nothing touches, whatever the rounding;
// below it something may.
constexpr double kTouching = 1e-9;

// The stiffness is never more than this times that of the scene.
constexpr double kMaxStiffness = 1e8;

}  // namespace

template <int Dim>
double ContactPotential<Dim>::max_step(const Positions<Dim>& from, const Positions<Dim>& to) {
    if (!is_barrier_) {
        return 1;
    }
    limit_ = workers_->run([&] { return finder_->limit_step(from, to); });
    work_.seconds += limit_.seconds;
    work_.ccd_seconds += limit_.seconds;
    return limit_.fraction;
}

// To balance means to evaluate all contacts once more: not where it would change nothing, as bodies
// are not close and the stiffness is that of the scene already.
template <int Dim>
bool ContactPotential<Dim>::wants_balance() const {
    return is_barrier_ && (is_close() || stiffness_ != settings_.stiffness);
}

template <int Dim>
bool ContactPotential<Dim>::is_close() const {
    return gap() < kDeep * settings_.distance;
}

// Where bodies are close, the stiffness with which the barrier balances all other forces at the
// positions last evaluated, in the sense of least squares [li2020, supplement]; else that of the
// scene.
template <int Dim>
bool ContactPotential<Dim>::balance(const BlockVector<Dim>& own, const BlockVector<Dim>& others) {
    const double before = stiffness_;
    if (own.cols() == 0) {
        return false;  // all bodies sleep, and nothing is solved for
    }
    if (is_close()) {
        const double squared = own.squaredNorm();
        const double along = -others.cwiseProduct(own).sum();
        const double balancing = squared > 0 ? stiffness_ * along / squared : 0;
        stiffness_ =
            std::clamp(balancing, settings_.stiffness, kMaxStiffness * settings_.stiffness);
    } else {
        stiffness_ = settings_.stiffness;
    }
    return stiffness_ != before;
}

template <int Dim>
bool ContactPotential<Dim>::adapt() {
    if (!is_barrier_) {
        return false;
    }
    const bool is_tight = gap() < std::min(last_gap_, kTight * settings_.distance)
                          && stiffness_ < kMaxStiffness * settings_.stiffness;
    last_gap_ = gap();
    if (is_tight) {
        stiffness_ = std::min(2 * stiffness_, kMaxStiffness * settings_.stiffness);
    }
    return is_tight;
}

template <int Dim>
std::vector<contact::Crossing> ContactPotential<Dim>::find_crossings(
    const Positions<Dim>& positions) const {
    return workers_->run([&] {
        return is_barrier_ ? finder_->find_crossings(positions) : std::vector<contact::Crossing>();
    });
}

template <int Dim>
std::vector<contact::Crossing> ContactPotential<Dim>::find_crossings(const Scene& scene,
                                                                     const Bodies<Dim>& bodies,
                                                                     const HeldVertices<Dim>& held,
                                                                     const Positions<Dim>& x,
                                                                     double time) const {
    if (!is_barrier_) {
        return {};
    }
    const contact::ContactScene<Dim>& now = finder_->scene();
    const std::vector<pent::ObstacleShape<Dim>> obstacles = motions_.at(time);
    return workers_->run([&] {
        if (held.now() == now.is_fixed && held.always() == now.is_always_fixed) {
            finder_->move_obstacles(obstacles);
            std::vector<contact::Crossing> crossings = finder_->find_crossings(x);
            finder_->move_obstacles(obstacles_);
            return crossings;
        }
        contact::ContactFinder<Dim> finder(
            contact_scene<Dim>(scene, bodies, held, do_bodies_meet_));
        finder.move_obstacles(obstacles);
        return finder.find_crossings(x);
    });
}

// A search for crossings is slow. It is made only where contacts report a gap that small, or where
// they would not: held vertices and obstacles do not push each other, but one that is let go later
// must not end in an obstacle.
template <int Dim>
std::string ContactPotential<Dim>::touching(const Positions<Dim>& from,
                                            const Positions<Dim>& to) const {
    if (!is_barrier_) {
        return "";
    }
    const contact::ContactScene<Dim>& scene = finder_->scene();
    bool may_touch = gap() < kTouching * to.cwiseAbs().maxCoeff();
    for (std::size_t v = 0; has_obstacles_ && !may_touch && v < scene.is_fixed.size(); ++v) {
        const auto column = static_cast<Eigen::Index>(v);
        may_touch = scene.is_fixed[v] && !scene.is_always_fixed[v]
                    && (has_moving_obstacles() || from.col(column) != to.col(column));
    }
    const std::vector<contact::Crossing> crossings =
        may_touch ? find_crossings(to) : std::vector<contact::Crossing>();
    return crossings.empty() ? "" : describe(crossings.front());
}

template <int Dim>
std::string ContactPotential<Dim>::describe(const contact::Crossing& crossing) const {
    return contact::describe<Dim>(crossing, finder_->scene());
}

#define PENT_INSTANTIATE(Dim)                                                                      \
    template double ContactPotential<Dim>::max_step(const Positions<Dim>&, const Positions<Dim>&); \
    template bool ContactPotential<Dim>::wants_balance() const;                                    \
    template bool ContactPotential<Dim>::balance(const BlockVector<Dim>&,                          \
                                                 const BlockVector<Dim>&);                         \
    template bool ContactPotential<Dim>::adapt();                                                  \
    template std::vector<contact::Crossing> ContactPotential<Dim>::find_crossings(                 \
        const Positions<Dim>&) const;                                                              \
    template std::vector<contact::Crossing> ContactPotential<Dim>::find_crossings(                 \
        const Scene&, const Bodies<Dim>&, const HeldVertices<Dim>&, const Positions<Dim>&, double) \
        const;                                                                                     \
    template std::string ContactPotential<Dim>::touching(const Positions<Dim>&,                    \
                                                         const Positions<Dim>&) const;             \
    template std::string ContactPotential<Dim>::describe(const contact::Crossing&) const;
PENT_FOR_EACH_DIMENSION(PENT_INSTANTIATE)
#undef PENT_INSTANTIATE

}  // namespace pent::simulator
