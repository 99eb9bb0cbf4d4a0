#include "pent/contact/barrier_finder.h"

#include "barrier_setting.h"

#include <pent/error.h>

#include <chrono>
#include <cmath>
#include <sstream>
#include <string_view>

namespace pent::contact {

namespace {

// Candidates hold at least until a vertex has left its path by this part of the distance of contact. More
// makes searches fewer and dearer; at twice as much and at half of it they cost as much in all.
constexpr double kSlack = 0.25;

double seconds_since(std::chrono::steady_clock::time_point start) {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

void require(bool is_right, const char* name, const char* field, double value) {
    if (!is_right) {
        std::ostringstream line;
        line << name << ": " << field << " is " << value << " m, expected a length "
             << (std::string_view(field) == "distance" ? "above 0 m" : "of 0 m or more");
        throw Error(line.str());
    }
}

}  // namespace

void check(const BarrierOptions& options, const char* name) {
    require(std::isfinite(options.distance) && options.distance > 0, name, "distance",
            options.distance);
    require(std::isfinite(options.separation) && options.separation >= 0, name, "separation",
            options.separation);
}

template <int Dim>
class BarrierFinder<Dim>::State {
public:
    State(std::vector<ContactBody<Dim>> bodies,
          std::vector<Obstacle<Dim>> obstacles,
          std::vector<bool> is_held,
          const PositionsView<Dim>& rest,
          const BarrierOptions& options)
        : bodies_(std::move(bodies)),
          obstacles_(std::move(obstacles)),
          options_(options),
          rest_(rest),
          candidates_(bodies_,
                      std::move(is_held),
                      options.self,
                      options.distance + options.separation,
                      kSlack * options.distance) {}

    BarrierContacts<Dim> find(const PositionsView<Dim>& positions) {
        const auto start = std::chrono::steady_clock::now();
        candidates_.cover(positions);
        BarrierContacts<Dim> contacts = find_barrier_contacts<Dim>(setting(), positions);
        contacts.report.seconds = seconds_since(start);
        return contacts;
    }

    StepLimit limit_step(const PositionsView<Dim>& from, const PositionsView<Dim>& to) {
        const auto start = std::chrono::steady_clock::now();
        candidates_.cover(from, to);
        StepLimit limit = limit_barrier_step<Dim>(setting(), from, to);
        limit.seconds = seconds_since(start);
        return limit;
    }

    [[nodiscard]] Stencil<Dim> points_of(const BarrierContact<Dim>& contact,
                                         const PositionsView<Dim>& positions) const {
        Stencil<Dim> points = Stencil<Dim>::Zero();
        for (int i = 0; i < contact.faces.count; ++i) {
            const std::uint32_t vertex = contact.vertices[static_cast<std::size_t>(i)];
            if (vertex == kFixedPoint) {
                points.col(i) = std::get<Ball<Dim>>(obstacles_[-1 - contact.first_body]).center;
            } else {
                points.col(i) = positions.col(vertex);
            }
        }
        return points;
    }

    [[nodiscard]] Barrier barrier(double stiffness, double separation) const {
        return {options_.distance, stiffness, separation};
    }

    [[nodiscard]] const std::vector<ContactBody<Dim>>& bodies() const { return bodies_; }
    [[nodiscard]] const std::vector<Obstacle<Dim>>& obstacles() const { return obstacles_; }
    [[nodiscard]] const BarrierOptions& options() const { return options_; }
    [[nodiscard]] const PathCandidates<Dim>& candidates() const { return candidates_; }

private:
    [[nodiscard]] BarrierSetting<Dim> setting() const {
        return {bodies_, obstacles_, options_, rest_, candidates_};
    }

