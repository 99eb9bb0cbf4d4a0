#include "potentials/attachments.h"

#include "model/nearest_in_body.h"
#include "model/part_selection.h"
#include "model/same_time.h"

#include <pent/dimensions.h>
#include <pent/error.h>
#include <pent/formatted.h>
#include <pent/simulator/placed_mesh.h>

#include <algorithm>
#include <cmath>

namespace pent::simulator {

namespace {

// An offset with larger barycentric coordinates belongs to a cell so flat that the spring would
// pull this many times as hard on its corners.
constexpr double kMaxCoordinate = 100;

bool is_any_damped(const std::vector<Attachment>& attachments) {
    return std::any_of(attachments.begin(), attachments.end(),
                       [](const Attachment& attachment) { return attachment.damping > 0; });
}

}  // namespace

template <int Dim>
Attachments<Dim>::Attachments(const Workers& workers, const Scene& scene, const Bodies<Dim>& bodies)
    : list_(scene.attachments), dt_(scene.dt()) {
    for (const Attachment& attachment : list_) {
        const std::uint32_t body = index_of(scene, attachment.body);
        bundles_.push_back(
            {.attachment = &attachment,
             .body = body,
             .target = attachment.target.empty() ? body : index_of(scene, attachment.target),
             .begin = springs_.size()});
        add_springs(workers, bodies, bundles_.back());
    }
    broken_.assign(springs_.size(), 0);
    static_cast<void>(set_time({}));
}

// Ties each selected vertex of one attachment.
template <int Dim>
void Attachments<Dim>::add_springs(const Workers& workers,
                                   const Bodies<Dim>& bodies,
                                   Bundle& bundle) {
    const Attachment& attachment = *bundle.attachment;
    const std::vector<std::uint32_t> selected =
        select_vertices(bodies, bundle.body, attachment.select, place_and_name(attachment));
    std::vector<std::uint32_t> vertices = selected;
    for (std::uint32_t& vertex : vertices) {
        vertex += static_cast<std::uint32_t>(bodies.first_vertex[bundle.body]);
    }
    springs_.resize(bundle.begin + selected.size());
    std::vector<double> distances(selected.size(), 0);
    MaterialPoints<Dim> nearest;
    if (bundle.target != bundle.body) {
        nearest = nearest_in_body(workers, bodies, bundle.target, vertices);
    }
    for (std::size_t i = 0; i < vertices.size(); ++i) {
        if (nearest.empty()) {
            springs_[bundle.begin + i] = tie_to_space(bodies, attachment, vertices[i]);
        } else {
            springs_[bundle.begin + i] = tie_to_body(bodies, bundle, vertices[i], nearest[i]);
            distances[i] = nearest[i].distance;
        }
    }
    bundle.end = springs_.size();
    const auto farthest = std::max_element(distances.begin(), distances.end());
    if (*farthest > attachment.max_distance) {
        throw Error(
            place_and_name(attachment) + ": vertex "
            + std::to_string(selected[static_cast<std::size_t>(farthest - distances.begin())])
            + " is " + formatted("%.4g m", *farthest) + " from \"" + attachment.target
            + "\"; expected at most " + formatted("max_distance = %.4g m", attachment.max_distance)
            + ": select less, place the bodies nearer to each other, or raise it");
    }
    Vector<Dim> sum = Vector<Dim>::Zero();
    for (std::size_t s = bundle.begin; s < bundle.end; ++s) {
        sum += springs_[s].place;
    }
    bundle.motions =
        center<Dim>(attachment.motion, sum / static_cast<double>(bundle.end - bundle.begin));
}

// The anchor is where the vertex is at rest, which keeps its offset from the attachment's point, if
// there is one; with RestOffset::Zero it is that point. A motion takes either along.
template <int Dim>
typename Attachments<Dim>::Tie Attachments<Dim>::tie_to_space(const Bodies<Dim>& bodies,
                                                              const Attachment& attachment,
                                                              std::uint32_t vertex) {
    Tie spring;
    spring.add(vertex, 1);
    spring.place = bodies.rest().col(vertex);
    if (attachment.point && attachment.offset == RestOffset::Zero) {
        spring.place = *attachment.point;
    }
    return spring;
}

template <int Dim>
typename Attachments<Dim>::Tie Attachments<Dim>::tie_to_body(const Bodies<Dim>& bodies,
                                                             const Bundle& bundle,
                                                             std::uint32_t vertex,
                                                             const MaterialPoint<Dim>& nearest) {
    typename MaterialPoint<Dim>::Weights weights = nearest.weights;
    if (bundle.attachment->offset == RestOffset::Keep && nearest.distance > 0) {
        const Vector<Dim> point = bodies.rest().col(vertex);
        Eigen::Matrix<double, Dim, Dim + 1> corners;
        for (std::size_t i = 0; i <= Dim; ++i) {
            corners.col(static_cast<Eigen::Index>(i)) = bodies.rest().col(nearest.vertices[i]);
        }
        weights = barycentric<Dim>(corners, point);
        const double most = weights.cwiseAbs().maxCoeff();
        if (!(most <= kMaxCoordinate)) {
            throw Error(place_and_name(*bundle.attachment) + ": the cell of \""
                        + bundle.attachment->target + "\" that is nearest to vertex "
                        + std::to_string(vertex - bodies.first_vertex[bundle.body])
                        + " is too flat to carry an offset of "
                        + formatted("%.3g m", nearest.distance)
                        + formatted(" (coordinates up to %.3g; expected at most %.0f)", most,
                                    kMaxCoordinate)
                        + "; use offset = \"zero\", or mend the mesh");
        }
    }
    Tie spring;
    spring.add(vertex, 1);
    for (std::size_t i = 0; i <= Dim; ++i) {
        spring.add(nearest.vertices[i], -weights[static_cast<Eigen::Index>(i)]);
    }
    return spring;
}

// Calls visit(bundle, spring, its place) for each that pulls now.
template <int Dim>
template <typename Visit>
void Attachments<Dim>::for_each_spring(const Visit& visit) const {
    for (const Bundle& bundle : bundles_) {
        for (std::size_t s = bundle.begin; bundle.is_on && s < bundle.end; ++s) {
            if (broken_[s] == 0) {
                visit(bundle, springs_[s], s);
            }
        }
    }
}

template <int Dim>
bool Attachments<Dim>::is_there(const Attachment& attachment, double begin) const {
    return is_by(attachment.from, begin, dt_) && !is_by(attachment.to, begin, dt_);
}

template <int Dim>
bool Attachments<Dim>::set_time(const TimeSpan& step) {
    bool has_changed = rate_ > 0 && is_any_damped(list_);
    rate_ = 0;
    // Attachments come and go between whole steps: where a step was cut in two, by the start of the
    // whole.
    const double whole = dt_ * whole_steps(step.begin, dt_);
    for (Bundle& bundle : bundles_) {
        const bool was_on = bundle.is_on;
        bundle.is_on = is_there(*bundle.attachment, whole);
        bundle.is_driven = bundle.is_on != is_there(*bundle.attachment, std::max(0.0, whole - dt_));
        has_changed = has_changed || bundle.is_on != was_on;
        if (bundle.target != bundle.body) {
            continue;
        }
        const MotionChain<Dim> begin(bundle.motions, step.begin);
        const MotionChain<Dim> end(bundle.motions, step.end);
        for (std::size_t s = bundle.begin; s < bundle.end; ++s) {
            Tie& spring = springs_[s];
            Vector<Dim> from = spring.place;
            Vector<Dim> to = spring.place;
            spring.velocity.setZero();
            begin.move(from, nullptr);
            end.move(to, &spring.velocity);
            has_changed = has_changed || to != spring.anchor;
            bundle.is_driven = bundle.is_driven || (bundle.is_on && from != to);
            spring.anchor = to;
        }
    }
    return has_changed;
}

template <int Dim>
bool Attachments<Dim>::begin_step(const StepStart<Dim>& start) {
    rate_ = start.rate;
    for (Tie& spring : springs_) {
        spring.begin_step(rate_, start.origin);
    }
    return is_any_damped(list_);
}

template <int Dim>
double Attachments<Dim>::evaluate(const Positions<Dim>& x, Positions<Dim>& gradient) {
    energy_ = 0;
    damping_energy_ = 0;
    for_each_spring([&](const Bundle& bundle, const Tie& /*spring*/, std::size_t s) {
        const SpringLaw law{bundle.attachment->stiffness, bundle.attachment->damping};
        const auto energy = springs_[s].evaluate(law, rate_, x, gradient);
        energy_ += energy.elastic;
        damping_energy_ += energy.damping;
    });
    return energy_ + damping_energy_;
}

template <int Dim>
void Attachments<Dim>::add_hessian(const Positions<Dim>& /*x*/,
                                   double weight,
                                   Filter /*filter*/,
                                   NewtonSystem<Dim>& system) {
    for (Bundle& bundle : bundles_) {
        const Attachment& attachment = *bundle.attachment;
        bundle.hessian =
            (attachment.stiffness + rate_ * attachment.damping) * Matrix<Dim>::Identity();
    }
    system.reserve_stencils(springs_.size());
    for_each_spring([&](const Bundle& bundle, const Tie& spring, std::size_t /*s*/) {
        system.add_stencil(spring.stencil(weight, bundle.hessian));
    });
}

template <int Dim>
std::vector<TermEnergy> Attachments<Dim>::energies() const {
    return {{.name = "attachment", .energy = energy_},
            {.name = "attachment damping", .energy = damping_energy_, .is_stored = false}};
}

template <int Dim>
void Attachments<Dim>::add_couplings(Couplings& couplings) const {
    for (const Bundle& bundle : bundles_) {
        const bool is_whole =
            std::any_of(broken_.begin() + static_cast<std::ptrdiff_t>(bundle.begin),
                        broken_.begin() + static_cast<std::ptrdiff_t>(bundle.end),
                        [](std::uint8_t broken) { return broken == 0; });
        if (is_whole && bundle.is_driven) {
            couplings.driven.push_back(bundle.body);
            couplings.driven.push_back(bundle.target);
        }
        if (is_whole && bundle.is_on && bundle.body != bundle.target) {
            couplings.pairs.emplace_back(bundle.body, bundle.target);
        }
    }
}

template <int Dim>
std::vector<AttachmentSummary> Attachments<Dim>::summaries() const {
    std::vector<AttachmentSummary> all(bundles_.size());
    std::vector<Vector<Dim>> forces(bundles_.size(), Vector<Dim>::Zero());
    for_each_spring([&](const Bundle& bundle, const Tie& spring, std::size_t /*s*/) {
        const auto g = static_cast<std::size_t>(&bundle - bundles_.data());
        const Vector<Dim> force = -bundle.attachment->stiffness * spring.stretch;
        forces[g] += force;
        ++all[g].springs;
        all[g].largest_force = std::max(all[g].largest_force, force.norm());
    });
    for (std::size_t g = 0; g < all.size(); ++g) {
        all[g].force = forces[g].norm();
        all[g].broken = std::count(broken_.begin() + static_cast<std::ptrdiff_t>(bundles_[g].begin),
                                   broken_.begin() + static_cast<std::ptrdiff_t>(bundles_[g].end),
                                   std::uint8_t{1});
    }
    return all;
}

template <int Dim>
std::vector<std::size_t> Attachments<Dim>::break_springs() {
    std::vector<std::size_t> bodies;
    for_each_spring([&](const Bundle& bundle, const Tie& spring, std::size_t s) {
        if (bundle.attachment->stiffness * spring.stretch.norm() > bundle.attachment->break_force) {
            broken_[s] = 1;
            bodies.push_back(bundle.body);
            bodies.push_back(bundle.target);
        }
    });
    return bodies;
}

#define PENT_INSTANTIATE(Dim) template class Attachments<Dim>;
PENT_FOR_EACH_DIMENSION(PENT_INSTANTIATE)
#undef PENT_INSTANTIATE

}  // namespace pent::simulator
