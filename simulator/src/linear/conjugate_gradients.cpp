#include "linear/conjugate_gradients.h"

#include <cmath>

namespace pent::simulator {

namespace {

constexpr Eigen::Index kChunkColumns = 512;

int chunk_count(Eigen::Index columns) {
    return static_cast<int>((columns + kChunkColumns - 1) / kChunkColumns);
}

// Sum over chunks of columns of work(begin, count).
template <typename Work>
double sum_chunks(const Workers& workers, Eigen::Index columns, const Work& work) {
    return workers.sum(chunk_count(columns), [&](int chunk) -> double {
        const Eigen::Index begin = chunk * kChunkColumns;
        return work(begin, std::min(kChunkColumns, columns - begin));
    });
}

template <int Dim>
double dot(const Workers& workers, const BlockVector<Dim>& a, const BlockVector<Dim>& b) {
    return sum_chunks(workers, a.cols(), [&](Eigen::Index begin, Eigen::Index count) {
        return a.middleCols(begin, count).cwiseProduct(b.middleCols(begin, count)).sum();
    });
}

// r = b - r, where r holds A x; returns |r|^2.
template <int Dim>
double residual(const Workers& workers, const BlockVector<Dim>& b, BlockVector<Dim>& r) {
    return sum_chunks(workers, b.cols(), [&](Eigen::Index begin, Eigen::Index count) {
        auto part = r.middleCols(begin, count);
        part = b.middleCols(begin, count) - part;
        return part.squaredNorm();
    });
}

// x += alpha p, r -= alpha q; returns |r|^2.
template <int Dim>
double advance(const Workers& workers,
               double alpha,
               const LinearSolveSpace<Dim>& space,
               BlockVector<Dim>& r,
               BlockVector<Dim>& x) {
    return sum_chunks(workers, x.cols(), [&](Eigen::Index begin, Eigen::Index count) {
        x.middleCols(begin, count) += alpha * space.p.middleCols(begin, count);
        auto part = r.middleCols(begin, count);
        part -= alpha * space.q.middleCols(begin, count);
        return part.squaredNorm();
    });
}

// p = z + beta p.
template <int Dim>
void redirect(const Workers& workers, double beta, LinearSolveSpace<Dim>& space) {
    workers.for_each(chunk_count(space.p.cols()), [&](int chunk) {
        const Eigen::Index begin = chunk * kChunkColumns;
        const Eigen::Index count = std::min(kChunkColumns, space.p.cols() - begin);
        auto part = space.p.middleCols(begin, count);
        part = space.z.middleCols(begin, count) + beta * part;
    });
}

}  // namespace

template <int Dim, typename Scalar>
LinearSolveReport conjugate_gradients(const Workers& workers,
                                      const BlockKernels& kernels,
                                      const BlockMatrix<Dim, Scalar>& A,
                                      const Preconditioner<Dim>& preconditioner,
                                      const BlockVector<Dim>& b,
                                      const LinearSolveOptions& options,
                                      LinearSolveSpace<Dim>& space,
                                      BlockVector<Dim>& x) {
    LinearSolveReport report;
    const double b_norm = std::sqrt(dot(workers, b, b));
    if (b_norm == 0) {
        x.setZero();
        report.has_converged = true;
        return report;
    }
    for (BlockVector<Dim>* vector : {&space.r, &space.z, &space.p, &space.q}) {
        vector->resize(Dim, x.cols());
    }
    A.multiply(workers, kernels, x, space.r);
    double r_norm = std::sqrt(residual(workers, b, space.r));
    if (r_norm > options.tolerance * b_norm && preconditioner.correct(workers, space.r, x)) {
        A.multiply(workers, kernels, x, space.r);
        r_norm = std::sqrt(residual(workers, b, space.r));
    }
    constexpr int kMaxStarts = 5;
    for (int start = 0; start < kMaxStarts; ++start) {
        if (start > 0) {
            A.multiply(workers, kernels, x, space.r);
            r_norm = std::sqrt(residual(workers, b, space.r));
        }
        report.residual = r_norm / b_norm;
        report.has_converged = report.residual <= options.tolerance;
        if (report.has_converged || !std::isfinite(r_norm)
            || report.iterations >= options.max_iterations || report.has_broken_down) {
            return report;
        }
        space.p.setZero();
        double rz_before = 1;
        // A little below the tolerance, so that the true residual meets it at the first check.
        while (r_norm > 0.95 * options.tolerance * b_norm
               && report.iterations < options.max_iterations) {
            preconditioner.apply(workers, space.r, space.z);
            const double rz = dot(workers, space.r, space.z);
            redirect(workers, rz / rz_before, space);
            A.multiply(workers, kernels, space.p, space.q);
            const double curvature = dot(workers, space.p, space.q);
            if (!(curvature > 0) || !std::isfinite(curvature) || !(rz > 0)) {
                report.has_broken_down = true;
                break;
            }
            r_norm = std::sqrt(advance(workers, rz / curvature, space, space.r, x));
            rz_before = rz;
            ++report.iterations;
        }
    }
    A.multiply(workers, kernels, x, space.r);
    report.residual = std::sqrt(residual(workers, b, space.r)) / b_norm;
    report.has_converged = report.residual <= options.tolerance;
    return report;
}

#define PENT_INSTANTIATE(Dim, Scalar)                                                   \
    template LinearSolveReport conjugate_gradients<Dim, Scalar>(                        \
        const Workers&, const BlockKernels&, const BlockMatrix<Dim, Scalar>&,           \
        const Preconditioner<Dim>&, const BlockVector<Dim>&, const LinearSolveOptions&, \
        LinearSolveSpace<Dim>&, BlockVector<Dim>&);
PENT_INSTANTIATE(3, float)
PENT_INSTANTIATE(3, double)
PENT_INSTANTIATE(4, float)
PENT_INSTANTIATE(4, double)
#undef PENT_INSTANTIATE

}  // namespace pent::simulator
