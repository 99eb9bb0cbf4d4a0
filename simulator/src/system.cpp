#include "system.h"

#include "direct_solver.h"

#include <pent/error.h>

#include <algorithm>
#include <chrono>
#include <limits>
#include <numeric>

namespace pent::simulator {

namespace {

constexpr Eigen::Index kChunkVertices = 1024;
constexpr Eigen::Index kChunkCells = 1024;

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
                // GCOVR_EXCL_START: a machine that has all of them
                throw Error("the instruction set " + name + " is not supported by this machine; "
                            + std::string(isa_name(best_isa())) + " is");
                // GCOVR_EXCL_STOP
            }
            return isa;
        }
    }
    throw Error("the instruction set \"" + name
                + "\" is not known; expected scalar, baseline, avx2 or avx512");
}

// The columns of the free vertices, in the order of their unknowns.
template <int Dim>
BlockVector<Dim> at_unknowns(const Numbering& numbering, const Positions<Dim>& vertices) {
    BlockVector<Dim> unknowns(Dim, numbering.free_count());
    for (std::uint32_t unknown = 0; unknown < numbering.free_count(); ++unknown) {
        unknowns.col(unknown) = vertices.col(numbering.vertex_of_unknown[unknown]);
    }
    return unknowns;
}

struct PointEnergies {
    double kinetic = 0;
    double gravity = 0;

    PointEnergies& operator+=(const PointEnergies& other) {
        kinetic += other.kinetic;
        gravity += other.gravity;
        return *this;
    }
};

}  // namespace

template <int Dim>
System<Dim>::System(const Scene& scene, const World<Dim>& world, const SimulationOptions& options)
    : world_(&world),
      options_(scene.solver),
      gravity_(scene.gravity),
      damping_(scene.damping.value_or(Damping{})),
      workers_(workers_of(options)),
      isa_(choose_isa(options.isa)),
      kernels_(&kernels<Dim>(isa_)),
      layout_(lay_out(world.numbering)),
      contacts_(scene, world),
      on_move_(options.on_move) {
    const std::uint32_t unknowns = world.numbering.free_count();
    if (options_.linear == LinearSolver::Direct && unknowns > kMostDirectVertices) {
        throw Error("solver.linear = \"direct\" takes at most "
                    + std::to_string(kMostDirectVertices) + " free vertices; this scene has "
                    + std::to_string(unknowns) + ": use \"cg\"");
    }
    set_up_solver();
}

template <int Dim>
ElementLayout<Dim> System<Dim>::lay_out(const Numbering& numbering) const {
    return lay_out_elements<Dim>(world_->rest, world_->cells, world_->ranges, numbering,
                                 options_.elements);
}

template <int Dim>
void System<Dim>::set_up_solver() {
    const Numbering& numbering = world_->numbering;
    const std::uint32_t unknowns = numbering.free_count();
    if (options_.preconditioner == PreconditionerKind::BlockJacobi) {
        column_start_.resize(unknowns + 1);
        std::iota(column_start_.begin(), column_start_.end(), 0U);
    } else {
        column_start_ = numbering.column_start;
    }
    if (options_.linear == LinearSolver::Iterative
        && options_.preconditioner == PreconditionerKind::RigidModes) {
        std::vector<std::uint32_t> bodies(unknowns);
        for (std::uint32_t unknown = 0; unknown < unknowns; ++unknown) {
            const auto after =
                std::upper_bound(world_->first_vertex.begin(), world_->first_vertex.end(),
                                 numbering.vertex_of_unknown[unknown]);
            bodies[unknown] = static_cast<std::uint32_t>(after - world_->first_vertex.begin());
        }
        aggregates_ = make_aggregates<Dim>(at_unknowns(numbering, world_->rest), bodies);
    }
    float_matrix_.reset();
    double_matrix_.reset();
    if (options_.precision == Precision::Float) {
        float_matrix_ = std::make_unique<BlockMatrix<Dim, float>>(layout_.pattern);
    } else {
        double_matrix_ = std::make_unique<BlockMatrix<Dim, double>>(layout_.pattern);
    }
}

template <int Dim>
void System<Dim>::renumber(const std::vector<bool>& asleep, const Positions<Dim>& positions) {
    damping_tangent_.reset();
    frozen_ = {};
    if (std::find(asleep.begin(), asleep.end(), true) != asleep.end()) {
        layout_ = lay_out(number_bodies(*world_, asleep));
        frozen_.forces.setZero(Dim, positions.cols());
        frozen_.energy =
            layout_.elements.add_forces(workers_, *kernels_, positions, frozen_.forces);
    }
    layout_ = lay_out(world_->numbering);
    set_up_solver();
}

