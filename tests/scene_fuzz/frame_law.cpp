#include "law_scene.h"
#include "physics_laws.h"
#include "random.h"

#include <pent/formatted.h>
#include <pent/simulator/crossing_error.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>
#include <utility>

namespace pent::scene_fuzz {

namespace {

using namespace simulator;

template <int Dim>
using Turn = Eigen::Matrix<double, Dim, Dim>;

// Bodies and what they do to one another.
Scene bare(Scene scene) {
    const auto dimension = static_cast<Eigen::Index>(scene.dimension);
    scene.gravity = Eigen::VectorXd::Zero(dimension);
    scene.obstacles.clear();
    scene.constraints.clear();
    scene.loads.clear();
    scene.attachments.clear();
    scene.activations.clear();
    scene.damping.reset();
    scene.sleep.reset();
    scene.solver.integrator = Integrator::NewtonEuler;
    for (Body& body : scene.bodies) {
        body.place = {.scale = 1, .rotate = {}, .translate = Eigen::VectorXd::Zero(dimension)};
        body.velocity = Eigen::VectorXd::Zero(dimension);
        body.spin.clear();
        body.regions.clear();
    }
    return scene;
}

// The same bodies turned, mirrored, elsewhere, with other numbers.
template <int Dim>
class OtherFrame {
public:
    OtherFrame(const Simulation<Dim>& simulation, Random& random) : simulation_(simulation) {
        is_mirrored_ = random.chance(0.5);
        away_ = random.pick({1.0, 1e3, 1e6});
        if (is_mirrored_) {
            turn_(0, 0) = -1;
        }
        for (int i = 0; i < Dim; ++i) {
            for (int j = 0; j < i; ++j) {
                const double angle = random.number(-3, 3);
                Turn<Dim> turn = Turn<Dim>::Identity();
                turn(i, i) = turn(j, j) = std::cos(angle);
                turn(j, i) = std::sin(angle);
                turn(i, j) = -turn(j, i);
                turn_ = (turn * turn_).eval();
            }
            shift_[i] = random.number(-1, 1) * away_ * extent_of(simulation);
        }
        for (int body = 0; body < simulation.body_count(); ++body) {
            std::vector<std::uint32_t> order(
                static_cast<std::size_t>(simulation.mesh(body).vertex_count()));
            std::iota(order.begin(), order.end(), 0U);
            for (std::size_t i = order.size(); i > 1; --i) {
                std::swap(order[i - 1], order[random.below(i)]);
            }
            orders_.push_back(std::move(order));
        }
    }

    // In extents of the scene: so much more is rounded of places there.
    [[nodiscard]] double away() const { return away_; }

    // Bodies are in the other order.
    [[nodiscard]] std::vector<SimplexMesh<Dim>> meshes() const {
        std::vector<SimplexMesh<Dim>> all;
        for (int body = simulation_.body_count() - 1; body >= 0; --body) {
            const std::vector<std::uint32_t>& order = orders_[static_cast<std::size_t>(body)];
            std::vector<std::uint32_t> number(order.size());
            for (std::size_t i = 0; i < order.size(); ++i) {
                number[order[i]] = static_cast<std::uint32_t>(i);
            }
            SimplexMesh<Dim> mesh = simulation_.mesh(body);
            mesh.positions = (turn_ * mesh.positions(Eigen::all, order)).colwise() + shift_;
            mesh.fibers.resize(Dim, 0);
            mesh.columns.clear();
            mesh.layers.clear();
            for (std::uint32_t& vertex : mesh.cells.reshaped()) {
                vertex = number[vertex];
            }
            if (is_mirrored_) {
                mesh.cells.row(0).swap(mesh.cells.row(1));
            }
            all.push_back(std::move(mesh));
        }
        return all;
    }

    // Of all vertices of all bodies.
    [[nodiscard]] Positions<Dim> points(const Positions<Dim>& points) const {
        return vectors(points).colwise() + shift_;
    }

