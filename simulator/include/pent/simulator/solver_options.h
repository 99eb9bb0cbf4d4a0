#pragma once

namespace pent::simulator {

enum class Integrator { LinearEuler };

/// What becomes of the negative eigenvalues of element Hessians.
enum class Filter { Clamp, Absolute, None };

enum class PreconditionerKind { BlockJacobi };

/// Scalar of the matrix blocks; vectors are always double.
enum class Precision { Float, Double };

struct SolverOptions {
    Integrator integrator = Integrator::LinearEuler;
    Filter filter = Filter::Clamp;
    PreconditionerKind preconditioner = PreconditionerKind::BlockJacobi;
    Precision precision = Precision::Float;
    double tolerance = 1e-4;    ///< |b - A x| / |b| at which the linear solve stops, in (0, 1).
    int max_iterations = 3000;  ///< Of one linear solve, > 0.
    int max_halvings = 6;       ///< How often a failed step may be cut in two, 0..20.
};

}  // namespace pent::simulator
