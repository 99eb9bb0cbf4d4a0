#include "law_scene.h"
#include "physics_laws.h"
#include "random.h"

#include <pent/formatted.h>
#include <pent/simulator/crossing_error.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <string>

namespace pent::scene_fuzz {

namespace {

using namespace simulator;

template <int Dim>
bool are_same(const Positions<Dim>& a, const Positions<Dim>& b) {
    return a.cols() == b.cols() && a == b;
}

template <int Dim>
bool are_same(const HostState<Dim>& a, const HostState<Dim>& b) {
    const auto is_same_grab = [](const auto& x, const auto& y) {
        return x.id == y.id && x.from == y.from && x.grab.anchor == y.grab.anchor
               && x.grab.stiffness == y.grab.stiffness && x.grab.damping == y.grab.damping
               && x.grab.max_force == y.grab.max_force && x.grab.point.body == y.grab.point.body
               && x.grab.point.cell == y.grab.point.cell
               && x.grab.point.weights == y.grab.point.weights;
    };
    return a.gravity == b.gravity && are_same<Dim>(a.forces, b.forces)
           && std::equal(a.grabs.begin(), a.grabs.end(), b.grabs.begin(), b.grabs.end(),
                         is_same_grab)
           && a.next_grab == b.next_grab && a.held == b.held && are_same<Dim>(a.targets, b.targets);
}

template <int Dim>
bool are_same(const Snapshot<Dim>& a, const Snapshot<Dim>& b) {
    return are_same<Dim>(a.positions, b.positions) && are_same<Dim>(a.velocities, b.velocities)
           && are_same<Dim>(a.previous_positions, b.previous_positions)
           && are_same<Dim>(a.previous_velocities, b.previous_velocities) && a.sleep == b.sleep
           && a.steps == b.steps && a.contact_stiffness == b.contact_stiffness
           && are_same<Dim>(a.hold_places, b.hold_places) && a.broken_springs == b.broken_springs
           && are_same(a.host, b.host);
}

// A host that does the same to two simulations, of one thread and of three. Now and then the second
// one gives way to a new one, into which the state of the first is restored.
template <int Dim>
class HostLaw {
public:
    explicit HostLaw(const Scene& scene)
        : bodies_(scene.bodies),
          meshes_(read_meshes<Dim>(scene)),
          steps_(step_count(scene)),
          random_(seed_of(scene)),
          one_(scene, meshes_, {.threads = 1}),
          three_(scene, meshes_, {.threads = 3}),
          as_opened_(meshes_) {}

    void run() {
        for (int k = 0; k < steps_; ++k) {
            for (int acts = random_.whole(0, 3); acts > 0; --acts) {
                act();
            }
            if (random_.chance(0.2)) {
                repeat_step();
            } else {
                take_step();
            }
            if (random_.chance(0.2)) {
                go_on_elsewhere();
            }
        }
    }

private:
    using Vector = Eigen::Matrix<double, Dim, 1>;
    using Act = std::function<void(Simulation<Dim>&)>;

    void act() {
        using Member = void (HostLaw::*)();
        static constexpr Member kActs[] = {
            &HostLaw::hold,        &HostLaw::hold,       &HostLaw::let_go,
            &HostLaw::grab,        &HostLaw::move_grab,  &HostLaw::remove_grab,
            &HostLaw::push,        &HostLaw::turn_down,  &HostLaw::put,
            &HostLaw::add_body,    &HostLaw::add_ground, &HostLaw::remove_body,
            &HostLaw::remove_last, &HostLaw::go_back,    &HostLaw::ask_the_impossible,
        };
        (this->*kActs[random_.below(std::size(kActs))])();
    }

    void hold() {
        const int body = any_body();
        const std::vector<std::uint32_t> vertices = some_vertices(body);
        const Positions<Dim> all = one_.positions(body);
        Positions<Dim> targets(Dim, static_cast<Eigen::Index>(vertices.size()));
        const double way = random_.magnitude(1e-3, 0.3) * extent_of(one_);
        for (std::size_t i = 0; i < vertices.size(); ++i) {
            targets.col(static_cast<Eigen::Index>(i)) = all.col(vertices[i]) + any_vector(way);
        }
        do_to_both("targets", [&](auto& one) { one.set_targets(body, vertices, targets); });
    }

