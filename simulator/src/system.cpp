#include "system.h"

#include "obstacles.h"

#include <pent/error.h>

#include <chrono>

namespace pent::simulator {

namespace {

constexpr Eigen::Index kChunkVertices = 1024;

class Stopwatch {
public:
    [[nodiscard]] double seconds() const {
        return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
    }

private:
    std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

Isa choose_isa(const std::string& name) {
    if (name.empty()) {
        return best_isa();
    }
    for (const Isa isa : {Isa::Scalar, Isa::Baseline, Isa::Avx2, Isa::Avx512}) {
        if (name == isa_name(isa)) {
            if (!is_supported(isa)) {
                throw Error("the instruction set " + name + " is not supported by this machine; "
                            + std::string(isa_name(best_isa())) + " is");
            }
            return isa;
        }
    }
    throw Error("the instruction set \"" + name
                + "\" is not known; expected scalar, baseline, avx2 or avx512");
}

struct PointEnergies {
    double kinetic = 0;
    double gravity = 0;
    double obstacle = 0;

    PointEnergies& operator+=(const PointEnergies& other) {
        kinetic += other.kinetic;
        gravity += other.gravity;
        obstacle += other.obstacle;
        return *this;
    }
};

}  // namespace

template <int Dim>
System<Dim>::System(const Scene& scene, const World<Dim>& world, const SimulationOptions& options)
    : world_(&world),
      options_(scene.solver),
      gravity_(scene.gravity),
      obstacles_(scene.obstacles),
      workers_(options.threads),
      isa_(choose_isa(options.isa)),
      kernels_(&kernels<Dim>(isa_)),
      pattern_(make_pattern<Dim>(world.cells, world.numbering)),
      elements_(world.rest, world.cells, world.ranges, world.numbering, pattern_) {
    if (options_.precision == Precision::Float) {
        float_matrix_ = std::make_unique<BlockMatrix<Dim, float>>(pattern_);
    } else {
        double_matrix_ = std::make_unique<BlockMatrix<Dim, double>>(pattern_);
    }
}

template <int Dim>
void System<Dim>::evaluate(BodyState<Dim>& state) const {
    const Eigen::Index vertices = world_->vertex_count();
    const auto chunks = static_cast<int>((vertices + kChunkVertices - 1) / kChunkVertices);
    state.forces.resize(Dim, vertices);
    const PointEnergies points = workers_.sum(chunks, [&](int chunk) {
        PointEnergies sum;
        const Eigen::Index begin = chunk * kChunkVertices;
        const Eigen::Index end = std::min(begin + kChunkVertices, vertices);
        for (Eigen::Index v = begin; v < end; ++v) {
            const double mass = world_->masses[v];
            const Vector<Dim> position = state.positions.col(v);
            Vector<Dim> force = mass * gravity_;
            sum.kinetic += 0.5 * mass * state.velocities.col(v).squaredNorm();
            sum.gravity -= mass * gravity_.dot(position);
            for (const Obstacle& obstacle : obstacles_) {
                const ObstacleContact<Dim> contact = touch<Dim>(obstacle, position);
                force += contact.force;
                sum.obstacle += contact.energy;
            }
            state.forces.col(v) = force;
        }
        return sum;
    });
    const RunEnergy elastic =
        elements_.add_forces(workers_, *kernels_, state.positions, state.forces);
    state.energies = {.kinetic = points.kinetic,
                      .elastic = elastic.energy,
                      .gravity = points.gravity,
                      .obstacle = points.obstacle};
    state.inverted = elastic.inverted;
}

template <int Dim>
template <typename Scalar>
void System<Dim>::add_diagonal(BlockMatrix<Dim, Scalar>& matrix,
                               const Positions<Dim>& positions,
                               const LinearStep<Dim>& step) const {
    matrix.for_each_row_chunk(workers_, [&](std::int64_t begin, std::int64_t end) {
        for (std::int64_t row = begin; row < end; ++row) {
            const std::uint32_t vertex =
                world_->numbering.vertex_of_unknown[static_cast<std::size_t>(row)];
            Matrix<Dim> block = step.mass_factor * world_->masses[vertex] * Matrix<Dim>::Identity();
            for (const Obstacle& obstacle : obstacles_) {
                const ObstacleContact<Dim> contact = touch<Dim>(obstacle, positions.col(vertex));
                if (contact.is_active) {
                    const Vector<Dim> normal = obstacle.normal;
                    block +=
                        (step.stiffness_factor * contact.curvature) * normal * normal.transpose();
                }
            }
            matrix.diagonal(row) += block.template cast<Scalar>();
        }
    });
}

template <int Dim>
template <typename Scalar>
LinearSolveReport System<Dim>::solve_with(BlockMatrix<Dim, Scalar>& matrix,
                                          const Positions<Dim>& positions,
                                          LinearStep<Dim>& step,
                                          BlockVector<Dim>& dx,
                                          StepReport& report) {
    const Stopwatch assembly;
    matrix.set_zero(workers_);
    elements_.add_hessian(workers_, *kernels_, positions, step.stiffness_factor, options_.filter,
                          step.held_shift, matrix, step.right);
    add_diagonal(matrix, positions, step);
    report.assembly_seconds += assembly.seconds();
    const Stopwatch solution;
    const std::unique_ptr<Preconditioner<Dim>> preconditioner = block_jacobi(workers_, matrix);
    const LinearSolveReport solved = solve(
        workers_, *kernels_, matrix, *preconditioner, step.right,
        {.tolerance = options_.tolerance, .max_iterations = options_.max_iterations}, space_, dx);
    report.solve_seconds += solution.seconds();
    report.iterations += solved.iterations;
    report.residual = std::max(report.residual, solved.residual);
    return solved;
}

template <int Dim>
LinearSolveReport System<Dim>::solve_step(const Positions<Dim>& positions,
                                          LinearStep<Dim>& step,
                                          BlockVector<Dim>& dx,
                                          StepReport& report) {
    return float_matrix_ ? solve_with(*float_matrix_, positions, step, dx, report)
                         : solve_with(*double_matrix_, positions, step, dx, report);
}

template <int Dim>
SimulationSize System<Dim>::size() const {
    SimulationSize size;
    size.vertices = world_->vertex_count();
    size.cells = world_->cells.cols();
    size.free_vertices = world_->numbering.free_count();
    size.elements = elements_.count();
    size.matrix_blocks = pattern_.blocks();
    const std::int64_t scalar = float_matrix_ ? sizeof(float) : sizeof(double);
    const std::int64_t block =
        Dim * Dim * scalar + static_cast<std::int64_t>(sizeof(std::uint32_t));
    // Per vertex: positions, velocities, forces and their copies; per unknown: the solver's.
    constexpr std::int64_t kVertexVectors = 8;
    constexpr std::int64_t kUnknownVectors = 6;
    size.bytes = elements_.bytes() + size.matrix_blocks * block
                 + static_cast<std::int64_t>(sizeof(double)) * Dim
                       * (kVertexVectors * size.vertices + kUnknownVectors * size.free_vertices);
    return size;
}

template class System<3>;
template class System<4>;

}  // namespace pent::simulator
