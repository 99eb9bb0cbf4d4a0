#include "generators.h"

#include <pent/counted.h>
#include <pent/error.h>
#include <pent/formatted.h>
#include <pent/mesher/links.h>
#include <pent/mesher/prove.h>
#include <pent/mesher/quality.h>
#include <pent/mesher/tetrahedralize.h>

#include <cmath>
#include <string>
#include <vector>

namespace pent::mesher {

namespace {

constexpr double kFlattest = 1e-4;  // mean ratio

void check(const TetrahedraOptions& options) {
    if (!(options.radius_edge_ratio > 1)) {
        throw Error("a radius-edge ratio of " + std::to_string(options.radius_edge_ratio)
                    + "; expected above 1");
    }
    if (!(options.edge_length >= 0) || !std::isfinite(options.edge_length)) {
        throw Error("an edge length of " + std::to_string(options.edge_length)
                    + " m; expected 0 or more");
    }
}

void accept(Tetrahedra& tetrahedra, double expected, double largest_error) {
    const SimplexMesh<3>& mesh = tetrahedra.mesh;
    const double found = mesh.cell_count() > 0 ? total_volume(mesh) : 0;
    tetrahedra.volume_error = std::abs(found - expected) / std::abs(expected);
    if (!(tetrahedra.volume_error < largest_error)) {
        throw Error(
            tetrahedra.generator
            + formatted(" filled %.6g m^3 of %.6g m^3 that the surface encloses", found, expected));
    }
    validate(mesh, tetrahedra.generator);
    const Proof proof = prove(mesh);
    if (!proof.holds()) {
        throw Error(tetrahedra.generator + " is not sound: " + describe_faults(proof, 3));
    }
    if (const LinkReport links = check_links(mesh); links.faulty > 0) {
        throw Error(tetrahedra.generator + " touches itself at "
                    + counted(links.faulty, "point", "points"));
    }
    const double flattest = measure_quality(mesh).mean_ratio.min;
    if (flattest < kFlattest) {
        throw Error(tetrahedra.generator
                    + formatted(" left a tetrahedron of mean ratio %.1e", flattest));
    }
}

Tetrahedra fill(const Surface& surface, const TetrahedraOptions& options, double expected) {
    const bool is_mesh3 = options.generator == Generator::Mesh3;
    Tetrahedra tetrahedra =
        is_mesh3 ? fill_with_mesh3(surface, options) : fill_with_tetgen(surface, options);
    // TetGen keeps the surface, Mesh_3 approximates it.
    accept(tetrahedra, expected, is_mesh3 ? 0.05 : 1e-6);
    return tetrahedra;
}

std::vector<TetrahedraOptions> attempts(const TetrahedraOptions& options) {
    if (options.generator != Generator::Auto) {
        return {options};
    }
    TetrahedraOptions kept = options;
    kept.generator = Generator::TetGen;
    TetrahedraOptions subdivided = kept;
    subdivided.keep_surface = false;
    TetrahedraOptions approximated = options;
    approximated.generator = Generator::Mesh3;
    return options.keep_surface ? std::vector{kept, subdivided, approximated}
                                : std::vector{subdivided, approximated};
}

}  // namespace

Tetrahedra tetrahedralize(const Surface& surface, const TetrahedraOptions& options) {
    check(options);
    const double expected = enclosed_volume(surface);
    std::string failures;
    if (!(expected > 0)) {
        throw Error("the surface encloses " + std::to_string(expected)
                    + " m^3; expected a closed one, oriented outward");
    }
    for (const TetrahedraOptions& attempt : attempts(options)) {
        try {
            Tetrahedra tetrahedra = fill(surface, attempt, expected);
            tetrahedra.failures = failures;
            return tetrahedra;
        } catch (const Error& error) {
            failures += (failures.empty() ? "" : "; ") + std::string(error.what());
        }
    }
    throw Error(failures);
}

}  // namespace pent::mesher
