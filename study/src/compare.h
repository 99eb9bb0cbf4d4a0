#pragma once

#include "locate.h"
#include "trajectory.h"

#include <pent/study/study.h>

#include <Eigen/Core>

#include <vector>

namespace pent::study {

/// How long after the first contact trajectories still have to agree, s: beyond, differences grow
/// whatever the steps, and only statistics converge.
inline constexpr double kAfterContact = 0.2;

/// The end of the window in which positions are compared, s; and whether there is contact at all.
struct Window {
    double end = 0;
    bool has_contact = false;
};
[[nodiscard]] Window window_of(const Trajectory& reference, double frames_per_second);

/// Mass-weighted RMS distance of corresponding vertices of two moments, m.
[[nodiscard]] double rms_distance(const Eigen::MatrixXd& a,
                                  const Eigen::MatrixXd& b,
                                  const Eigen::VectorXd& masses);

/// Angular momentum about the center of mass in each plane, xy, xz, (xw,) yz, ..., kg m^2/s.
[[nodiscard]] Eigen::VectorXd angular_momentum(const Moment& moment, const Eigen::VectorXd& masses);

/// Work done against contacts and obstacles, J: the sum of all rises of the energy in them. What
/// friction takes is not part of it.
[[nodiscard]] double contact_work(const std::vector<StepRecord>& steps);

/// Everything of Errors. Both runs have the same frames; the meshes may differ, and `where` then
/// says where in the reference the vertices of the run are.
[[nodiscard]] Errors compare(const Trajectory& run,
                             const Trajectory& reference,
                             const Interpolation& where,
                             const Window& window,
                             double frames_per_second);

/// Observed order p and the estimated error of the finest of three levels, each with half the dt of
/// the one before, from their differences coarse - middle and middle - fine.
///
///     p = log2(coarse / fine),  error bar = fine / (2^p - 1)      [roache1994]
///
/// Not converged if p < 0.5; the error bar is then the difference itself. Differences of zero (a
/// motion every dt has exactly) are converged, with an error bar of 0.
struct Convergence {
    double order = 0;
    double error_bar = 0;
    bool is_converged = false;
};
[[nodiscard]] Convergence convergence_of(double coarse, double fine);

}  // namespace pent::study
