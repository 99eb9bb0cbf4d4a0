#pragma once

#include "support/crossing_checker.h"
#include "support/kuhn_box.h"

#include <pent/simulator/simulation.h>

#include <algorithm>
#include <array>
#include <limits>
#include <string>
#include <vector>

namespace pent::simulator::test {

/// Scenes of small bodies for the barrier, in R^3 and R^4 alike: axes beyond the second are alike.
template <int Dim>
struct BarrierScene {
    Scene scene;
    std::vector<SimplexMesh<Dim>> meshes;

    BarrierScene() {
        scene.dimension = Dim;
        scene.gravity = Eigen::VectorXd::Zero(Dim);
        scene.frames = 1000;
        scene.frames_per_second = 100;
        scene.solver.integrator = Integrator::NewtonEuler;
        scene.contact =
            ContactSettings{.model = ContactModel::Barrier, .distance = 0.02, .stiffness = 1000};
    }

    Body& add(const SimplexMesh<Dim>& mesh, const Eigen::VectorXd& at, double young = 1e5) {
        Body body;
        body.name = std::string(1, static_cast<char>('a' + scene.bodies.size()));
        body.mesh = body.name + ".pent";
        body.place.translate = at;
        body.material.lame = lame_from_young(Dim, young, 0.28);
        body.material.density = 1000;
        scene.bodies.push_back(body);
        meshes.push_back(mesh);
        return scene.bodies.back();
    }

    /// Holds what is in a box of the body added last, moving at a velocity (m/s) until a time (s).
    void hold(const Eigen::VectorXd& low,
              const Eigen::VectorXd& high,
              const Eigen::VectorXd& velocity,
              double until = std::numeric_limits<double>::infinity()) {
        Motion motion;
        motion.translate = velocity;
        motion.to = until;
        scene.constraints.push_back({.body = scene.bodies.back().name,
                                     .select = {BoxSelection{.low = low, .high = high}},
                                     .motion = {motion}});
    }
};

/// (first, second, rest, rest ...): a vector that treats all axes beyond the second alike.
template <int Dim>
[[nodiscard]] Eigen::VectorXd vector(double first, double second, double rest = 0) {
    Eigen::VectorXd v = Eigen::VectorXd::Constant(Dim, rest);
    v[0] = first;
    v[1] = second;
    return v;
}

/// A box of cells, its center at the origin.
template <int Dim>
[[nodiscard]] SimplexMesh<Dim> box(int first, int second, int rest, const Eigen::VectorXd& size) {
    std::array<int, Dim> count{};
    std::array<double, Dim> sizes{};
    count.fill(rest);
    count[0] = first;
    count[1] = second;
    std::copy_n(size.data(), Dim, sizes.begin());
    SimplexMesh<Dim> mesh = pent::test::kuhn_box<Dim>(count, sizes);
    mesh.positions.colwise() -= 0.5 * size;
    return mesh;
}

/// The box less the cells whose center is in [low, high] along the first two axes, and without the
/// vertices that no cell has.
template <int Dim>
[[nodiscard]] SimplexMesh<Dim> without(const SimplexMesh<Dim>& mesh,
                                       const std::array<double, 2>& low,
                                       const std::array<double, 2>& high) {
    SimplexMesh<Dim> rest;
    std::vector<Eigen::Index> kept;
    std::vector<std::uint32_t> number(static_cast<std::size_t>(mesh.vertex_count()), 0xffffffff);
    std::vector<Eigen::Index> vertices;
    for (Eigen::Index cell = 0; cell < mesh.cell_count(); ++cell) {
        bool is_inside = true;
        for (int axis = 0; axis < 2; ++axis) {
            double center = 0;
            for (int corner = 0; corner <= Dim; ++corner) {
                center += mesh.positions(axis, mesh.cells(corner, cell)) / (Dim + 1);
            }
            is_inside &= low[static_cast<std::size_t>(axis)] < center
                         && center < high[static_cast<std::size_t>(axis)];
        }
        if (!is_inside) {
            kept.push_back(cell);
        }
    }
    rest.cells.resize(Dim + 1, static_cast<Eigen::Index>(kept.size()));
    for (std::size_t k = 0; k < kept.size(); ++k) {
        for (int corner = 0; corner <= Dim; ++corner) {
            const std::uint32_t vertex = mesh.cells(corner, kept[k]);
            if (number[vertex] == 0xffffffff) {
                number[vertex] = static_cast<std::uint32_t>(vertices.size());
                vertices.push_back(vertex);
            }
            rest.cells(corner, static_cast<Eigen::Index>(k)) = number[vertex];
        }
    }
    rest.positions.resize(Dim, static_cast<Eigen::Index>(vertices.size()));
    for (std::size_t v = 0; v < vertices.size(); ++v) {
        rest.positions.col(static_cast<Eigen::Index>(v)) = mesh.positions.col(vertices[v]);
    }
    return rest;
}

/// Runs a scene and looks for crossings with code of its own: at every accepted step, and all along
/// the path that it took there.
template <int Dim>
class WatchedRun {
public:
    explicit WatchedRun(const BarrierScene<Dim>& scene)
        : is_self_(scene.scene.contact->self), simulation_(make(scene)) {
        std::uint32_t first = 0;
        for (const SimplexMesh<Dim>& mesh : scene.meshes) {
            surfaces_.push_back(contact::make_surface<Dim>(mesh.cells, mesh.vertex_count(), first));
            first += static_cast<std::uint32_t>(mesh.vertex_count());
        }
    }

