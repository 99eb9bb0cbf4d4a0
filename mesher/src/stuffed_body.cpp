#include "body_steps.h"
#include "check_request.h"
#include "solid_input.h"

#include <pent/error.h>
#include <pent/mesher/stuff.h>

#include <utility>

namespace pent::mesher {

namespace {

// The size field where the body is before it is moved.
SizeField before_translation(const BodyRequest& request) {
    SizeField sizes = request.sizes;
    if (request.translation.size() > 0) {
        Eigen::Vector4d way = Eigen::Vector4d::Zero();
        way.head(request.translation.size()) = request.translation;
        if (sizes.plane) {
            sizes.plane->offset -= sizes.plane->normal.dot(way);
        }
        if (sizes.point) {
            *sizes.point -= way;
        }
    }
    return sizes;
}

}  // namespace

Body<4> make_stuffed(const std::filesystem::path& path,
                     const BodyRequest& request,
                     StageClock& clock) {
    refuse_extrusion(request);
    check_solid_request(path, request);
    const SolidInput input = clock.time("read", [&] { return read_solid_input(path, request); });
    StuffedSolid stuffed;
    try {
        const SizeField sizes = before_translation(request);
        ExpectedSize size = expected_size<4>(
            estimate_cells(input.solid, request.edge_length, sizes), 1, 0, request);
        size.seconds += input.seconds_per_cell * size.cells;
        announce(request, size);
        stuffed =
            clock.time("stuff", [&] { return stuff(input.solid, request.edge_length, sizes); });
    } catch (const Error& error) {
        throw Error(path.string() + ": " + error.what());
    }
    if (input.labels) {
        stuffed.mesh.regions = label_regions(stuffed.mesh, *input.labels, request.scale);
    }
    BodyReport report;
    report.boundary = input.boundary;
    report.generator = "lattice stuffing";
    report.beveled = stuffed.beveled;
    report.thin_parts = stuffed.thin_parts;
    report.thin_parts.place.head(request.translation.size()) += request.translation;
    return finish<4>({std::move(stuffed.mesh), {}, std::move(report), {}}, 0, request, clock,
                     onto_boundary(input.solid));
}

}  // namespace pent::mesher
