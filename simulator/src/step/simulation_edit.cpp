// Bodies and obstacles that come and go. With other bodies a Stepper of the changed scene takes the
// place of the old one, in the same state.

#include "model/part_bodies.h"
#include "step/host_checks.h"
#include "step/stepper.h"

#include <pent/dimensions.h>
#include <pent/error.h>
#include <pent/simulator/placed_mesh.h>

#include <algorithm>
#include <string>
#include <utility>

namespace pent::simulator {

namespace {

// The same scene for meshes that have been placed already.
Scene placed(Scene scene) {
    for (Body& body : scene.bodies) {
        body.place = Placement();
        body.place.translate.setZero(scene.dimension);
    }
    return scene;
}

// Removes a body from the pairs of [contact]. If it was in all pairs of `only`, an empty `only`,
// which lets all bodies meet, would turn the meaning around: then every pair is ignored.
void remove_from_pairs(const std::string& body, Scene& scene) {
    const auto has_it = [&](const BodyPair& pair) {
        return pair.first == body || pair.second == body;
    };
    ContactSettings& contact = *scene.contact;
    const bool had_only = !contact.only.empty();
    std::erase_if(contact.ignore, has_it);
    std::erase_if(contact.only, has_it);
    if (had_only && contact.only.empty()) {
        for (std::size_t a = 0; a < scene.bodies.size(); ++a) {
            for (std::size_t b = a; b < scene.bodies.size(); ++b) {
                contact.ignore.push_back({scene.bodies[a].name, scene.bodies[b].name});
            }
        }
    }
}

Scene without_body(Scene scene, std::size_t body) {
    const std::string name = scene.bodies[body].name;
    const auto is_of_it = [&](const auto& part) { return part.body == name; };
    scene.bodies.erase(scene.bodies.begin() + static_cast<std::ptrdiff_t>(body));
    std::erase_if(scene.constraints, is_of_it);
    std::erase_if(scene.loads, is_of_it);
    std::erase_if(scene.activations, is_of_it);
    std::erase_if(scene.attachments, [&](const Attachment& attachment) {
        return is_of_it(attachment) || attachment.target == name;
    });
    if (scene.contact) {
        remove_from_pairs(name, scene);
    }
    return scene;
}

// Takes columns [begin, begin + count) out of an array that has them.
template <int Dim>
void cut(Positions<Dim>& array, Eigen::Index begin, Eigen::Index count) {
    if (array.cols() == 0) {
        return;
    }
    const Eigen::Index behind = array.cols() - begin - count;
    array.middleCols(begin, behind) = array.rightCols(behind).eval();
    array.conservativeResize(Dim, array.cols() - count);
}

template <int Dim>
HostState<Dim> without_body(HostState<Dim> host, const Bodies<Dim>& bodies, std::size_t body) {
    const auto range = bodies.vertices(body);
    cut<Dim>(host.forces, range.begin, range.size);
    if (host.forces.isZero(0)) {
        host.forces.resize(Dim, 0);
    }
    std::erase_if(host.grabs, [&](const auto& holding) {
        return static_cast<std::size_t>(holding.grab.point.body) == body;
    });
    for (auto& holding : host.grabs) {
        holding.grab.point.body -= static_cast<std::size_t>(holding.grab.point.body) > body ? 1 : 0;
    }
    const auto first = std::lower_bound(host.held.begin(), host.held.end(), range.begin);
    const auto last = std::lower_bound(first, host.held.end(), range.begin + range.size);
    cut<Dim>(host.targets, first - host.held.begin(), last - first);
    for (auto behind = last; behind != host.held.end(); ++behind) {
        *behind -= static_cast<std::uint32_t>(range.size);
    }
    host.held.erase(first, last);
    return host;
}

template <int Dim>
Snapshot<Dim> without_body(Snapshot<Dim> snapshot,
                           const Scene& scene,
                           const Bodies<Dim>& bodies,
                           const HeldVertices<Dim>& held,
                           std::size_t body) {
    const auto range = bodies.vertices(body);
    for (Positions<Dim>* array : {&snapshot.positions, &snapshot.velocities,
                                  &snapshot.previous_positions, &snapshot.previous_velocities}) {
        cut<Dim>(*array, range.begin, range.size);
    }
    snapshot.sleep.erase(snapshot.sleep.begin() + static_cast<std::ptrdiff_t>(body));
    Eigen::Index places = 0;
    for (const DirichletSet<Dim>& set : held.sets()) {
        if (set.begins_later() && set.body == body) {
            cut<Dim>(snapshot.hold_places, places, set.places.cols());
        } else if (set.begins_later()) {
            places += set.places.cols();
        }
    }
    auto spring = snapshot.broken_springs.begin();
    for (const Attachment& attachment : scene.attachments) {
        const auto count = static_cast<std::ptrdiff_t>(
            select_vertices(bodies.meshes[index_of(scene, attachment.body)], attachment).size());
        const std::string& name = scene.bodies[body].name;
        if (attachment.body == name || attachment.target == name) {
            spring = snapshot.broken_springs.erase(spring, spring + count);
        } else {
            spring += count;
        }
    }
    snapshot.host = without_body(std::move(snapshot.host), bodies, body);
    return snapshot;
}

template <int Dim>
void wake(const std::vector<std::size_t>& bodies, Snapshot<Dim>& snapshot) {
    for (const std::size_t body : bodies) {
        snapshot.sleep[body] = {};
    }
}

// Changes make bodies anew from whole meshes, which no rank has.
template <int Dim>
void refuse_parts(const Bodies<Dim>& bodies) {
    if (is_of_parts(bodies)) {
        throw Error(
            "bodies and obstacles come and go where every rank has whole meshes; this"
            " simulation was given parts of them");
    }
}

}  // namespace

template <int Dim>
void Simulation<Dim>::add_body(const Body& body, SimplexMesh<Dim> mesh) {
    refuse_parts(stepper_->bodies());
    Scene scene = placed(stepper_->scene());
    scene.bodies.push_back(body);
    check(scene);
    std::vector<SimplexMesh<Dim>> meshes = stepper_->bodies().meshes;
    meshes.push_back(place(std::move(mesh), body));
    auto next =
        std::make_shared<Stepper>(placed(std::move(scene)), std::move(meshes), stepper_->options());
    const State<Dim>& begin = next->current();
    Snapshot<Dim> snapshot = stepper_->save();
    const Eigen::Index before = snapshot.positions.cols();
    const Eigen::Index count = begin.positions.cols();
    snapshot.positions.conservativeResize(Dim, count);
    snapshot.velocities.conservativeResize(Dim, count);
    snapshot.positions.rightCols(count - before) = begin.positions.rightCols(count - before);
    snapshot.velocities.rightCols(count - before) = begin.velocities.rightCols(count - before);
    // BDF2 would need where the body was a step ago: it begins anew, with a step of Euler.
    snapshot.previous_positions.resize(Dim, 0);
    snapshot.previous_velocities.resize(Dim, 0);
    snapshot.sleep.emplace_back();
    if (snapshot.host.forces.cols() > 0) {
        snapshot.host.forces.conservativeResize(Dim, count);
        snapshot.host.forces.rightCols(count - before).setZero();
    }
    next->restore(snapshot);
    stepper_ = std::move(next);
}

template <int Dim>
void Simulation<Dim>::remove_body(int body) {
    const Bodies<Dim>& bodies = stepper_->bodies();
    refuse_parts(bodies);
    check_body(body, bodies);
    const auto index = static_cast<std::size_t>(body);
    Snapshot<Dim> snapshot = stepper_->save();
    wake(stepper_->neighbors_of_body(index), snapshot);
    std::vector<SimplexMesh<Dim>> meshes = bodies.meshes;
    meshes.erase(meshes.begin() + body);
    auto next = std::make_shared<Stepper>(placed(without_body(stepper_->scene(), index)),
                                          std::move(meshes), stepper_->options());
    next->restore(
        without_body(std::move(snapshot), stepper_->scene(), bodies, stepper_->held(), index));
    stepper_ = std::move(next);
}

template <int Dim>
void Simulation<Dim>::add_obstacle(const Obstacle& obstacle) {
    refuse_parts(stepper_->bodies());
    Scene scene = placed(stepper_->scene());
    scene.obstacles.push_back(obstacle);
    stepper_->set_obstacles(scene, {});
    stepper_->wake(stepper_->neighbors_of_obstacle(scene.obstacles.size() - 1));
}

template <int Dim>
void Simulation<Dim>::remove_obstacle(int obstacle) {
    refuse_parts(stepper_->bodies());
    Scene scene = placed(stepper_->scene());
    const auto count = static_cast<int>(scene.obstacles.size());
    if (obstacle < 0 || obstacle >= count) {
        throw Error("obstacle " + std::to_string(obstacle) + " of " + std::to_string(count)
                    + "; count from 0");
    }
    scene.obstacles.erase(scene.obstacles.begin() + obstacle);
    stepper_->set_obstacles(std::move(scene),
                            stepper_->neighbors_of_obstacle(static_cast<std::size_t>(obstacle)));
}

#define PENT_INSTANTIATE(Dim)                                               \
    template void Simulation<Dim>::add_body(const Body&, SimplexMesh<Dim>); \
    template void Simulation<Dim>::remove_body(int);                        \
    template void Simulation<Dim>::add_obstacle(const Obstacle&);           \
    template void Simulation<Dim>::remove_obstacle(int);
PENT_FOR_EACH_DIMENSION(PENT_INSTANTIATE)
#undef PENT_INSTANTIATE

}  // namespace pent::simulator