    [[nodiscard]] Positions<Dim> vectors(const Positions<Dim>& vectors) const {
        Positions<Dim> turned(Dim, vectors.cols());
        Eigen::Index end_here = vectors.cols();
        Eigen::Index start_there = 0;
        for (auto order = orders_.rbegin(); order != orders_.rend(); ++order) {
            const auto count = static_cast<Eigen::Index>(order->size());
            end_here -= count;
            turned.middleCols(start_there, count) =
                turn_ * vectors.middleCols(end_here, count)(Eigen::all, *order);
            start_there += count;
        }
        return turned;
    }

private:
    const Simulation<Dim>& simulation_;
    Turn<Dim> turn_ = Turn<Dim>::Identity();
    Eigen::Matrix<double, Dim, 1> shift_;
    bool is_mirrored_ = false;
    double away_ = 1;
    std::vector<std::vector<std::uint32_t>> orders_;  // of each body: which vertex comes i-th
};

template <int Dim>
double largest(const Positions<Dim>& vectors) {
    return vectors.colwise().norm().maxCoeff();
}

template <int Dim>
Snapshot<Dim> with_positions(Snapshot<Dim> snapshot, const Positions<Dim>& positions, double k) {
    snapshot.positions = positions;
    snapshot.contact_stiffness = k;
    return snapshot;
}

template <int Dim>
bool puts(Simulation<Dim>& simulation, const Positions<Dim>& positions, double stiffness) {
    try {
        simulation.restore(with_positions(simulation.save(), positions, stiffness));
    } catch (const CrossingError<Dim>&) {
        return false;
    }
    return true;
}

template <int Dim>
std::vector<SimplexMesh<Dim>> placed_meshes(const Simulation<Dim>& simulation) {
    std::vector<SimplexMesh<Dim>> meshes;
    for (int body = 0; body < simulation.body_count(); ++body) {
        meshes.push_back(simulation.mesh(body));
    }
    return meshes;
}

// What rounding of places, m, makes of energies and forces: as a part of them and near zero, J, N.
struct Rounding {
    double place = 0;
    double part = 0;
    double elastic = 0;
    double contact = 0;
    double force = 0;
};

template <int Dim>
Rounding rounding_of(const Simulation<Dim>& simulation, double stiffness, double away) {
    const double of_places = 1e-12 * away;
    Rounding rounding{
        .place = of_places * extent_of(simulation),
        .part = 1e4 * of_places,  // of distances far below the extent
    };
    for (int body = 0; body < simulation.body_count(); ++body) {
        const Lame& lame = simulation.scene().bodies[static_cast<std::size_t>(body)].material.lame;
        rounding.elastic +=
            of_places * (lame.mu + std::abs(lame.lambda)) * total_volume(simulation.mesh(body));
    }
    rounding.force = stiffness * rounding.place;
    rounding.contact = rounding.force * extent_of(simulation);
    return rounding;
}

template <int Dim>
void compare_energies(const Simulation<Dim>& here,
                      const Simulation<Dim>& there,
                      const Rounding& rounding,
                      int step) {
    const auto compare = [&](const char* name, double near_zero) {
        const double one = here.energies().of(name);
        const double other = there.energies().of(name);
        const double allowed = rounding.part * (std::abs(one) + std::abs(other)) + near_zero;
        if (!(std::abs(one - other) <= allowed)) {
            throw BrokenLaw(
                formatted("the %s energy is %.9g J, and %.9g J in another frame, at"
                          " step %d",
                          name, one, other, step));
        }
    };
    compare("elastic", rounding.elastic);
    compare("contact", rounding.contact);
}

// Whether places that are the same but for rounding have other forces: where a vertex is as near to
// one face as to another, as where faces of two boxes lie in one plane.
template <int Dim>
bool is_at_a_jump(Simulation<Dim>& simulation,
                  const Positions<Dim>& forces,
                  double rounding_of_places,
                  double allowed,
                  Random& random) {
    const Snapshot<Dim> state = simulation.save();
    for (int k = 0; k < 8; ++k) {
        Positions<Dim> nudged = state.positions;
        for (double& coordinate : nudged.reshaped()) {
            coordinate += random.number(-1, 1) * rounding_of_places;
        }
        if (!puts(simulation, nudged, state.contact_stiffness)
            || largest<Dim>(contact_forces_of(simulation) - forces) > allowed) {
            return true;
        }
    }
    return false;
}

template <int Dim>
void compare_forces(Simulation<Dim>& here,
                    const Simulation<Dim>& there,
                    const OtherFrame<Dim>& frame,
                    const Rounding& rounding,
                    Random& random,
                    int step) {
    const Positions<Dim> forces = contact_forces_of(here);
    const Positions<Dim> turned = frame.vectors(forces);
    const double sum = forces.colwise().norm().sum();
    const double off = largest<Dim>(turned - contact_forces_of(there));
    const double allowed = rounding.part * sum + rounding.force;
    if (!(off <= allowed) && !is_at_a_jump(here, forces, rounding.place, allowed, random)) {
        throw BrokenLaw(
            formatted("forces of contact, %.3g N in all, differ by %.3g N from those in"
                      " another frame, at step %d",
                      sum, off, step));
    }
}

template <int Dim>
void check_frame_in(const Scene& scene, std::uint64_t seed) {
    Random random(seed);
    Simulation<Dim> simulation(scene, read_meshes<Dim>(scene), {.isa = "scalar"});
    const Scene stripped = bare(scene);
    Scene reversed = stripped;
    std::reverse(reversed.bodies.begin(), reversed.bodies.end());
    std::optional<Simulation<Dim>> start;
    try {
        start.emplace(stripped, placed_meshes(simulation), SimulationOptions{.isa = "scalar"});
    } catch (const CrossingError<Dim>&) {
        return;  // what is held may cross
    }
    Simulation<Dim>& here = *start;
    const OtherFrame<Dim> frame(simulation, random);
    Simulation<Dim> there(reversed, frame.meshes(), {.isa = "scalar"});
    for (int k = 0; k <= step_count(scene); ++k) {
        const double stiffness = simulation.save().contact_stiffness;
        const Positions<Dim> positions = simulation.save().positions;
        const bool is_here = puts(here, positions, stiffness);
        if (is_here != puts(there, frame.points(positions), stiffness)) {
            throw BrokenLaw(
                formatted("step %d crosses only where it is%s turned", k, is_here ? "" : " not"));
        }
        if (is_here) {
            const double stiffest =
                std::max(stiffness, scene.contact ? scene.contact->stiffness : 0);
            const Rounding rounding = rounding_of(here, stiffest, frame.away());
            compare_energies(here, there, rounding, k);
            compare_forces(here, there, frame, rounding, random, k);
        }
        if (!simulation.step().is_accepted) {
            return;
        }
    }
}

}  // namespace

void check_frame(const Scene& scene) {
    const std::uint64_t seed = seed_of(scene);
    in_dimension(
        scene, [&] { check_frame_in<3>(scene, seed); }, [&] { check_frame_in<4>(scene, seed); });
}

}  // namespace pent::scene_fuzz
