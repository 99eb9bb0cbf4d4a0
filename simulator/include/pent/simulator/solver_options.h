#pragma once

#include <pent/contact/filter.h>
#include <pent/simulator/words.h>

#include <array>

namespace pent::simulator {

/// How a time step is taken; docs/simulator.md compares them.
enum class Integrator {
    LinearEuler,  ///< One linear solve a step: fast, first order.
    NewtonEuler,  ///< Backward Euler to a tolerance, with line search: robust, first order.
    Bdf2,         ///< Two-step backward differences to a tolerance: second order.
    Quasistatic,  ///< Equilibrium at every step, no inertia; every body must be held.
};
template <>
inline constexpr std::array kWords<Integrator> = {
    Word<Integrator>{Integrator::LinearEuler, "linear_euler"},
    Word<Integrator>{Integrator::NewtonEuler, "newton_euler"},
    Word<Integrator>{Integrator::Bdf2, "bdf2"},
    Word<Integrator>{Integrator::Quasistatic, "quasistatic"},
};

/// What the energy of a body is the sum over; docs/simulator.md compares them.
enum class ElementKind {
    Linear,     ///< The cells of its mesh: fast, too stiff in bending where few cells are across.
    Smoothed,   ///< Neighborhoods of edges, by the mean of their cells: for what bends.
    Quadratic,  ///< Quadratic simplices, of which the cells are children: does not lock.
};
template <>
inline constexpr std::array kWords<ElementKind> = {
    Word<ElementKind>{ElementKind::Linear, "linear"},
    Word<ElementKind>{ElementKind::Smoothed, "smoothed"},
    Word<ElementKind>{ElementKind::Quadratic, "quadratic"},
};

/// What becomes of the negative eigenvalues of Hessians, of elements as of contacts.
using contact::Filter;
template <>
inline constexpr std::array kWords<Filter> = {
    Word<Filter>{Filter::Clamp, "clamp"},
    Word<Filter>{Filter::Absolute, "absolute"},
    Word<Filter>{Filter::None, "none"},
};

/// Conjugate gradients; sparse Cholesky, the reference, for scenes that fit into memory.
enum class LinearSolverKind { Iterative, Direct };
template <>
inline constexpr std::array kWords<LinearSolverKind> = {
    Word<LinearSolverKind>{LinearSolverKind::Iterative, "cg"},
    Word<LinearSolverKind>{LinearSolverKind::Direct, "direct"},
};

/// Block Jacobi; line Jacobi by extrusion columns; the latter with aggregation multigrid by rigid
/// modes.
enum class PreconditionerKind { BlockJacobi, ColumnJacobi, RigidModes };
template <>
inline constexpr std::array kWords<PreconditionerKind> = {
    Word<PreconditionerKind>{PreconditionerKind::BlockJacobi, "block-jacobi"},
    Word<PreconditionerKind>{PreconditionerKind::ColumnJacobi, "column-jacobi"},
    Word<PreconditionerKind>{PreconditionerKind::RigidModes, "rigid-modes"},
};

/// In which matrix blocks are stored; vectors are always double.
enum class Precision { Float, Double };
template <>
inline constexpr std::array kWords<Precision> = {
    Word<Precision>{Precision::Float, "float"},
    Word<Precision>{Precision::Double, "double"},
};

struct SolverOptions {
    Integrator integrator = Integrator::LinearEuler;
    ElementKind elements = ElementKind::Linear;
    Filter filter = Filter::Clamp;
    LinearSolverKind linear = LinearSolverKind::Iterative;
    PreconditionerKind preconditioner = PreconditionerKind::RigidModes;
    Precision precision = Precision::Float;
    double tolerance = 1e-4;  ///< |b - A x| / |b| at which the linear solve stops, in (0, 1); with
                              ///< several materials also for forces over the local stiffness, and
                              ///< over the local density.
    double newton_tolerance =
        1e-4;                   ///< Unbalanced force at the end of a step over that at its start,
                                ///< as for tolerance, in (0, 1); not for LinearEuler.
    int max_iterations = 3000;  ///< Of one linear solve, > 0.
    int max_halvings = 6;       ///< How often a failed step may be cut in two, 0..20.
};

}  // namespace pent::simulator
