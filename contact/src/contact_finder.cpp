#include "pent/contact/contact_finder.h"

#include "barrier_contacts.h"
#include "candidates.h"
#include "contact_energy.h"
#include "crossings.h"
#include "obstacle_contacts.h"
#include "penalty_contacts.h"
#include "step_limit.h"

#include <pent/dimensions.h>
#include <pent/error.h>
#include <pent/stopwatch.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <sstream>

namespace pent::contact {

namespace {

void require(bool is_right, const char* name, const char* field, double value, bool is_positive) {
    if (!is_right) {
        std::ostringstream line;
        line << name << ": " << field << " is " << value << " m, expected a length "
             << (is_positive ? "above 0 m" : "of 0 m or more");
        throw Error(line.str());
    }
}

template <int Dim>
void sum_up(Contacts<Dim>& contacts) {
    ContactReport& report = contacts.report;
    for (const Contact<Dim>& contact : contacts.list) {
        const bool is_obstacle = contact.second.is_obstacle();
        const bool is_point = contact.kind == ContactKind::PointFacet;
        ++(is_obstacle ? report.obstacle : is_point ? report.point_facet : report.mixed);
        report.self += contact.is_self() ? 1 : 0;
        report.mollified += contact.mollifier.is_on() ? 1 : 0;
        report.smallest_distance = std::min(report.smallest_distance, contact.distance);
        if (contact.kind != ContactKind::Mixed) {
            report.deepest = std::max(report.deepest, -contact.distance);
        }
    }
}

}  // namespace

void check(const ContactOptions& options, const char* name) {
    const auto is_length = [](double value) { return std::isfinite(value) && value >= 0; };
    require(is_length(options.distance) && options.distance > 0, name, "distance", options.distance,
            true);
    require(is_length(options.separation), name, "separation", options.separation, false);
    require(is_length(options.margin), name, "margin", options.margin, false);
}

template <int Dim>
class ContactFinder<Dim>::State {
public:
    State(ContactScene<Dim> scene, std::shared_ptr<const Team> team)
        : scene_(std::move(scene)),
          team_(std::move(team)),
          colliders_(scene_),
          candidates_(colliders_, SharedWork(team_.get())),
          obstacle_vertices_(vertices_at_obstacles(colliders_)) {
        std::copy_if(obstacle_vertices_.begin(), obstacle_vertices_.end(),
                     std::back_inserter(pushed_vertices_),
                     [&](std::uint32_t vertex) { return !scene_.is_fixed[vertex]; });
        for (const ContactBody<Dim>& body : scene_.bodies) {
            mean_edges_.push_back(mean_edge_length<Dim>(body.surface, scene_.rest));
        }
    }

    Contacts<Dim> find(const PositionsView<Dim>& positions, double stiffness) {
        return colliders_.with_cores(
            positions, [&](const PositionsView<Dim>& all) { return find_at(all, stiffness); });
    }

    StepLimit limit_step(const PositionsView<Dim>& from, const PositionsView<Dim>& to) {
        if (!colliders_.is_barrier()) {
            return {};
        }
        const Stopwatch watch;
        StepLimit limit = colliders_.with_cores(from, [&](const PositionsView<Dim>& start) {
            return colliders_.with_cores(to, [&](const PositionsView<Dim>& end) {
                return find_step_limit<Dim>(candidates_, obstacle_vertices_, start, end);
            });
        });
        limit.seconds = watch.seconds();
        return limit;
    }

    void move_obstacles(const std::vector<ObstacleShape<Dim>>& shapes) {
        for (std::size_t i = 0; i < shapes.size(); ++i) {
            scene_.obstacles[i].shape = shapes[i];
        }
        colliders_.update_cores();
    }

