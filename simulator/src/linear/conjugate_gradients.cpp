#include "linear/conjugate_gradients.h"

#include <pent/dimensions.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

namespace pent::simulator {

namespace {

constexpr Eigen::Index kChunkColumns = 512;

// Iterations before an alternative is considered.
constexpr int kPatience = 8;
constexpr double kNever = std::numeric_limits<double>::infinity();

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

// a . b over the first `rows` columns; those behind are ghosts.
template <int Dim>
double dot(const Workers& workers,
           Eigen::Index rows,
           const BlockVector<Dim>& a,
           const BlockVector<Dim>& b) {
    return sum_chunks(workers, rows, [&](Eigen::Index begin, Eigen::Index count) {
        return a.middleCols(begin, count).cwiseProduct(b.middleCols(begin, count)).sum();
    });
}

// r = b - r, where r holds A x; returns |r|^2.
template <int Dim>
double residual(const Workers& workers,
                Eigen::Index rows,
                const BlockVector<Dim>& b,
                BlockVector<Dim>& r) {
    return sum_chunks(workers, rows, [&](Eigen::Index begin, Eigen::Index count) {
        auto part = r.middleCols(begin, count);
        part = b.middleCols(begin, count) - part;
        return part.squaredNorm();
    });
}

// Sum of weight * |r|^2 over the columns of r.
template <int Dim>
double weighed_square(const Workers& workers,
                      const Eigen::VectorXd& weights,
                      const BlockVector<Dim>& r) {
    return sum_chunks(workers, weights.size(), [&](Eigen::Index begin, Eigen::Index count) {
        return r.middleCols(begin, count)
            .colwise()
            .squaredNorm()
            .dot(weights.segment(begin, count));
    });
}

// r -= alpha q; returns |r|^2.
template <int Dim>
double advance(const Workers& workers,
               Eigen::Index rows,
               double alpha,
               const BlockVector<Dim>& q,
               BlockVector<Dim>& r) {
    return sum_chunks(workers, rows, [&](Eigen::Index begin, Eigen::Index count) {
        auto part = r.middleCols(begin, count);
        part -= alpha * q.middleCols(begin, count);
        return part.squaredNorm();
    });
}

// x *= factor, and r = b - A x for the new x, given that for the old one; returns |r|^2.
template <int Dim>
double scale(const Workers& workers,
             Eigen::Index rows,
             double factor,
             const BlockVector<Dim>& b,
             BlockVector<Dim>& r,
             BlockVector<Dim>& x) {
    return sum_chunks(workers, rows, [&](Eigen::Index begin, Eigen::Index count) {
        x.middleCols(begin, count) *= factor;
        auto part = r.middleCols(begin, count);
        part = (1 - factor) * b.middleCols(begin, count) + factor * part;
        return part.squaredNorm();
    });
}

// x += alpha p, then p = z + beta p, in one pass over memory.
template <int Dim>
void follow_and_turn(const Workers& workers,
                     Eigen::Index rows,
                     double alpha,
                     double beta,
                     const BlockVector<Dim>& z,
                     BlockVector<Dim>& p,
                     BlockVector<Dim>& x) {
    workers.for_each(chunk_count(rows), [&](int chunk) {
        const Eigen::Index begin = chunk * kChunkColumns;
        const Eigen::Index count = std::min(kChunkColumns, rows - begin);
        auto part = p.middleCols(begin, count);
        x.middleCols(begin, count) += alpha * part;
        part = z.middleCols(begin, count) + beta * part;
    });
}

// Whether at the rate of the last iterations more are left than the alternative costs. The rate is
// that of half as many as it costs; while few have been made, proportionally more have to be left.
//
// @param left   The relative residual at the start, and after each iteration.
// @param worth  The cost of the alternative, in iterations.
bool is_slow(const std::vector<double>& left, double enough, double worth) {
    const std::size_t spent = left.size() - 1;
    const auto last = static_cast<std::size_t>(
        std::min(static_cast<double>(spent), std::max(0.5 * kPatience, 0.5 * worth)));
    const double rate = std::log(left[spent - last] / left[spent]) / static_cast<double>(last);
    const double most = worth * std::max(1.0, worth / static_cast<double>(spent));
    return std::log(left[spent] / enough) > most * rate;
}

}  // namespace

template <int Dim>
template <typename Scalar>
LinearSolution<Dim> ConjugateGradients<Dim>::solve(const BlockMatrix<Dim, Scalar>& A,
                                                   const Preconditioner<Dim>& preconditioner,
                                                   const BlockVector<Dim>& b,
                                                   const LinearSolveOptions& options,
                                                   BlockVector<Dim> guess,
                                                   const Halo& halo,
                                                   const Alternative& alternative) {
    halo_ = halo;
    LinearSolution<Dim> solution{std::move(guess), {}};
    LinearSolveReport& report = solution.report;
    weights_ = options.weights;
    b_norms_ = {std::sqrt(halo_.sum(dot(*workers_, A.rows(), b, b)))};
    for (const Eigen::VectorXd& weights : weights_) {
        b_norms_.push_back(std::sqrt(halo_.sum(weighed_square(*workers_, weights, b))));
    }
    if (b_norms_.front() == 0) {
        solution.x.setZero();
        report.has_converged = true;
        return solution;
    }
    for (BlockVector<Dim>* vector : {&r_, &z_, &p_, &q_}) {
        vector->resize(Dim, b.cols());
    }
    double left = find_residual(A, b, solution.x);
    if (left > options.tolerance) {
        left = scale_guess(A.rows(), b, solution.x);
    }
    if (left > options.tolerance && preconditioner.correct(*workers_, r_, solution.x)) {
        left = find_residual(A, b, solution.x);
    }
    constexpr int kMaxStarts = 5;
    for (int start = 0;; ++start) {
        report.residual = left;
        report.has_converged = left <= options.tolerance;
        if (report.has_converged || !std::isfinite(left) || start == kMaxStarts
            || report.iterations >= options.max_iterations || report.has_broken_down
            || report.is_slow) {
            return solution;
        }
        // A little below the tolerance, so that the true residual meets it at the first check.
        iterate(A, preconditioner, options, 0.95 * options.tolerance, alternative, solution);
        left = find_residual(A, b, solution.x);
    }
}

template <int Dim>
double ConjugateGradients<Dim>::scale_guess(Eigen::Index rows,
                                            const BlockVector<Dim>& b,
                                            BlockVector<Dim>& x) {
    const double work = halo_.sum(dot(*workers_, rows, b, x));
    const double curvature = work - halo_.sum(dot(*workers_, rows, r_, x));
    const double factor = curvature > 0 ? work / curvature : 0;
    x.rightCols(x.cols() - rows) *= factor;  // ghosts
    return relative_residual(scale(*workers_, rows, factor, b, r_, x));
}

template <int Dim>
template <typename Scalar>
double ConjugateGradients<Dim>::find_residual(const BlockMatrix<Dim, Scalar>& A,
                                              const BlockVector<Dim>& b,
                                              BlockVector<Dim>& x) {
    halo_.update(x);
    A.multiply(*workers_, *kernels_, x, r_);
    return relative_residual(residual(*workers_, A.rows(), b, r_));
}

template <int Dim>
double ConjugateGradients<Dim>::relative_residual(double r_square) const {
    double most = std::sqrt(halo_.sum(r_square)) / b_norms_[0];
    for (std::size_t i = 0; i < weights_.size(); ++i) {
        const double left = std::sqrt(halo_.sum(weighed_square(*workers_, weights_[i], r_)));
        most = std::max(most, left / b_norms_[i + 1]);
    }
    return most;
}

template <int Dim>
template <typename Scalar>
void ConjugateGradients<Dim>::iterate(const BlockMatrix<Dim, Scalar>& A,
                                      const Preconditioner<Dim>& preconditioner,
                                      const LinearSolveOptions& options,
                                      double enough,
                                      const Alternative& alternative,
                                      LinearSolution<Dim>& solution) {
    LinearSolveReport& report = solution.report;
    const Eigen::Index rows = A.rows();
    p_.setZero();
    double left = kNever;
    std::vector<double> all_left = {report.residual};
    double rz_before = 1;
    double step = 0;  // along p; x takes it in the next pass of follow_and_turn()
    double worth = kNever;
    for (int spent = 0; left > enough && report.iterations < options.max_iterations; ++spent) {
        if (spent == kPatience && alternative) {
            worth = alternative();
        }
        if (worth < kNever && is_slow(all_left, enough, worth)) {
            report.is_slow = true;
            break;
        }
        const double rz = halo_.sum(preconditioner.apply(*workers_, r_, z_));
        follow_and_turn(*workers_, rows, step, rz / rz_before, z_, p_, solution.x);
        halo_.update(p_);
        A.multiply(*workers_, *kernels_, p_, q_);
        const double curvature = halo_.sum(dot(*workers_, rows, p_, q_));
        if (!(curvature > 0) || !std::isfinite(curvature) || !(rz > 0)) {
            report.has_broken_down = true;
            return;
        }
        step = rz / curvature;
        left = relative_residual(advance(*workers_, rows, step, q_, r_));
        all_left.push_back(left);
        rz_before = rz;
        ++report.iterations;
    }
    follow_and_turn(*workers_, rows, step, 0, z_, p_, solution.x);  // the last step; p is done
}

#define PENT_INSTANTIATE(Dim, Scalar)                                                         \
    template LinearSolution<Dim> ConjugateGradients<Dim>::solve(                              \
        const BlockMatrix<Dim, Scalar>&, const Preconditioner<Dim>&, const BlockVector<Dim>&, \
        const LinearSolveOptions&, BlockVector<Dim>, const Halo&, const Alternative&);
PENT_FOR_EACH_DIMENSION(PENT_INSTANTIATE, float)
PENT_FOR_EACH_DIMENSION(PENT_INSTANTIATE, double)
#undef PENT_INSTANTIATE

}  // namespace pent::simulator