    void let_go() {
        const int body = any_body();
        const std::vector<std::uint32_t> vertices = some_vertices(body);
        do_to_both("release", [&](auto& one) { one.release(body, vertices); });
    }

    void grab() {
        Grab<Dim> grab;
        grab.point.body = any_body();
        const std::int64_t cells = one_.mesh(grab.point.body).cells.cols();
        grab.point.cell = static_cast<std::int64_t>(random_.below(static_cast<std::size_t>(cells)));
        for (double& weight : grab.point.weights) {
            weight = 0.1 + random_.share();
        }
        grab.point.weights /= grab.point.weights.sum();
        grab.anchor = one_.positions(grab.point.body).rowwise().mean()
                      + any_vector(random_.magnitude(1e-2, 1) * extent_of(one_));
        grab.stiffness = random_.magnitude(1, 1e6);
        grab.damping = random_.chance(0.5) ? 0 : random_.magnitude(0.1, 100);
        if (random_.chance(0.5)) {
            grab.max_force = random_.magnitude(1, 1e4);
        }
        do_to_both("grab", [&](auto& one) { static_cast<void>(one.add_grab(grab)); });
    }

    void move_grab() {
        if (const std::uint64_t id = any_grab(); id > 0) {
            const Vector anchor = any_vector(extent_of(one_));
            do_to_both("moved grab", [&](auto& one) { one.move_grab(id, anchor); });
        }
    }

    void remove_grab() {
        if (const std::uint64_t id = any_grab(); id > 0) {
            do_to_both("removed grab", [&](auto& one) { one.remove_grab(id); });
        }
    }

    void push() {
        const int body = any_body();
        Positions<Dim> forces = Positions<Dim>::Zero(Dim, one_.positions(body).cols());
        if (random_.chance(0.7)) {
            const Vector acceleration = any_vector(random_.magnitude(1, 100));
            forces = acceleration * one_.masses(body).transpose();
        }
        do_to_both("forces", [&](auto& one) { one.set_forces(body, forces); });
    }

    void turn_down() {
        const Vector gravity = any_vector(10);
        do_to_both("gravity", [&](auto& one) { one.set_gravity(gravity); });
    }

    // Somewhere else, as it is or turned, with another velocity.
    void put() {
        const int body = any_body();
        Positions<Dim> positions = one_.positions(body);
        const Vector center = positions.rowwise().mean();
        positions.colwise() -= center;
        if (random_.chance(0.5)) {
            const double angle = random_.number(-3, 3);
            const Eigen::RowVectorXd x = positions.row(0);
            const Eigen::RowVectorXd y = positions.row(1);
            positions.row(0) = std::cos(angle) * x - std::sin(angle) * y;
            positions.row(1) = std::sin(angle) * x + std::cos(angle) * y;
        }
        positions.colwise() +=
            center + any_vector(random_.pick({0.0, 0.05, 1.0}) * extent_of(one_));
        const Positions<Dim> velocities =
            any_vector(random_.magnitude(1e-3, 3)).replicate(1, positions.cols());
        do_to_both("state of a body",
                   [&](auto& one) { one.set_state(body, positions, velocities); });
    }

    void add_body() {
        if (one_.body_count() >= 5) {
            return;
        }
        const std::size_t like = random_.below(bodies_.size());
        Body body = bodies_[like];
        body.name = formatted("added-%d", ++added_);
        body.place.translate += any_vector(random_.magnitude(0.1, 2) * extent_of(one_));
        if (do_to_both("added body", [&](auto& one) { one.add_body(body, meshes_[like]); })) {
            are_other_bodies_there();
        }
    }