    StepLimit limit_obstacles(const std::vector<ObstacleShape<Dim>>& from,
                              const PositionsView<Dim>& positions) {
        if (!colliders_.is_barrier()) {
            return {};
        }
        const Stopwatch watch;
        const auto place = [&](const std::vector<ObstacleShape<Dim>>& shapes) {
            move_obstacles(shapes);
            return colliders_.with_cores(
                positions, [](const PositionsView<Dim>& all) { return Positions<Dim>(all); });
        };
        std::vector<ObstacleShape<Dim>> now;
        for (const ContactObstacle<Dim>& obstacle : scene_.obstacles) {
            now.push_back(obstacle.shape);
        }
        const Positions<Dim> start = place(from);
        const Positions<Dim> end = place(now);
        StepLimit limit = find_step_limit<Dim>(candidates_, {}, start, end);
        for (const Contact<Dim>& contact : find_obstacle_contacts<Dim>(
                 colliders_, obstacle_vertices_, positions, candidates_.shared())) {
            if (contact.distance <= scene_.options.separation) {
                limit.fraction = 0;
                limit.limiting = {
                    CrossingKind::Inside, contact.first, contact.second, {contact.vertices[0]}, {},
                    contact.distance};
            }
        }
        limit.seconds = watch.seconds();
        return limit;
    }

    [[nodiscard]] StencilHessians<Dim> hessians(const Contacts<Dim>& contacts,
                                                const PositionsView<Dim>& positions,
                                                double stiffness,
                                                Filter filter,
                                                StencilHessians<Dim> memory) const {
        return colliders_.with_cores(positions, [&](const PositionsView<Dim>& all) {
            return hessians_of<Dim>(scene_, contacts, all, stiffness, filter, std::move(memory));
        });
    }

    [[nodiscard]] std::vector<Crossing> find_crossings(const PositionsView<Dim>& positions,
                                                       std::size_t most) const {
        return colliders_.with_cores(positions, [&](const PositionsView<Dim>& all) {
            return contact::find_crossings<Dim>(colliders_, obstacle_vertices_, all, most);
        });
    }

    [[nodiscard]] std::vector<std::string> warnings() const {
        std::vector<std::string> lines;
        for (std::size_t i = 0; !colliders_.is_barrier() && i < scene_.bodies.size(); ++i) {
            if (scene_.bodies[i].surface.edges.cols() > 0
                && 2 * scene_.options.distance > mean_edges_[i]) {
                std::ostringstream line;
                line << "contact distance " << scene_.options.distance
                     << " m is more than half of the mean surface edge of body '"
                     << scene_.bodies[i].name << "', " << mean_edges_[i]
                     << " m: expect very many contacts; a quarter of the edge is a good choice";
                lines.push_back(line.str());
            }
        }
        return lines;
    }

    [[nodiscard]] const ContactScene<Dim>& scene() const { return scene_; }

    [[nodiscard]] std::int64_t bytes() const {
        std::int64_t sum = candidates_.bytes();
        for (const ContactBody<Dim>& body : scene_.bodies) {
            sum += body.surface.bytes();
        }
        return sum + static_cast<std::int64_t>(sizeof(double)) * colliders_.rest().size()
               + static_cast<std::int64_t>(sizeof(std::uint32_t)
                                           * (obstacle_vertices_.size() + pushed_vertices_.size()));
    }

private:
    Contacts<Dim> find_at(const PositionsView<Dim>& positions, double stiffness) {
        const Stopwatch watch;
        Contacts<Dim> contacts;
        ContactReport& report = contacts.report;
        const SearchWork before = candidates_.work();
        candidates_.cover(positions);
        const SearchWork after = candidates_.work();
        report.trees_built = after.trees_built - before.trees_built;
        report.trees_refit = after.trees_refit - before.trees_refit;
        report.tree_seconds = after.tree_seconds - before.tree_seconds;
        report.search_seconds = watch.seconds() - report.tree_seconds;
        if (colliders_.is_barrier()) {
            BarrierContacts<Dim> found =
                find_barrier_contacts<Dim>(colliders_, candidates_, positions);
            contacts.list = std::move(found.list);
            report.candidates = found.candidates;
        } else {
            contacts.list = find_penalty_contacts<Dim>(colliders_, candidates_, positions);
            report.candidates = candidates_.shared().sum(after.overlaps - before.overlaps);
            candidates_.drop_what_is_not_kept();
        }
        contacts.pair_count = contacts.list.size();
        const std::vector<Contact<Dim>> at_obstacles = find_obstacle_contacts<Dim>(
            colliders_, pushed_vertices_, positions, candidates_.shared());
        contacts.list.insert(contacts.list.end(), at_obstacles.begin(), at_obstacles.end());
        report.obstacle_tests =
            static_cast<std::int64_t>(scene_.obstacles.size() * pushed_vertices_.size());
        contacts = evaluate_all<Dim>(scene_, positions, stiffness, std::move(contacts));
        sum_up(contacts);
        report.seconds = watch.seconds();
        return contacts;
    }

