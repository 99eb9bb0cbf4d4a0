#include "trajectory.h"

#include <pent/error.h>
#include <pent/pent_file.h>
#include <pent/run_files.h>
#include <pent/simulator/placed_mesh.h>
#include <pent/with_dimension.h>

#include <Eigen/LU>

#include <algorithm>

namespace pent::study {

namespace {

StepRecord record_of(const simulator::StepReport& report) {
    const simulator::ContactSummary& contact = report.contact;
    StepRecord step;
    step.time = report.time;
    step.internal = report.energies.kinetic + report.energies.of("elastic");
    step.contact_energy = report.energies.of("obstacle") + report.energies.of("contact");
    step.total = report.energies.total();
    step.has_contact = contact.point_facet > 0 || contact.mixed > 0 || contact.obstacle > 0;
    step.penetration = contact.deepest;
    step.iterations = report.iterations;
    step.newton_iterations = report.newton_iterations;
    step.refused = report.refused;
    return step;
}

template <int Dim>
double cell_measure(const Eigen::MatrixXd& positions,
                    const Eigen::Matrix<std::uint32_t, -1, -1>& cells,
                    Eigen::Index cell) {
    Eigen::Matrix<double, Dim, Dim + 1> corners;
    for (int corner = 0; corner <= Dim; ++corner) {
        corners.col(corner) = positions.col(cells(corner, cell));
    }
    return simplex_volume<Dim>(corners);
}

// Positions before they were put in place.
template <int Dim>
Eigen::MatrixXd unplaced(const Eigen::MatrixXd& positions, const simulator::Placement& placement) {
    SimplexMesh<Dim> ends;  // of the axes, and the origin
    ends.positions.setZero(Dim, Dim + 1);
    ends.positions.template leftCols<Dim>().setIdentity();
    simulator::put_in_place<Dim>(ends, placement);
    const Eigen::Vector<double, Dim> origin = ends.positions.col(Dim);
    const Eigen::Matrix<double, Dim, Dim> axes =
        ends.positions.template leftCols<Dim>().colwise() - origin;
    return axes.inverse() * (positions.colwise() - origin);
}

}  // namespace

std::optional<runs::RunVerdict> verdict_of(const std::filesystem::path& folder) {
    const std::filesystem::path path = folder / kReportFile;
    return std::filesystem::exists(path) ? std::optional(runs::read_report(path).verdict)
                                         : std::nullopt;
}

Trajectory::Trajectory(const simulator::Scene& scene, std::filesystem::path folder)
    : folder_(std::move(folder)), dimension_(scene.dimension), frames_(scene.frames) {
    for (const simulator::Body& body : scene.bodies) {
        bodies_.push_back(body.name);
    }
    with_dimension(dimension_, [&](auto dim) { read_meshes<dim>(scene); });
    for (const simulator::StepReport& step : runs::read_report(folder_ / kReportFile).steps) {
        steps_.push_back(record_of(step));
    }
}

template <int Dim>
void Trajectory::read_meshes(const simulator::Scene& scene) {
    std::vector<SimplexMesh<Dim>> meshes;
    for (const std::string& body : bodies_) {
        meshes.push_back(read_mesh<Dim>(folder_ / mesh_file(body)).mesh);
        first_vertex_.push_back(first_vertex_.back() + meshes.back().vertex_count());
        first_cell_.push_back(first_cell_.back() + meshes.back().cell_count());
    }
    rest_.resize(Dim, first_vertex_.back());
    masses_.setZero(first_vertex_.back());
    cells_.resize(Dim + 1, first_cell_.back());
    volumes_.resize(first_cell_.back());
    Eigen::Index cell = 0;
    for (std::size_t body = 0; body < meshes.size(); ++body) {
        const SimplexMesh<Dim>& mesh = meshes[body];
        rest_.middleCols(first_vertex_[body], mesh.vertex_count()) =
            unplaced<Dim>(mesh.positions, scene.bodies[body].place);
        const std::vector<std::uint16_t> materials =
            simulator::materials_of_cells(mesh, scene.bodies[body]);
        for (Eigen::Index c = 0; c < mesh.cell_count(); ++c, ++cell) {
            volumes_[cell] = cell_volume<Dim>(mesh.positions, mesh.cells, c);
            const double density =
                material_of(scene.bodies[body], materials[static_cast<std::size_t>(c)]).density;
            const double share = density / (Dim + 1);
            for (int corner = 0; corner <= Dim; ++corner) {
                const Eigen::Index vertex = first_vertex_[body] + mesh.cells(corner, c);
                cells_(corner, cell) = static_cast<std::uint32_t>(vertex);
                masses_[vertex] += share * volumes_[cell];
            }
        }
    }
}

template <int Dim>
void Trajectory::read_moment(int frame, Moment& moment) const {
    for (std::size_t body = 0; body < bodies_.size(); ++body) {
        const std::filesystem::path path = folder_ / frame_file(bodies_[body], frame);
        const Frame<Dim> file = read_frame<Dim>(path);
        const Eigen::Index first = first_vertex_[body];
        const Eigen::Index count = first_vertex_[body + 1] - first;
        if (file.positions.cols() != count || file.velocities.cols() != count) {
            throw Error(path.string() + ": has " + std::to_string(file.positions.cols())
                        + " vertices; expected " + std::to_string(count) + " with velocities");
        }
        moment.positions.middleCols(first, count) = file.positions;
        moment.velocities.middleCols(first, count) = file.velocities;
    }
}

Moment Trajectory::moment(int frame) const {
    Moment moment;
    moment.positions.resize(dimension_, rest_.cols());
    moment.velocities.resize(dimension_, rest_.cols());
    with_dimension(dimension_, [&](auto dim) { read_moment<dim>(frame, moment); });
    return moment;
}

double Trajectory::smallest_J(const Eigen::MatrixXd& positions) const {
    return with_dimension(dimension_, [&](auto dim) {
        double smallest = std::numeric_limits<double>::infinity();
        for (Eigen::Index cell = 0; cell < cells_.cols(); ++cell) {
            smallest =
                std::min(smallest, cell_measure<dim>(positions, cells_, cell) / volumes_[cell]);
        }
        return smallest;
    });
}

}  // namespace pent::study