template <int Dim>
void System<Dim>::evaluate(BodyState<Dim>& state) {
    const Eigen::Index vertices = world_->vertex_count();
    const auto chunks = static_cast<int>((vertices + kChunkVertices - 1) / kChunkVertices);
    state.forces.resize(Dim, vertices);
    const PointEnergies points = workers_.sum(chunks, [&](int chunk) {
        PointEnergies sum;
        const Eigen::Index begin = chunk * kChunkVertices;
        const Eigen::Index end = std::min(begin + kChunkVertices, vertices);
        for (Eigen::Index v = begin; v < end; ++v) {
            const double mass = world_->masses[v];
            sum.kinetic += 0.5 * mass * state.velocities.col(v).squaredNorm();
            sum.gravity -= mass * gravity_.dot(state.positions.col(v));
            state.forces.col(v) = mass * gravity_;
        }
        return sum;
    });
    const RunEnergy elastic =
        layout_.elements.add_forces(workers_, *kernels_, state.positions, state.forces);
    if (frozen_.forces.cols() > 0) {
        state.forces += frozen_.forces;
    }
    state.energies = {.kinetic = points.kinetic,
                      .elastic = elastic.energy + frozen_.energy.energy,
                      .gravity = points.gravity};
    state.inverted = elastic.inverted + frozen_.energy.inverted;
    state.collapsed = elastic.collapsed + frozen_.energy.collapsed;
    find_contacts(state);
}

template <int Dim>
std::int64_t System<Dim>::count_inverted(const BodyState<Dim>& state) const {
    if (options_.elements == ElementKind::Linear) {
        return state.inverted;
    }
    const Simplices<Dim + 1>& cells = world_->cells;
    const auto chunks = static_cast<int>((cells.cols() + kChunkCells - 1) / kChunkCells);
    return workers_.sum(chunks, [&](int chunk) {
        const Eigen::Index begin = chunk * kChunkCells;
        const Eigen::Index end = std::min(begin + kChunkCells, cells.cols());
        std::int64_t inverted = 0;
        for (Eigen::Index cell = begin; cell < end; ++cell) {
            inverted += cell_volume<Dim>(state.positions, cells, cell) > 0 ? 0 : 1;
        }
        return inverted;
    });
}

template <int Dim>
void System<Dim>::find_contacts(BodyState<Dim>& state) {
    if (contacts_.is_empty()) {
        return;
    }
    const Stopwatch watch;
    auto found =
        std::make_shared<const ContactState<Dim>>(contacts_.find(workers_, state.positions));
    found->add_forces(state.forces);
    state.energies.contact = found->energy;
    state.energies.obstacle = found->obstacle_energy;
    state.energies.friction = found->friction.energy;
    contact_work_ += found->summary;
    contact_work_.seconds += watch.seconds();
    state.contacts = std::move(found);
}

template <int Dim>
void System<Dim>::begin_step(BodyState<Dim>& now, bool is_linear, double h) {
    if (!now.contacts || !contacts_.has_friction()) {
        return;
    }
    contacts_.begin_step(*now.contacts, now.positions, is_linear ? &now.velocities : nullptr, h);
    evaluate(now);
}

template <int Dim>
contact::StepLimit System<Dim>::limit_step(const Positions<Dim>& from, const Positions<Dim>& to) {
    contact::StepLimit limit = contacts_.limit_step(workers_, from, to);
    contact_work_.seconds += limit.seconds;
    contact_work_.ccd_seconds += limit.seconds;
    return limit;
}

template <int Dim>
void System<Dim>::set_barrier_stiffness(double stiffness, BodyState<Dim>& state) {
    if (stiffness != contacts_.stiffness()) {
        contacts_.set_stiffness(stiffness);
        evaluate(state);
    }
}

