#include "sleepers.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace pent::simulator {

namespace {

using BodyPair = std::pair<std::size_t, std::size_t>;

// Pairs of different bodies in contact, each once.
template <int Dim>
std::vector<BodyPair> touching(const ContactState<Dim>* contacts) {
    std::vector<BodyPair> pairs;
    if (contacts != nullptr) {
        for (const contact::Contact<Dim>& contact : contacts->pairs) {
            if (contact.first_body != contact.second_body) {
                pairs.emplace_back(std::minmax(contact.first_body, contact.second_body));
            }
        }
    }
    std::sort(pairs.begin(), pairs.end());
    pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
    return pairs;
}

// Marks what touches something marked that may pass it on, until nothing is new.
template <typename CanTake>
void spread(const std::vector<BodyPair>& pairs, const CanTake& can_take, std::vector<bool>& marks) {
    for (bool has_changed = true; has_changed;) {
        has_changed = false;
        for (const auto& [a, b] : pairs) {
            for (const auto& [from, to] : {BodyPair(a, b), BodyPair(b, a)}) {
                if (marks[from] && !marks[to] && can_take(to)) {
                    marks[to] = true;
                    has_changed = true;
                }
            }
        }
    }
}

}  // namespace

template <int Dim>
Sleepers<Dim>::Sleepers(const Scene& scene, const World<Dim>& world)
    : world_(&world), is_on_(scene.sleep.has_value()), rest_(world.meshes.size()) {
    if (!is_on_) {
        return;
    }
    // A time of so many steps is not to become one more by rounding.
    steps_to_sleep_ =
        static_cast<std::uint64_t>(std::max(1.0, std::ceil(scene.sleep->time / scene.dt() - 1e-6)));
    for (std::size_t body = 0; body < rest_.size(); ++body) {
        const auto& positions = world.meshes[body].positions;
        const double size =
            (positions.rowwise().maxCoeff() - positions.rowwise().minCoeff()).norm();
        speed_.push_back(scene.sleep->speed * size);
        is_kinematic_.push_back(std::all_of(world.is_held.begin() + world.first_vertex[body],
                                            world.is_held.begin() + world.first_vertex[body + 1],
                                            [](bool is_held) { return is_held; }));
    }
}

template <int Dim>
int Sleepers<Dim>::count() const {
    return static_cast<int>(std::count_if(rest_.begin(), rest_.end(),
                                          [](const BodyRest& rest) { return rest.is_asleep; }));
}

template <int Dim>
std::vector<bool> Sleepers<Dim>::asleep() const {
    std::vector<bool> asleep;
    for (const BodyRest& rest : rest_) {
        asleep.push_back(rest.is_asleep);
    }
    return asleep;
}

template <int Dim>
bool Sleepers<Dim>::wake(const ContactState<Dim>* contacts,
                         const Positions<Dim>& from,
                         const Positions<Dim>& to) {
    if (count() == 0) {
        return false;
    }
    std::vector<bool> is_moving(rest_.size());
    for (std::size_t body = 0; body < rest_.size(); ++body) {
        is_moving[body] = !rest_[body].is_asleep && !is_kinematic_[body];
        for (Eigen::Index v = world_->first_vertex[body]; v < world_->first_vertex[body + 1]; ++v) {
            if (world_->is_held[static_cast<std::size_t>(v)] && from.col(v) != to.col(v)) {
                is_moving[body] = true;
            }
        }
    }
    spread(
        touching(contacts), [&](std::size_t body) { return rest_[body].is_asleep; }, is_moving);
    bool has_woken = false;
    for (std::size_t body = 0; body < rest_.size(); ++body) {
        if (rest_[body].is_asleep && is_moving[body]) {
            rest_[body] = {};
            has_woken = true;
        }
    }
    return has_woken;
}

// Held vertices have to be still: what they are about to do would wake the body at once.
template <int Dim>
bool Sleepers<Dim>::is_quiet(std::size_t body, const Positions<Dim>& velocities) const {
    for (Eigen::Index v = world_->first_vertex[body]; v < world_->first_vertex[body + 1]; ++v) {
        const double most = world_->is_held[static_cast<std::size_t>(v)] ? 0 : speed_[body];
        if (velocities.col(v).norm() > most) {
            return false;
        }
    }
    return true;
}

template <int Dim>
bool Sleepers<Dim>::settle(const ContactState<Dim>* contacts, const Positions<Dim>& velocities) {
    if (!is_on_) {
        return false;
    }
    std::vector<bool> is_moving(rest_.size());  // or has been until lately
    bool can_sleep = false;
    for (std::size_t body = 0; body < rest_.size(); ++body) {
        BodyRest& rest = rest_[body];
        if (rest.is_asleep) {
            continue;
        }
        rest.quiet_steps = is_quiet(body, velocities) ? rest.quiet_steps + 1 : 0;
        is_moving[body] = rest.quiet_steps < (is_kinematic_[body] ? 1 : steps_to_sleep_);
        can_sleep = can_sleep || !(is_moving[body] || is_kinematic_[body]);
    }
    if (!can_sleep) {
        return false;
    }
    // What is held everywhere passes nothing on: it moves as told.
    spread(
        touching(contacts), [&](std::size_t body) { return !is_kinematic_[body]; }, is_moving);
    bool has_slept = false;
    for (std::size_t body = 0; body < rest_.size(); ++body) {
        if (!rest_[body].is_asleep && !is_moving[body] && !is_kinematic_[body]) {
            rest_[body].is_asleep = true;
            has_slept = true;
        }
    }
    return has_slept;
}

template class Sleepers<3>;
template class Sleepers<4>;

}  // namespace pent::simulator
