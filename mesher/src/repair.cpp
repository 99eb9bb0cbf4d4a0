#include "isolated.h"
#include "repair_steps.h"
#include "size_limits.h"

#include <pent/error.h>
#include <pent/formatted.h>
#include <pent/mesher/repair.h>

#include <Eigen/Eigenvalues>

#include <cmath>
#include <string>
#include <utility>

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

template <typename Step>
Surface isolated(const char* name, const StepLimits& limits, Step step) {
    Pieces<3> pieces = run_isolated<3>(name, limits, [&]() -> Pieces<3> {
        Surface result = step();
        return {std::move(result.points), std::move(result.triangles)};
    });
    return {std::move(pieces.points), std::move(pieces.cells)};
}

// A step that fails leaves the surface as it was.
template <typename Step>
Surface attempt(const Surface& surface,
                const char* name,
                const RepairOptions& options,
                std::string& failures,
                Step step) {
    try {
        return isolated(name, options.limits, [&] { return step(surface); });
    } catch (const Error& error) {
        failures += (failures.empty() ? "" : "; ") + std::string(error.what());
        return surface;
    }
}

Surface without_holes(const Surface& surface, const RepairOptions& options, std::string& failures) {
    return attempt(surface, "filling holes", options, failures,
                   [](const Surface& open) { return close_holes(drop_useless_triangles(open)); });
}

Repaired try_light(const Surface& surface,
                   const Surface& closed,
                   const RepairOptions& options,
                   const SurfaceReport& report,
                   std::string& failures) {
    const SurfaceReport left = check_surface(closed);
    if (is_usable(left)) {
        return mended(surface, closed, Repair::Light, report);
    }
    if (left.duplicate.count > 0) {
        // A triangle that hung on the surface by an edge or a point was closed by its other side:
        // both go.
        Repaired without_fins =
            mended(surface, drop_useless_triangles(closed), Repair::Light, report);
        if (is_usable(without_fins.after)) {
            return without_fins;
        }
    }
    if (left.components > 1 && left.border_edges.count == 0) {
        Repaired united = mended(surface,
                                 attempt(closed, "uniting bodies that cross", options, failures,
                                         unite_crossing_components),
                                 Repair::Light, report);
        if (is_usable(united.after)) {
            return united;
        }
    }
    return mended(surface,
                  attempt(closed, "cutting out self-intersections", options, failures,
                          cut_self_intersections),
                  Repair::Light, report);
}

// CGAL wants each point of a wrap at the offset from the surface to 1% of it; far from the origin
// there may be no such point, and what it says then is of no help.
Surface wrap_outside(const Surface& closed, double alpha, double offset, const StepLimits& limits) {
    try {
        return isolated("the wrap", limits, [&] { return wrap(closed, alpha, offset); });
    } catch (const Error&) {
        const double farthest = closed.points.cwiseAbs().maxCoeff();
        const double spacing = std::nextafter(farthest, 2 * farthest) - farthest;
        if (spacing <= 0.01 * offset) {
            throw;
        }
        throw Error(
            formatted("a wrap %.2g m around the surface cannot be made %.2g m from the"
                      " origin, where coordinates are %.2g m apart; move the surface nearer"
                      " to the origin",
                      offset, farthest, spacing));
    }
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
            mended(closed, wrap_outside(closed, alpha * size, alpha * size / 20, options.limits),
                   Repair::Wrap, report);
        if (is_usable(repaired.after) && repaired.distance <= options.wrap_distance * size) {
            return repaired;
        }
    }
    // GCOVR_EXCL_START: behind wraps that take a minute
    throw Error("no wrap within " + std::to_string(options.wrap_distance)
                + " of the diagonal was found around the surface; allow a larger distance"
                      " (--wrap-distance)");
    // GCOVR_EXCL_STOP
}

}  // namespace

Repaired repair(const Surface& surface, const RepairOptions& options) {
    require_usual_size<3>(surface.points, "the surface");
    if (is_flat(surface.points)) {
        throw Error(
            "all points of the surface lie in a plane; it encloses no volume (with one z for all,"
            " --dim 3 extrudes it along z)");
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
        throw Error("not the boundary of a body: " + describe(report)
                    + "; let it be mended (--repair auto)");
    }
    std::string failures;
    const Surface closed = without_holes(surface, options, failures);
    if (closed.triangle_count() == 0) {
        throw Error("no triangle of the surface has an area; it encloses no volume");
    }
    if (options.repair != Repair::Wrap) {
        Repaired light = try_light(surface, closed, options, report, failures);
        light.failures = failures;
        if (is_usable(light.after)) {
            return light;
        }
        if (options.repair == Repair::Light) {
            throw Error("light mending is not enough: " + describe(light.after)
                        + (failures.empty() ? "" : "; " + failures)
                        + "; before: " + describe(report)
                        + "; try a wrap, a new surface around it (--repair wrap, or auto), or mend"
                          " it by hand");
        }
    }
    Repaired wrapped = try_wrap(closed, options, report);
    wrapped.failures = failures;
    return wrapped;
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
            break;
    }
    return "auto";
}

}  // namespace pent::mesher
