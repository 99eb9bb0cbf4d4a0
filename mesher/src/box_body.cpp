#include "base_mesh.h"
#include "body_steps.h"
#include "check_request.h"
#include "size_limits.h"
#include "solid_input.h"

#include <pent/counted.h>
#include <pent/error.h>

#include <algorithm>
#include <array>
#include <functional>
#include <numeric>
#include <utility>

namespace pent::mesher {

template <int Dim>
Body<Dim> make_box(const BoxShape& shape, const BodyRequest& request, StageClock& clock) {
    refuse_extrusion(request);
    refuse_filling(request);
    refuse_image_options(request);
    if (shape.count.size() != Dim || shape.size.size() != Dim) {
        throw Error("a box of " + counted(shape.count.size(), "axis", "axes") + "; expected "
                    + std::to_string(Dim));
    }
    std::array<int, Dim> count{};
    std::array<double, Dim> size{};
    std::copy(shape.count.begin(), shape.count.end(), count.begin());
    std::copy(shape.size.begin(), shape.size.end(), size.begin());
    const double cubes =
        std::accumulate(count.begin(), count.end(), 1.0, std::multiplies<double>());
    const bool is_by_paths = shape.cut == CubeCut::Paths;
    const double per_cube = Dim == 4 ? (is_by_paths ? 24 : 16) : (is_by_paths ? 6 : 5);
    announce(request, expected_size<Dim>(cubes * per_cube, 1, 0, request));
    SimplexMesh<Dim> mesh = clock.time("cut", [&] { return box<Dim>(count, size, shape.cut); });
    const Eigen::Map<const Eigen::Matrix<double, Dim, 1>> extent(size.data());
    mesh.positions.colwise() -= extent / 2;
    require_usual_size<Dim>(mesh.positions, name_of_input(request) + ": the body");
    BodyReport report;
    report.generator = Dim == 4 ? "tesseracts" : "cubes";
    return finish<Dim>({std::move(mesh), {}, std::move(report), {}}, extent.prod(), request, clock);
}

template Body<3> make_box<3>(const BoxShape&, const BodyRequest&, StageClock&);
template Body<4> make_box<4>(const BoxShape&, const BodyRequest&, StageClock&);

}  // namespace pent::mesher
