#include "beams.h"

#include "support/cut_in_two.h"
#include "support/kuhn_box.h"

#include <pent/error.h>
#include <pent/pent_file.h>
#include <pent/simulator/simulation.h>

#include <algorithm>
#include <map>
#include <random>
#include <tuple>

namespace pent::locking {

namespace {

// So small that linear elasticity is all there is, whatever is near it.
constexpr double kScale = 1e-6;

template <int Dim>
SimplexMesh<Dim> distorted(SimplexMesh<Dim> mesh, double edge) {
    std::mt19937 random(1);
    std::uniform_real_distribution<double> shift(-0.25 * edge, 0.25 * edge);
    const Eigen::Matrix<double, Dim, 1> size = mesh.positions.rowwise().maxCoeff();
    for (Eigen::Index v = 0; v < mesh.vertex_count(); ++v) {
        for (int axis = 0; axis < Dim; ++axis) {
            double& x = mesh.positions(axis, v);
            if (x > 0 && x < size[axis]) {
                x += shift(random);
            }
        }
    }
    return mesh;
}

// Each tetrahedron times [0, 1] in layers: a prism in four cells, along the ways from the lower end
// of its first vertex to the upper end of its last, by number, so that neighbors agree.
SimplexMesh<4> layered(const SimplexMesh<3>& base, int layers) {
    const auto vertices = static_cast<std::uint32_t>(base.vertex_count());
    SimplexMesh<4> mesh;
    mesh.positions.resize(4, base.vertex_count() * (layers + 1));
    mesh.cells.resize(5, base.cell_count() * 4 * layers);
    for (int level = 0; level <= layers; ++level) {
        auto own = mesh.positions.middleCols(level * base.vertex_count(), base.vertex_count());
        own.topRows<3>() = base.positions;
        own.row(3).setConstant(static_cast<double>(level) / layers);
    }
    Eigen::Index next = 0;
    for (int layer = 0; layer < layers; ++layer) {
        for (Eigen::Index t = 0; t < base.cell_count(); ++t) {
            Eigen::Matrix<std::uint32_t, 4, 1> corners = base.cells.col(t);
            std::sort(corners.begin(), corners.end());
            corners.array() += static_cast<std::uint32_t>(layer) * vertices;
            for (int up = 0; up < 4; ++up) {
                auto cell = mesh.cells.col(next);
                cell << corners.head(up + 1), (corners.tail(4 - up).array() + vertices).matrix();
                if (cell_volume<4>(mesh.positions, mesh.cells, next) < 0) {
                    std::swap(cell[0], cell[1]);
                }
                ++next;
            }
        }
    }
    return mesh;
}

template <int Dim>
SimplexMesh<Dim> tetgen_beam() {
    SimplexMesh<3> base = read_mesh<3>(PENT_TETGEN_BEAM).mesh;
    if constexpr (Dim == 4) {
        return layered(base, 2);
    } else {
        return base;
    }
}

// Of linear cells, exactly: a force that is linear in x has the mass matrix of a cell.
template <int Dim>
Positions<Dim> nodal_forces(const SimplexMesh<Dim>& mesh, const BodyForce<Dim>& load) {
    Positions<Dim> forces = Positions<Dim>::Zero(Dim, mesh.vertex_count());
    for (Eigen::Index cell = 0; cell < mesh.cell_count(); ++cell) {
        Eigen::Matrix<double, Dim, Dim + 1> at;
        for (int a = 0; a <= Dim; ++a) {
            at.col(a) = load.at(mesh.positions.col(mesh.cells(a, cell)));
        }
        const double weight =
            cell_volume<Dim>(mesh.positions, mesh.cells, cell) / ((Dim + 1) * (Dim + 2));
        for (int a = 0; a <= Dim; ++a) {
            forces.col(mesh.cells(a, cell)) += weight * (at.rowwise().sum() + at.col(a));
        }
    }
    return forces;
}

template <int Dim>
double reference_work(double poisson, Load load) {
    static std::map<std::pair<double, Load>, double> known;
    const auto [place, is_new] = known.try_emplace({poisson, load}, 0);
    if (is_new) {
        place->second = RitzBeam<Dim>(poisson).work(body_force<Dim>(load));
    }
    return place->second;
}

}  // namespace

template <int Dim>
BodyForce<Dim> body_force(Load load) {
    BodyForce<Dim> force;
    switch (load) {
        case Load::Bending:
            force.steady[1] = -1;
            break;
        case Load::Diagonal:
            force.steady.template tail<Dim - 1>().setOnes();
            break;
        case Load::Twist:
            force.turning(1, 2) = -1;
            force.turning(2, 1) = 1;
            break;
    }
    return force;
}

template <int Dim>
SimplexMesh<Dim> beam(int cells, Cut cut) {
    if (cut == Cut::TetGen) {
        return pent::test::cut_in_two<Dim>(tetgen_beam<Dim>());
    }
    const bool has_parents = cells % 2 == 0;
    const int across = has_parents ? cells / 2 : cells;
    std::array<int, Dim> counts{};
    std::array<double, Dim> sizes{};
    counts.fill(across);
    sizes.fill(1);
    counts[0] = 4 * across;
    sizes[0] = 4;
    SimplexMesh<Dim> mesh = pent::test::kuhn_box<Dim>(counts, sizes);
    if (cut == Cut::Distorted) {
        mesh = distorted<Dim>(std::move(mesh), 1.0 / across);
    }
    return has_parents ? pent::test::cut_in_two<Dim>(mesh) : mesh;
}

template <int Dim>
double give(const SimplexMesh<Dim>& beam,
            simulator::ElementKind elements,
            double share,
            Load load) {
    const double poisson = share * simulator::poisson_limit(Dim);
    simulator::Scene scene;
    scene.dimension = Dim;
    scene.gravity = Eigen::VectorXd::Zero(Dim);
    simulator::Body body;
    body.name = "beam";
    body.mesh = "beam.pent";
    body.place.translate = Eigen::VectorXd::Zero(Dim);
    body.material.model = simulator::Model::Linear;
    body.material.lame = simulator::lame_from_young(Dim, 1, poisson);
    body.material.density = 1;
    scene.bodies = {body};
    simulator::Motion still;
    still.translate = Eigen::VectorXd::Zero(Dim);
    const simulator::HalfSpaceSelection end{.normal = Eigen::VectorXd::Unit(Dim, 0),
                                            .offset = 1e-6};
    scene.constraints = {{.body = "beam", .select = {end}, .motion = {still}}};
    scene.solver.integrator = simulator::Integrator::Quasistatic;
    scene.solver.elements = elements;
    scene.solver.precision = simulator::Precision::Double;
    scene.solver.tolerance = 1e-7;
    scene.solver.newton_tolerance = 1e-5;
    scene.solver.max_iterations = 20'000;
    simulator::Simulation<Dim> simulation(scene, {beam}, {.threads = 2});
    const Positions<Dim> forces = nodal_forces<Dim>(beam, body_force<Dim>(load));
    simulation.set_forces(0, kScale * forces);
    if (const simulator::StepReport report = simulation.step(); !report.is_accepted) {
        throw Error("a beam found no equilibrium: " + report.failure);
    }
    const Positions<Dim> moved = simulation.positions(0) - beam.positions;
    return forces.cwiseProduct(moved).sum() / kScale / reference_work<Dim>(poisson, load);
}

#define PENT_INSTANTIATE(Dim)                      \
    template BodyForce<Dim> body_force<Dim>(Load); \
    template SimplexMesh<Dim> beam<Dim>(int, Cut); \
    template double give<Dim>(const SimplexMesh<Dim>&, simulator::ElementKind, double, Load);
PENT_INSTANTIATE(3)
PENT_INSTANTIATE(4)
#undef PENT_INSTANTIATE

}  // namespace pent::locking