    std::vector<ContactBody<Dim>> bodies_;
    std::vector<Obstacle<Dim>> obstacles_;
    BarrierOptions options_;
    Positions<Dim> rest_;
    PathCandidates<Dim> candidates_;
};

template <int Dim>
BarrierFinder<Dim>::BarrierFinder(std::vector<ContactBody<Dim>> bodies,
                                  std::vector<Obstacle<Dim>> obstacles,
                                  std::vector<bool> is_held,
                                  const PositionsView<Dim>& rest,
                                  const BarrierOptions& options) {
    check(options, "contact");
    for (const Obstacle<Dim>& obstacle : obstacles) {
        check<Dim>(obstacle, "obstacle");
    }
    state_ = std::make_unique<State>(std::move(bodies), std::move(obstacles), std::move(is_held),
                                     rest, options);
}

template <int Dim>
BarrierFinder<Dim>::~BarrierFinder() = default;
template <int Dim>
BarrierFinder<Dim>::BarrierFinder(BarrierFinder&&) noexcept = default;
template <int Dim>
BarrierFinder<Dim>& BarrierFinder<Dim>::operator=(BarrierFinder&&) noexcept = default;

template <int Dim>
BarrierContacts<Dim> BarrierFinder<Dim>::find(const PositionsView<Dim>& positions) {
    return state_->find(positions);
}

template <int Dim>
StepLimit BarrierFinder<Dim>::limit_step(const PositionsView<Dim>& from,
                                         const PositionsView<Dim>& to) {
    return state_->limit_step(from, to);
}

template <int Dim>
std::vector<Crossing> BarrierFinder<Dim>::find_crossings(
    const PositionsView<Dim>& positions) const {
    return contact::find_crossings<Dim>(bodies(), obstacles(), state_->candidates().is_held(),
                                        positions, options().separation, options().self);
}

template <int Dim>
Stencil<Dim> BarrierFinder<Dim>::points_of(const BarrierContact<Dim>& contact,
                                           const PositionsView<Dim>& positions) const {
    return state_->points_of(contact, positions);
}

template <int Dim>
double BarrierFinder<Dim>::energy(const BarrierContacts<Dim>& contacts,
                                  const PositionsView<Dim>& positions,
                                  double stiffness) const {
    double sum = 0;
    for (const BarrierContact<Dim>& contact : contacts.pairs) {
        sum += pair_barrier_energy<Dim>(
            points_of(contact, positions), contact.faces,
            state_->barrier(contact.multiplicity * stiffness, contact.separation),
            contact.mollifier);
    }
    const Barrier barrier = state_->barrier(stiffness, options().separation);
    for (const VertexContact& contact : contacts.vertices) {
        sum += barrier_energy(contact.distance, barrier);
    }
    return sum;
}

template <int Dim>
void BarrierFinder<Dim>::add_forces(const BarrierContacts<Dim>& contacts,
                                    const PositionsView<Dim>& positions,
                                    double stiffness,
                                    Positions<Dim>& forces) const {
    for (const BarrierContact<Dim>& contact : contacts.pairs) {
        const StencilVector<Dim> gradient = pair_barrier_gradient<Dim>(
            points_of(contact, positions), contact.faces,
            state_->barrier(contact.multiplicity * stiffness, contact.separation),
            contact.mollifier);
        for (int i = 0; i < contact.faces.count; ++i) {
            const std::uint32_t vertex = contact.vertices[static_cast<std::size_t>(i)];
            if (vertex != kFixedPoint) {
                forces.col(vertex) -= gradient.template segment<Dim>(Dim * i);
            }
        }
    }
    const Barrier barrier = state_->barrier(stiffness, options().separation);
    for (const VertexContact& contact : contacts.vertices) {
        forces.col(contact.vertex) -=
            barrier_slope(contact.distance, barrier)
            * signed_distance_gradient<Dim>(obstacles()[static_cast<std::size_t>(contact.obstacle)],
                                            positions.col(contact.vertex));
    }
}

template <int Dim>
StencilMatrix<Dim> BarrierFinder<Dim>::hessian(const BarrierContact<Dim>& contact,
                                               const PositionsView<Dim>& positions,
                                               double stiffness,
                                               Filter filter) const {
    return pair_barrier_hessian<Dim>(
        points_of(contact, positions), contact.faces,
        state_->barrier(contact.multiplicity * stiffness, contact.separation), contact.mollifier,
        filter);
}

template <int Dim>
Eigen::Matrix<double, Dim, Dim> BarrierFinder<Dim>::hessian(const VertexContact& contact,
                                                            const PositionsView<Dim>& positions,
                                                            double stiffness,
                                                            Filter filter) const {
    const Barrier barrier = state_->barrier(stiffness, options().separation);
    return obstacle_response<Dim>(obstacles()[static_cast<std::size_t>(contact.obstacle)],
                                  positions.col(contact.vertex), barrier, filter)
        .hessian;
}

template <int Dim>
const std::vector<ContactBody<Dim>>& BarrierFinder<Dim>::bodies() const {
    return state_->bodies();
}

template <int Dim>
const std::vector<Obstacle<Dim>>& BarrierFinder<Dim>::obstacles() const {
    return state_->obstacles();
}

template <int Dim>
const BarrierOptions& BarrierFinder<Dim>::options() const {
    return state_->options();
}

template class BarrierFinder<3>;
template class BarrierFinder<4>;

}  // namespace pent::contact