    void remove_body() {
        const int body = any_body();
        if (one_.body_count() > 1
            && do_to_both("removed body", [&](auto& one) { one.remove_body(body); })) {
            are_other_bodies_there();
        }
    }

    void add_ground() {
        const Vector normal = any_vector(1).normalized();
        const Positions<Dim> all =
            of_all(one_, [&](int body) -> Positions<Dim> { return one_.positions(body); });
        const double gap = random_.magnitude(1e-3, 0.3) * extent_of(one_);
        const Obstacle ground{
            .shape = HalfSpaceObstacle{.normal = normal,
                                       .offset = (normal.transpose() * all).minCoeff() - gap}};
        if (do_to_both("added obstacle", [&](auto& one) { one.add_obstacle(ground); })) {
            are_other_bodies_there();
        }
    }

    void remove_last() {
        const int last = static_cast<int>(one_.obstacles().size()) - 1;
        if (last >= 0
            && do_to_both("removed obstacle", [&](auto& one) { one.remove_obstacle(last); })) {
            are_other_bodies_there();
        }
    }

    // To a state of before, as far as there is one of the bodies and obstacles of now.
    void go_back() {
        if (earlier_.empty() || random_.chance(0.5)) {
            earlier_.push_back(one_.save());
            return;
        }
        const Snapshot<Dim>& state = earlier_[random_.below(earlier_.size())];
        if (do_to_both("restored state", [&](auto& one) { one.restore(state); })
            && !are_same(one_.save(), state)) {
            throw BrokenLaw("a state is another one after it was restored");
        }
    }

    void ask_the_impossible() {
        const int body = any_body();
        const auto vertices = static_cast<std::uint32_t>(one_.positions(body).cols());
        const Positions<Dim> nowhere = Positions<Dim>::Constant(Dim, vertices, NAN);
        const Positions<Dim> somewhere = Positions<Dim>::Zero(Dim, 1);
        const Act acts[] = {
            [&](auto& one) { one.set_targets(body, {vertices}, somewhere); },
            [&](auto& one) { one.set_targets(body, {0}, nowhere.leftCols(1)); },
            [&](auto& one) { one.set_targets(one.body_count(), {0}, somewhere); },
            [&](auto& one) { one.release(body, {vertices}); },
            [&](auto& one) { one.set_forces(body, nowhere); },
            [&](auto& one) { one.set_gravity(nowhere.col(0)); },
            [&](auto& one) { one.set_state(body, one.positions(body), nowhere); },
            [&](auto& one) { one.move_grab(~std::uint64_t{0}, somewhere); },
            [&](auto& one) { one.add_body(one.scene().bodies.front(), one.mesh(0)); },
            [&](auto& one) { one.remove_body(-1); },
            [&](auto& one) { one.remove_obstacle(static_cast<int>(one.obstacles().size())); },
            [&](auto& one) {
                Snapshot<Dim> state = one.save();
                state.sleep.pop_back();
                one.restore(state);
            },
        };
        const std::size_t which = random_.below(std::size(acts));
        if (do_to_both("what cannot be", acts[which])) {
            throw BrokenLaw(formatted("what cannot be, number %zu, was not refused", which));
        }
    }

    // Both take it, or refuse it with the same words; whether they take it.
    bool do_to_both(const char* what, const Act& act) {
        const std::string refusal = refusal_of(what, act, one_);
        const std::string other = refusal_of(what, act, three_);
        if (refusal != other) {
            throw BrokenLaw(formatted("%s: \"%s\" of one thread, \"%s\" of three", what,
                                      refusal.c_str(), other.c_str()));
        }
        if (refusal.find('\n') != std::string::npos) {
            throw BrokenLaw(formatted("%s: refused in several lines: ", what) + refusal);
        }
        compare(what);
        return refusal.empty();
    }

    static std::string refusal_of(const char* what, const Act& act, Simulation<Dim>& simulation) {
        const Snapshot<Dim> before = simulation.save();
        try {
            act(simulation);
            return "";
        } catch (const Error& error) {
            if (!are_same(before, simulation.save())) {
                throw BrokenLaw(formatted("%s was refused, but has changed the state: ", what)
                                + error.what());
            }
            return error.what();
        }
    }

