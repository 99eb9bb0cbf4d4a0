#include "bisection.h"
#include "boundary_labels.h"
#include "moving_fields.h"
#include "time_layers.h"

#include <pent/error.h>
#include <pent/formatted.h>
#include <pent/mesher/space_time.h>
#include <pent/mesher/straight_layers.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

namespace pent::mesher {

namespace {

void check(const MovingMesh& moving, const SpaceTimeOptions& options) {
    if (!(options.time_scale > 0) || !std::isfinite(options.time_scale)) {
        throw Error(formatted("a time scale of %g m/s; expected a finite number above 0",
                              options.time_scale));
    }
    if (options.refine_time < 0) {
        throw Error("steps cut in " + std::to_string(options.refine_time)
                    + " layers; expected 1 or more, or 0 for as many as it takes");
    }
    if (moving.frame_count() < 2) {
        throw Error("a moving mesh of one frame; a space-time mesh needs two or more");
    }
}

std::vector<std::uint32_t> ranks_of(const SimplexMesh<3>& base, const SpaceTimeOptions& options) {
    std::vector<std::uint32_t> ranks = rank_vertices<3>(base, options.order);
    if (options.order == VertexOrder::Quality) {
        // As of a body at rest, with layers of the height that suits it.
        ranks = improve_ranks<3>(base, std::move(ranks),
                                 Eigen::Vector4d(0, 0, 0, 0.7 * mean_edge<3>(base)));
    }
    return ranks;
}

std::vector<std::uint32_t> ranks_by_color(const std::vector<std::uint8_t>& colors) {
    std::vector<std::uint32_t> order(colors.size());
    std::iota(order.begin(), order.end(), 0U);
    std::stable_sort(order.begin(), order.end(),
                     [&](std::uint32_t a, std::uint32_t b) { return colors[a] < colors[b]; });
    std::vector<std::uint32_t> ranks(order.size());
    for (std::size_t i = 0; i < order.size(); ++i) {
        ranks[order[i]] = static_cast<std::uint32_t>(i);
    }
    return ranks;
}

OrderedCells<3> ordered_by(const SimplexMesh<3>& base, const std::vector<std::uint32_t>& ranks) {
    return order_cells<3>(base, direct_edges<3>(base, ranks));
}

// Cells with their corners as they are bisected: those below first, each side by its rank, or
// against it in layers that take the reverse order. extrude() has the same but for the last two
// corners of every second one, which are exchanged so that all cells are positive.
Simplices<5> in_order_of_bisection(const SimplexMesh<4>& mesh,
                                   const std::vector<std::uint32_t>& ranks,
                                   bool alternate) {
    Simplices<5> cells = mesh.cells;
    for (auto cell : cells.colwise()) {
        const std::uint32_t below = std::min_element(cell.begin(), cell.end(), [&](auto a, auto b) {
            return mesh.layers[a] < mesh.layers[b];
        })[0];
        const bool is_reversed = alternate && mesh.layers[below] % 2 == 1;
        std::sort(cell.begin(), cell.end(), [&](std::uint32_t a, std::uint32_t b) {
            if (mesh.layers[a] != mesh.layers[b]) {
                return mesh.layers[a] < mesh.layers[b];
            }
            const std::uint32_t left = ranks[mesh.columns[a]];
            const std::uint32_t right = ranks[mesh.columns[b]];
            return is_reversed ? left > right : left < right;
        });
    }
    return cells;
}

// Three layers have every kind of neighbors that more of them have.
bool is_ready_for_bisection(const SimplexMesh<3>& base,
                            const std::vector<std::uint32_t>& ranks,
                            bool alternate) {
    const SimplexMesh<4> three =
        extrude<4>(base, ordered_by(base, ranks),
                   straight_layers<4>(Eigen::Vector4d(0, 0, 0, 3), 3), {.alternate = alternate});
    return bisection_faults(in_order_of_bisection(three, ranks, alternate)) == 0;
}

// Ranks under which bisection keeps cells conforming; may cut the mesh for that.
std::vector<std::uint32_t> make_bisection_ready(MovingMesh& moving,
                                                const SpaceTimeOptions& options,
                                                std::string& way) {
    std::vector<std::uint32_t> ranks = ranks_of(moving.base, options);
    way = "in the order of its vertices";
    if (is_ready_for_bisection(moving.base, ranks, options.alternate)) {
        return ranks;
    }
    if (const auto colors = color_vertices(moving.base)) {
        ranks = ranks_by_color(*colors);
        way = "by four colors of its vertices";
        if (is_ready_for_bisection(moving.base, ranks, options.alternate)) {
            return ranks;
        }
    }
    moving = barycentric_cut(moving);
    way = "after a barycentric cut, 24 tetrahedra of each";
    ranks.resize(static_cast<std::size_t>(moving.base.vertex_count()));
    std::iota(ranks.begin(), ranks.end(), 0U);
    if (!is_ready_for_bisection(moving.base, ranks, options.alternate)) {
        // GCOVR_EXCL_START: four colors always do; this is for mistakes of ours
        throw Error("the barycentric cut is not ready for bisection");
        // GCOVR_EXCL_STOP
    }
    return ranks;
}

std::vector<std::uint8_t> tags_of(const SimplexMesh<4>& mesh, const Simplices<5>& in_order) {
    std::vector<std::uint8_t> tags(static_cast<std::size_t>(mesh.cell_count()));
    for (Eigen::Index cell = 0; cell < mesh.cell_count(); ++cell) {
        tags[static_cast<std::size_t>(cell)] = mesh.cells(4, cell) == in_order(4, cell) ? 0 : 1;
    }
    return tags;
}

double w_of(const MovingMesh& moving, const TimeLayer& layer, double time_scale) {
    const double time = layer.share == 0 ? moving.times[layer.frame]
                                         : (1 - layer.share) * moving.times[layer.frame]
                                               + layer.share * moving.times[layer.frame + 1];
    return time_scale * time;
}

SimplexMesh<4> place_layers(const MovingMesh& moving,
                            const OrderedCells<3>& ordered,
                            const std::vector<TimeLayer>& layers,
                            const SpaceTimeOptions& options) {
    const auto count = static_cast<Eigen::Index>(layers.size());
    SimplexMesh<4> mesh =
        extrude<4>(moving.base, ordered,
                   straight_layers<4>(Eigen::Vector4d(0, 0, 0, 1), static_cast<int>(count - 1)),
                   {.alternate = options.alternate});
    for (Eigen::Index l = 0; l < count; ++l) {
        const TimeLayer& layer = layers[static_cast<std::size_t>(l)];
        const Positions<3> positions = positions_in(moving, layer);
        const double w = w_of(moving, layer, options.time_scale);
        for (Eigen::Index column = 0; column < positions.cols(); ++column) {
            mesh.positions.col(column * count + l) << positions.col(column), w;
        }
    }
    return mesh;
}

// Values in a layer, one or three numbers each; vectors get no part along w.
Eigen::MatrixXd values_in(const MovingField& field, const TimeLayer& layer) {
    Eigen::MatrixXd values = field.values[layer.frame];
    if (layer.share > 0) {
        values = (1 - layer.share) * values + layer.share * field.values[layer.frame + 1];
    }
    if (values.rows() == 3) {
        values.conservativeResize(4, Eigen::NoChange);
        values.row(3).setZero();
    }
    return values;
}

VertexField vertex_field(const MovingField& field, const std::vector<TimeLayer>& layers) {
    const auto count = static_cast<Eigen::Index>(layers.size());
    VertexField result{field.name, {}};
    for (Eigen::Index l = 0; l < count; ++l) {
        const Eigen::MatrixXd values = values_in(field, layers[static_cast<std::size_t>(l)]);
        if (l == 0) {
            result.values.resize(values.rows(), values.cols() * count);
        }
        for (Eigen::Index column = 0; column < values.cols(); ++column) {
            result.values.col(column * count + l) = values.col(column);
        }
    }
    return result;
}

constexpr Eigen::Index kPerPrism = 4;

// Over each tetrahedron the prisms of all layers follow one another.
VertexField cell_field(const MovingField& field, const std::vector<TimeLayer>& layers) {
    const auto slabs = static_cast<Eigen::Index>(layers.size()) - 1;
    VertexField result{field.name, {}};
    Eigen::MatrixXd below = values_in(field, layers.front());
    result.values.resize(below.rows(), below.cols() * slabs * kPerPrism);
    for (Eigen::Index slab = 0; slab < slabs; ++slab) {
        Eigen::MatrixXd above = values_in(field, layers[static_cast<std::size_t>(slab + 1)]);
        for (Eigen::Index cell = 0; cell < below.cols(); ++cell) {
            for (Eigen::Index k = 0; k < kPerPrism; ++k) {
                result.values.col((cell * slabs + slab) * kPerPrism + k) =
                    (below.col(cell) + above.col(cell)) / 2;
            }
        }
        below = std::move(above);
    }
    return result;
}

// Fibers run both ways: in each frame the one that is nearer to that of the frame before, so that
// the mean of two frames is the direction of both where one of them is turned around.
MovingField in_one_sense(MovingField fibers) {
    for (std::size_t frame = 1; frame < fibers.values.size(); ++frame) {
        const Eigen::MatrixXd& before = fibers.values[frame - 1];
        for (Eigen::Index cell = 0; cell < before.cols(); ++cell) {
            auto fiber = fibers.values[frame].col(cell);
            if (fiber.dot(before.col(cell)) < 0) {
                fiber *= -1;
            }
        }
    }
    return fibers;
}

void carry_fields(const MovingMesh& moving,
                  const std::vector<TimeLayer>& layers,
                  SpaceTimeBody& body) {
    for (const MovingField& field : moving.vertex_fields) {
        body.extras.vertex_fields.push_back(vertex_field(field, layers));
    }
    for (const MovingField& field : moving.cell_fields) {
        const bool is_fiber = is_fiber_name(field.name) && field.values.front().rows() == 3;
        if (is_fiber && body.mesh.fibers.cols() == 0) {
            body.mesh.fibers = cell_field(in_one_sense(field), layers).values;
        } else {
            body.extras.cell_fields.push_back(cell_field(field, layers));
        }
    }
}

double integral_over_w(const MovingMesh& moving, double time_scale) {
    double sum = 0;
    for (std::size_t frame = 0; frame + 1 < moving.frame_count(); ++frame) {
        double six_volume = 0;  // its mean over the step
        for (Eigen::Index cell = 0; cell < moving.base.cell_count(); ++cell) {
            Eigen::Matrix<double, 3, 4> from;
            Eigen::Matrix<double, 3, 4> to;
            for (int i = 0; i < 4; ++i) {
                from.col(i) = moving.positions[frame].col(moving.base.cells(i, cell));
                to.col(i) = moving.positions[frame + 1].col(moving.base.cells(i, cell));
            }
            const VolumePolynomial volume = volume_on_the_way(from, to);
            six_volume += (volume[0] + volume[1] + volume[2] + volume[3]) / 4;
        }
        sum += time_scale * (moving.times[frame + 1] - moving.times[frame]) * six_volume / 6;
    }
    return sum;
}

void measure_layers(const MovingMesh& moving,
                    const std::vector<TimeLayer>& layers,
                    const SpaceTimeOptions& options,
                    SpaceTimeBody& body) {
    body.lowest_layer = std::numeric_limits<double>::infinity();
    for (std::size_t l = 0; l < layers.size(); ++l) {
        if (layers[l].share == 0) {
            body.frame_layers.push_back(static_cast<std::uint32_t>(l));
        }
        if (l > 0) {
            const double height = w_of(moving, layers[l], options.time_scale)
                                  - w_of(moving, layers[l - 1], options.time_scale);
            body.lowest_layer = std::min(body.lowest_layer, height);
            body.highest_layer = std::max(body.highest_layer, height);
        }
    }
}

}  // namespace

SpaceTimeBody make_space_time(MovingMesh moving, const SpaceTimeOptions& options) {
    check(moving, options);
    const auto begin = [&](const char* stage) {
        if (options.on_stage) {
            options.on_stage(stage);
        }
    };
    SpaceTimeBody body;
    begin("order");
    const std::vector<std::uint32_t> ranks =
        options.is_bisection_ready ? make_bisection_ready(moving, options, body.way_of_bisection)
                                   : ranks_of(moving.base, options);
    const OrderedCells<3> ordered = ordered_by(moving.base, ranks);
    begin("layers");
    const std::vector<TimeLayer> layers = choose_layers(moving, ordered, options);
    if (options.on_size) {
        options.on_size(static_cast<double>(moving.base.cell_count() * kPerPrism)
                        * static_cast<double>(layers.size() - 1));
    }
    measure_layers(moving, layers, options, body);
    begin("extrude");
    body.mesh = place_layers(moving, ordered, layers, options);
    carry_fields(moving, layers, body);
    label_boundary(body.mesh, labels_of(moving), {}, body.extras);
    if (options.is_bisection_ready) {
        body.extras.bisection_tags =
            tags_of(body.mesh, in_order_of_bisection(body.mesh, ranks, options.alternate));
    }
    body.integral = integral_over_w(moving, options.time_scale);
    body.base_edge = mean_edge<3>(moving.base);
    begin("prove");
    validate(body.mesh, "the mesh that was made");
    body.proof = prove<4>(body.mesh);
    if (!body.proof.holds()) {
        throw Error("the mesh that was made is not sound: " + describe_faults(body.proof, 4)
                    + "; do the tetrahedra fit together?");
    }
    begin("quality");
    body.quality = measure_quality<4>(body.mesh);
    return body;
}

}  // namespace pent::mesher