    /// Takes steps; stops at the first that is not accepted.
    void run(int steps) {
        for (int k = 0; k < steps && failure_.empty(); ++k) {
            report_ = simulation_.step();
            if (!report_.is_accepted) {
                failure_ = report_.failure;
                return;
            }
            smallest_ = std::min(smallest_, report_.contact.smallest_distance);
            newton_iterations_ += report_.newton_iterations;
            for_each_pair([&](const Surface& a, const Surface& b) {
                crossings_ += pent::test::count_crossings<Dim>(a, b, last_);
            });
        }
    }

    [[nodiscard]] Simulation<Dim>& simulation() { return simulation_; }
    [[nodiscard]] const std::string& failure() const { return failure_; }
    [[nodiscard]] int crossings() const { return crossings_; }
    [[nodiscard]] double smallest_distance() const { return smallest_; }
    [[nodiscard]] int newton_iterations() const { return newton_iterations_; }

private:
    using Surface = contact::Surface<Dim>;

    Simulation<Dim> make(const BarrierScene<Dim>& scene) {
        SimulationOptions options;
        options.on_iterate = [this](const Eigen::MatrixXd& positions, bool is_start) {
            const Positions<Dim> now = positions;
            if (!is_start) {
                for_each_pair([&](const Surface& a, const Surface& b) {
                    crossings_ += pent::test::count_swept_crossings<Dim>(a, b, last_, now);
                });
            }
            last_ = now;
        };
        return Simulation<Dim>(scene.scene, scene.meshes, options);
    }

    template <typename Visit>
    void for_each_pair(const Visit& visit) const {
        for (std::size_t a = 0; a < surfaces_.size(); ++a) {
            for (std::size_t b = is_self_ ? a : a + 1; b < surfaces_.size(); ++b) {
                visit(surfaces_[a], surfaces_[b]);
            }
        }
    }

    bool is_self_;
    Positions<Dim> last_;
    std::vector<Surface> surfaces_;
    int crossings_ = 0;
    Simulation<Dim> simulation_;
    StepReport report_;
    std::string failure_;
    int newton_iterations_ = 0;
    double smallest_ = std::numeric_limits<double>::infinity();
};

}  // namespace pent::simulator::test