    ContactScene<Dim> scene_;
    std::shared_ptr<const Team> team_;
    Colliders<Dim> colliders_;
    Candidates<Dim> candidates_;
    std::vector<std::uint32_t> obstacle_vertices_;  // that surfaces of obstacles keep out
    std::vector<std::uint32_t> pushed_vertices_;    // of these, the free ones
    std::vector<double> mean_edges_;                // of bodies at rest, m
};

template <int Dim>
ContactFinder<Dim>::ContactFinder(ContactScene<Dim> scene, std::shared_ptr<const Team> team) {
    check(scene.options, "contact");
    for (std::size_t i = 0; i < scene.obstacles.size(); ++i) {
        pent::check<Dim>(scene.obstacles[i].shape, Dim, "obstacle " + std::to_string(i + 1));
    }
    state_ = std::make_unique<State>(std::move(scene), std::move(team));
}

template <int Dim>
ContactFinder<Dim>::~ContactFinder() = default;
template <int Dim>
ContactFinder<Dim>::ContactFinder(ContactFinder&&) noexcept = default;
template <int Dim>
ContactFinder<Dim>& ContactFinder<Dim>::operator=(ContactFinder&&) noexcept = default;

template <int Dim>
Contacts<Dim> ContactFinder<Dim>::find(const PositionsView<Dim>& positions, double stiffness) {
    return state_->find(positions, stiffness);
}

template <int Dim>
StencilHessians<Dim> ContactFinder<Dim>::hessians(const Contacts<Dim>& contacts,
                                                  const PositionsView<Dim>& positions,
                                                  double stiffness,
                                                  Filter filter,
                                                  StencilHessians<Dim> memory) const {
    return state_->hessians(contacts, positions, stiffness, filter, std::move(memory));
}

template <int Dim>
StepLimit ContactFinder<Dim>::limit_step(const PositionsView<Dim>& from,
                                         const PositionsView<Dim>& to) {
    return state_->limit_step(from, to);
}

template <int Dim>
void ContactFinder<Dim>::move_obstacles(const std::vector<ObstacleShape<Dim>>& shapes) {
    state_->move_obstacles(shapes);
}

template <int Dim>
StepLimit ContactFinder<Dim>::limit_obstacles(const std::vector<ObstacleShape<Dim>>& from,
                                              const PositionsView<Dim>& positions) {
    return state_->limit_obstacles(from, positions);
}

template <int Dim>
std::vector<Crossing> ContactFinder<Dim>::find_crossings(const PositionsView<Dim>& positions,
                                                         std::size_t most) const {
    return state_->find_crossings(positions, most);
}

template <int Dim>
std::vector<std::string> ContactFinder<Dim>::warnings() const {
    return state_->warnings();
}

template <int Dim>
const ContactScene<Dim>& ContactFinder<Dim>::scene() const {
    return state_->scene();
}

template <int Dim>
std::int64_t ContactFinder<Dim>::bytes() const {
    return state_->bytes();
}

#define PENT_INSTANTIATE(Dim) template class ContactFinder<Dim>;
PENT_FOR_EACH_DIMENSION(PENT_INSTANTIATE)
#undef PENT_INSTANTIATE

}  // namespace pent::contact