// Whether factor times the masses would drown in the rounding of the stiffness that the matrix holds. In a
// free body the stiffness cancels for rigid motions, and the rounding that is left takes the place of
// inertia: at most 1e-2 of it here, as rounding is not all of one sign.
template <int Dim>
template <typename Scalar>
bool System<Dim>::has_lost_inertia(const BlockMatrix<Dim, Scalar>& matrix, double factor) const {
    if (factor == 0) {
        return false;  // statics
    }
    constexpr double kMostRatio =
        1e-2 / static_cast<double>(std::numeric_limits<Scalar>::epsilon());
    const auto rows = static_cast<std::int64_t>(world_->numbering.free_count());
    const auto chunks = static_cast<int>((rows + kChunkVertices - 1) / kChunkVertices);
    return workers_.sum(chunks, [&](int chunk) {
        const std::int64_t begin = chunk * kChunkVertices;
        const std::int64_t end = std::min<std::int64_t>(begin + kChunkVertices, rows);
        int lost = 0;
        for (std::int64_t row = begin; row < end; ++row) {
            const std::uint32_t vertex =
                world_->numbering.vertex_of_unknown[static_cast<std::size_t>(row)];
            const double stiffness = static_cast<double>(matrix.diagonal(row).trace()) / Dim;
            lost += stiffness > kMostRatio * factor * world_->masses[vertex] ? 1 : 0;
        }
        return lost;
    }) > 0;
}

template <int Dim>
template <typename Scalar>
void System<Dim>::add_masses(BlockMatrix<Dim, Scalar>& matrix, double factor) const {
    matrix.for_each_row_chunk(workers_, [&](std::int64_t begin, std::int64_t end) {
        for (std::int64_t row = begin; row < end; ++row) {
            const std::uint32_t vertex =
                world_->numbering.vertex_of_unknown[static_cast<std::size_t>(row)];
            matrix.diagonal(row).diagonal().array() +=
                static_cast<Scalar>(factor * world_->masses[vertex]);
        }
    });
}

template <int Dim>
template <typename Scalar>
std::unique_ptr<CouplingMatrix<Dim, Scalar>> System<Dim>::add_contacts(
    const BodyState<Dim>& state, LinearStep<Dim>& step, BlockMatrix<Dim, Scalar>& matrix) {
    if (!state.contacts) {
        return nullptr;
    }
    const Stopwatch watch;
    const ContactTerms<Dim> terms{
        *state.contacts, contacts_.has_barrier()
                             ? contacts_.hessians(workers_, *state.contacts, state.positions)
                             : std::vector<LocalHessian<Dim>>()};
    auto coupling = add_contact_hessian(workers_, world_->numbering, terms, step.contact_factor,
                                        step.held_shift, matrix, step.right);
    contact_work_.seconds += watch.seconds();
    return coupling;
}

template <int Dim>
template <typename Scalar>
std::unique_ptr<Preconditioner<Dim>> System<Dim>::precondition(
    const BlockMatrix<Dim, Scalar>& matrix, const Positions<Dim>& positions) const {
    std::unique_ptr<Preconditioner<Dim>> smoother = column_jacobi(workers_, matrix, column_start_);
    if (options_.preconditioner != PreconditionerKind::RigidModes) {
        return smoother;
    }
    return with_rigid_modes(workers_, matrix, aggregates_,
                            at_unknowns(world_->numbering, positions), std::move(smoother));
}

template <int Dim>
template <typename Scalar>
LinearSolveReport System<Dim>::iterate(const BlockMatrix<Dim, Scalar>& matrix,
                                       const Positions<Dim>& positions,
                                       const LinearStep<Dim>& step,
                                       BlockVector<Dim>& dx) {
    const std::unique_ptr<Preconditioner<Dim>> preconditioner = precondition(matrix, positions);
    return pent::simulator::solve(workers_, *kernels_, matrix, *preconditioner, step.right,
                                  {.tolerance = std::max(step.tolerance, options_.tolerance),
                                   .max_iterations = options_.max_iterations},
                                  space_, dx);
}

template <int Dim>
template <typename Scalar>
LinearSolveReport System<Dim>::solve_with(BlockMatrix<Dim, Scalar>& matrix,
                                          const BodyState<Dim>& state,
                                          Filter filter,
                                          LinearStep<Dim> step,
                                          BlockVector<Dim>& dx,
                                          StepReport& report) {
    const Stopwatch assembly;
    matrix.set_zero(workers_);
    report.filtered +=
        layout_.elements.add_hessian(workers_, *kernels_, state.positions, step.elastic_factor,
                                     filter, step.held_shift, matrix, step.right);
    if (has_lost_inertia(matrix, step.mass_factor)) {
        LinearSolveReport lost;
        lost.has_lost_inertia = true;
        return lost;
    }
    add_masses(matrix, step.mass_factor);
    if (step.damping_factor > 0) {
        matrix.add_scaled(workers_, step.damping_factor, *damping_tangent_);
    }
    report.hessians += layout_.elements.count();
    report.unknowns += Dim * matrix.rows();
    report.assembly_seconds += assembly.seconds();
    const std::unique_ptr<CouplingMatrix<Dim, Scalar>> coupling = add_contacts(state, step, matrix);
    matrix.set_coupling(coupling ? &coupling->matrix : nullptr);
    const Stopwatch solution;
    const LinearSolveReport solved = options_.linear == LinearSolver::Direct
                                         ? solve_directly(matrix, step.right, dx)
                                         : iterate(matrix, state.positions, step, dx);
    matrix.set_coupling(nullptr);
    report.solve_seconds += solution.seconds();
    report.iterations += solved.iterations;
    report.residual = std::max(report.residual, solved.residual);
    return solved;
}

