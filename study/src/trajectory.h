#pragma once

#include <pent/runs/report.h>
#include <pent/simulator/scene.h>

#include <Eigen/Core>

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace pent::study {

/// What report.json says of one step, as far as a study needs it.
struct StepRecord {
    double time = 0;            ///< At its end, s.
    double internal = 0;        ///< Kinetic and elastic energy, J.
    double total = 0;           ///< All energies, J.
    double contact_energy = 0;  ///< Stored in contacts with bodies and obstacles, J.
    bool has_contact = false;
    double penetration = 0;  ///< Deepest, m.
    std::int64_t iterations = 0;
    std::int64_t newton_iterations = 0;
    std::int64_t refused = 0;
};

/// One moment of a run; Dim x vertices of all bodies, one body after the other.
struct Moment {
    Eigen::MatrixXd positions;   ///< m.
    Eigen::MatrixXd velocities;  ///< m/s.
};

/// A run in a folder, read frame by frame: its frames are far larger than anything else.
class Trajectory {
public:
    /// @param scene  Of the run; gives dimension, names and densities of the bodies.
    ///
    /// Throws an Error if the folder has no report or a mesh cannot be read.
    Trajectory(const simulator::Scene& scene, std::filesystem::path folder);

    [[nodiscard]] int dimension() const { return dimension_; }
    [[nodiscard]] int frames() const { return frames_; }  ///< After frame 0.

    /// Vertices at rest as the mesh files have them, wherever the bodies are placed, m.
    [[nodiscard]] const Eigen::MatrixXd& rest() const { return rest_; }

    [[nodiscard]] const Eigen::VectorXd& masses() const { return masses_; }  ///< Lumped, kg.
    [[nodiscard]] const std::vector<StepRecord>& steps() const { return steps_; }
    [[nodiscard]] std::int64_t cell_count() const { return cells_.cols(); }

    /// Corners of every cell, (dimension + 1) x cells, counted through all bodies.
    [[nodiscard]] const Eigen::Matrix<std::uint32_t, -1, -1>& cells() const { return cells_; }

    /// The first vertex of each body, and the number of vertices.
    [[nodiscard]] const std::vector<Eigen::Index>& first_vertex() const { return first_vertex_; }

    /// The first cell of each body, and the number of cells.
    [[nodiscard]] const std::vector<Eigen::Index>& first_cell() const { return first_cell_; }

    /// Throws an Error if the frame cannot be read.
    [[nodiscard]] Moment moment(int frame) const;

    /// Smallest det F of any cell at these positions.
    [[nodiscard]] double smallest_J(const Eigen::MatrixXd& positions) const;

private:
    template <int Dim>
    void read_meshes(const simulator::Scene& scene);
    template <int Dim>
    void read_moment(int frame, Moment& moment) const;

    std::filesystem::path folder_;
    int dimension_ = 4;
    int frames_ = 0;
    std::vector<std::string> bodies_;
    std::vector<Eigen::Index> first_vertex_ = {0};
    std::vector<Eigen::Index> first_cell_ = {0};
    Eigen::MatrixXd rest_;
    Eigen::VectorXd masses_;
    Eigen::VectorXd volumes_;
    Eigen::Matrix<std::uint32_t, -1, -1> cells_;
    std::vector<StepRecord> steps_;
};

/// The verdict of a run; nothing if there is no report of one.
[[nodiscard]] std::optional<runs::RunVerdict> verdict_of(const std::filesystem::path& folder);

}  // namespace pent::study