    StepReport take_step() {
        const Snapshot<Dim> before = one_.save();
        const StepReport report = one_.step();
        const StepReport other = three_.step();
        compare("step");
        if (report.failure != other.failure || report.iterations != other.iterations
            || report.energies.total() != other.energies.total()) {
            throw BrokenLaw(
                formatted("a step is \"%s\", of %lld iterations and %.17g J, by one thread,"
                          " \"%s\", of %lld and %.17g J, by three",
                          report.failure.c_str(), static_cast<long long>(report.iterations),
                          report.energies.total(), other.failure.c_str(),
                          static_cast<long long>(other.iterations), other.energies.total()));
        }
        const Snapshot<Dim> after = one_.save();
        if (!report.is_accepted && before.positions != after.positions) {
            throw BrokenLaw("a step that was not taken has moved something");
        }
        if (!after.positions.allFinite() || !after.velocities.allFinite()) {
            throw BrokenLaw("a state is not finite");
        }
        return report;
    }

    // A step that is undone and taken again is the same.
    void repeat_step() {
        const Snapshot<Dim> before = one_.save();
        if (!take_step().is_accepted) {
            return;
        }
        const Snapshot<Dim> after = one_.save();
        do_to_both("step undone", [&](auto& one) { one.restore(before); });
        take_step();
        if (!are_same(one_.save(), after)) {
            throw BrokenLaw("a step is another one when it is taken again");
        }
    }

    void go_on_elsewhere() {
        try {
            Simulation<Dim> other(one_.scene(), as_opened_, {.threads = 3});
            other.restore(one_.save());
            three_ = std::move(other);
        } catch (const CrossingError<Dim>&) {
            return;  // at rest bodies may be where they cannot be together
        }
        compare("state restored elsewhere");
    }

    void compare(const char* what) const {
        if (!are_same(one_.save(), three_.save())) {
            throw BrokenLaw(
                formatted("%s, after %llu steps: another state of one thread than of three", what,
                          static_cast<unsigned long long>(one_.step_count())));
        }
    }

    // States of before do not fit any more; meshes are as they are placed.
    void are_other_bodies_there() {
        earlier_.clear();
        as_opened_.clear();
        for (int body = 0; body < one_.body_count(); ++body) {
            as_opened_.push_back(one_.mesh(body));
        }
    }

    int any_body() {
        return static_cast<int>(random_.below(static_cast<std::size_t>(one_.body_count())));
    }

    std::vector<std::uint32_t> some_vertices(int body) {
        std::vector<std::uint32_t> all(static_cast<std::size_t>(one_.positions(body).cols()));
        std::iota(all.begin(), all.end(), 0U);
        const double share = random_.pick({0.05, 0.3, 1.0});
        std::erase_if(all, [&](std::uint32_t) { return !random_.chance(share); });
        return all;
    }

    std::uint64_t any_grab() {
        const HostState<Dim> host = one_.host();
        return host.grabs.empty() ? 0 : host.grabs[random_.below(host.grabs.size())].id;
    }

    Vector any_vector(double size) {
        Vector vector;
        for (double& entry : vector) {
            entry = random_.number(-size, size);
        }
        return vector;
    }

    std::vector<Body> bodies_;  // as the scene has them
    std::vector<SimplexMesh<Dim>> meshes_;
    int steps_;
    int added_ = 0;
    Random random_;
    Simulation<Dim> one_;
    Simulation<Dim> three_;
    std::vector<SimplexMesh<Dim>> as_opened_;  // meshes of the bodies that are there
    std::vector<Snapshot<Dim>> earlier_;
};

}  // namespace

void check_host(const Scene& scene) {
    in_dimension(
        scene, [&] { HostLaw<3>(scene).run(); }, [&] { HostLaw<4>(scene).run(); });
}

}  // namespace pent::scene_fuzz