template <int Dim>
LinearSolveReport System<Dim>::solve(const BodyState<Dim>& state,
                                     LinearStep<Dim>& step,
                                     BlockVector<Dim>& dx,
                                     StepReport& report) {
    if (dx.cols() == 0) {  // all bodies sleep
        LinearSolveReport nothing;
        nothing.has_converged = true;
        return nothing;
    }
    const auto solve_filtered = [&](Filter filter) {
        if (float_matrix_) {
            const LinearSolveReport solved =
                solve_with(*float_matrix_, state, filter, step, dx, report);
            if (!solved.has_lost_inertia) {
                return solved;
            }
            if (!double_matrix_) {
                double_matrix_ = std::make_unique<BlockMatrix<Dim, double>>(layout_.pattern);
            }
        }
        return solve_with(*double_matrix_, state, filter, step, dx, report);
    };
    const BlockVector<Dim> guess = dx;
    LinearSolveReport solved = solve_filtered(options_.filter);
    if (solved.has_broken_down && options_.filter != Filter::Clamp) {
        dx = guess;
        solved = solve_filtered(Filter::Clamp);
    }
    return solved;
}

template <int Dim>
void System<Dim>::set_damping_tangent(const Positions<Dim>& positions,
                                      const Positions<Dim>& held_travel,
                                      StepReport& report) {
    if (!damping_tangent_) {
        damping_tangent_ = std::make_unique<BlockMatrix<Dim, double>>(layout_.pattern);
    }
    damping_tangent_->set_zero(workers_);
    held_damping_.setZero(Dim, layout_.pattern.rows());
    layout_.elements.add_hessian(workers_, *kernels_, positions, 1, options_.filter, held_travel,
                                 *damping_tangent_, held_damping_);
    held_damping_ = -held_damping_;
    report.damping_hessians += layout_.elements.count();
}

template <int Dim>
BlockVector<Dim> System<Dim>::damping_product(const BlockVector<Dim>& travel) const {
    BlockVector<Dim> product(Dim, travel.cols());
    damping_tangent_->multiply(workers_, *kernels_, travel, product);
    return product;
}

template <int Dim>
SimulationSize System<Dim>::size() const {
    SimulationSize size;
    size.vertices = world_->vertex_count();
    size.cells = world_->cells.cols();
    size.free_vertices = world_->numbering.free_count();
    size.elements = layout_.elements.count();
    size.matrix_blocks = layout_.pattern.blocks();
    // Where float has turned out too coarse there are both.
    const std::int64_t scalar =
        (float_matrix_ ? sizeof(float) : 0) + (double_matrix_ ? sizeof(double) : 0);
    constexpr std::int64_t kEntries = std::int64_t{Dim} * Dim;
    const std::int64_t block = kEntries * scalar + static_cast<std::int64_t>(sizeof(std::uint32_t));
    const std::int64_t tangent_block =
        damping_tangent_ ? kEntries * static_cast<std::int64_t>(sizeof(double)) : 0;
    // Per vertex: positions, velocities, forces and their copies; per unknown: the solver's.
    constexpr std::int64_t kVertexVectors = 8;
    constexpr std::int64_t kUnknownVectors = 6;
    size.element_bytes = layout_.elements.bytes();
    size.matrix_bytes = size.matrix_blocks * block;
    size.contact_bytes = contacts_.bytes();
    size.bytes = size.element_bytes + size.contact_bytes + size.matrix_bytes
                 + size.matrix_blocks * tangent_block
                 + static_cast<std::int64_t>(sizeof(double)) * Dim
                       * (kVertexVectors * size.vertices + kUnknownVectors * size.free_vertices);
    return size;
}

template class System<3>;
template class System<4>;

}  // namespace pent::simulator
