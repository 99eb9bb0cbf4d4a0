#include "repair_steps.h"
#include "silent_cgal.h"

#include <pent/error.h>
#include <pent/mesher/repair.h>

#include <Eigen/Eigenvalues>

#include <exception>

namespace pent::mesher {

namespace {

// Thinner than the rounding of its coordinates: there is nothing inside.
bool is_flat(const Positions<3>& points) {
    const Positions<3> arms = points.colwise() - points.rowwise().mean();
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(arms * arms.transpose());
    const Eigen::Vector3d normal = solver.eigenvectors().col(0);
    const Eigen::VectorXd heights = arms.transpose() * normal;
    return heights.maxCoeff() - heights.minCoeff() <= 1e-12 * diagonal(points);
}

bool is_usable(const SurfaceReport& report) {
    return report.is_clean() && report.triangles >= 4;
}

Repaired mended(const Surface& surface, Surface result, Repair used, SurfaceReport before) {
    Repaired repaired;
    repaired.used = used;
    repaired.before = before;
    repaired.after = check_surface(result);
    repaired.surface = std::move(result);
    if (is_usable(repaired.after)) {
        repaired.distance = distance_between(repaired.surface, surface);
    }
    return repaired;
}

// CGAL throws on some surfaces that break its assumptions; that is one more way not to succeed, and
// leaves the surface as it was.
template <typename Step>
Surface attempt(const Surface& surface, Step step) {
    const SilentCgal silent;
    try {
        return step(surface);
    } catch (const std::exception&) {
        return surface;
    }
}

Surface without_holes(const Surface& surface) {
    return attempt(surface,
                   [](const Surface& open) { return close_holes(drop_useless_triangles(open)); });
}

Repaired try_light(const Surface& surface,
                   const Surface& closed,
                   const RepairOptions& options,
                   const SurfaceReport& report) {
    if (is_usable(check_surface(closed))) {
        return mended(surface, closed, Repair::Light, report);
    }
    Surface cut = attempt(closed, [&](const Surface& crossing) {
        return cut_self_intersections(crossing, options.seconds);
    });
    return mended(surface, std::move(cut), Repair::Light, report);
}

// Finer and finer, until the wrap is close enough to the surface without its holes: through a hole
// that is left open a fine wrap would creep inside, and make a hollow shell of the body.
Repaired try_wrap(const Surface& closed,
                  const RepairOptions& options,
                  const SurfaceReport& report) {
    const double size = diagonal(closed.points);
    constexpr double kCoarsest = 1.0 / 25;
    constexpr double kFinest = 1.0 / 400;
    for (double alpha = kCoarsest; alpha >= kFinest; alpha /= 2) {
        Repaired repaired =
            mended(closed, wrap(closed, alpha * size, alpha * size / 20), Repair::Wrap, report);
        if (is_usable(repaired.after) && repaired.distance <= options.wrap_distance * size) {
            return repaired;
        }
    }
    throw Error("no wrap within " + std::to_string(options.wrap_distance)
                + " of the diagonal was found around the surface; allow a larger distance");
}

}  // namespace

Repaired repair(const Surface& surface, const RepairOptions& options) {
    if (is_flat(surface.points)) {
        throw Error("all points of the surface lie in a plane; it encloses no volume");
    }
    const SurfaceReport report = check_surface(surface);
    if (is_usable(report) && options.repair != Repair::Wrap) {
        Repaired unchanged;
        unchanged.surface = surface;
        unchanged.before = report;
        unchanged.after = report;
        return unchanged;
    }
    if (options.repair == Repair::None) {
        throw Error("not the boundary of a body: " + describe(report) + "; let it be mended");
    }
    const Surface closed = without_holes(surface);
    if (options.repair != Repair::Wrap) {
        Repaired light = try_light(surface, closed, options, report);
        if (is_usable(light.after)) {
            return light;
        }
        if (options.repair == Repair::Light) {
            throw Error("light mending is not enough: " + describe(light.after)
                        + "; before: " + describe(report) + "; allow a wrap");
        }
    }
    return try_wrap(closed, options, report);
}

std::string name_of(Repair repair) {
    switch (repair) {
        case Repair::None:
            return "none";
        case Repair::Light:
            return "light";
        case Repair::Wrap:
            return "wrap";
        case Repair::Auto:
            return "auto";
    }
    return "";
}

}  // namespace pent::mesher
