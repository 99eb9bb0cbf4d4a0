#include "time_layers.h"

#include <pent/error.h>
#include <pent/formatted.h>
#include <pent/mesher/straight_layers.h>

#include <Eigen/Geometry>
#include <Eigen/LU>

#include <algorithm>

namespace pent::mesher {

namespace {

using Corners = Eigen::Matrix<double, 3, 4>;

double det3(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c) {
    return a.dot(b.cross(c));
}

// From s on, at depth halvings of the whole way.
std::optional<double> inversion_within(const VolumePolynomial& v, double s, int depth) {
    constexpr int kMaxDepth = 40;
    if (v[0] <= 0) {
        return s;
    }
    if (std::all_of(v.begin(), v.end(), [](double c) { return c > 0; })) {
        return std::nullopt;
    }
    const double length = std::ldexp(1.0, -depth);
    if (depth == kMaxDepth) {
        return s;
    }
    // De Casteljau at the middle.
    const double a = (v[0] + v[1]) / 2;
    const double b = (v[1] + v[2]) / 2;
    const double c = (v[2] + v[3]) / 2;
    const double ab = (a + b) / 2;
    const double bc = (b + c) / 2;
    const double middle = (ab + bc) / 2;
    if (const auto found = inversion_within({v[0], a, ab, middle}, s, depth + 1)) {
        return found;
    }
    return inversion_within({middle, bc, c, v[3]}, s + length / 2, depth + 1);
}

// The pentachora over a tetrahedron between two layers.
struct Prisms {
    Simplices<5> cells;  // four for each tetrahedron; vertex 2 c is below, 2 c + 1 above
};

// In a layer that begins as the base is ordered, or in the reverse order.
std::array<Prisms, 2> prisms_of(const SimplexMesh<3>& base,
                                const OrderedCells<3>& ordered,
                                bool alternate) {
    constexpr Eigen::Index kPerCell = 4;
    const SimplexMesh<4> two =
        extrude<4>(base, ordered, straight_layers<4>(Eigen::Vector4d(0, 0, 0, 2), 2, Anchor::Start),
                   {.alternate = alternate});
    std::array<Prisms, 2> prisms;
    for (std::size_t slab = 0; slab < 2; ++slab) {
        Simplices<5>& cells = prisms[slab].cells;
        cells.resize(5, kPerCell * base.cell_count());
        for (Eigen::Index i = 0; i < cells.cols(); ++i) {
            const Eigen::Index from = i / kPerCell * 2 * kPerCell
                                      + static_cast<Eigen::Index>(slab) * kPerCell + i % kPerCell;
            for (int k = 0; k < 5; ++k) {
                const std::uint32_t vertex = two.cells(k, from);
                cells(k, i) = vertex / 3 * 2 + (vertex % 3 - static_cast<std::uint32_t>(slab));
            }
        }
    }
    return prisms;
}

// The test of validate(), for one cell.
bool is_positive(const Eigen::Matrix<double, 4, 5>& corners) {
    constexpr double kDegenerate = 1e-14;
    const Eigen::Matrix4d edges = corners.rightCols<4>().colwise() - corners.col(0);
    return edges.determinant() > kDegenerate * edges.colwise().norm().prod();
}

class LayerChoice {
public:
    LayerChoice(const MovingMesh& moving,
                const OrderedCells<3>& ordered,
                const SpaceTimeOptions& options)
        : moving_(moving),
          options_(options),
          prisms_(prisms_of(moving.base, ordered, options.alternate)) {}

    std::vector<TimeLayer> choose() {
        for (std::size_t frame = 0; frame + 1 < moving_.frame_count(); ++frame) {
            if (options_.refine_time == 0) {
                add_halves(frame, 0, 0);
                continue;
            }
            const int parts = options_.refine_time;
            for (int i = 0; i < parts; ++i) {
                const double from = static_cast<double>(i) / parts;
                const double to = static_cast<double>(i + 1) / parts;
                if (const auto cell = failing_cell(frame, from, to)) {
                    refuse(frame, *cell, from, to);
                }
                layers_.push_back({frame, from});
            }
        }
        layers_.push_back({moving_.frame_count() - 1, 0});
        return layers_;
    }

private:
    // The part of the way from a frame to the next one that begins at `from` and is 2^-depth long.
    void add_halves(std::size_t frame, double from, int depth) {
        constexpr int kMaxDepth = 16;
        const double length = std::ldexp(1.0, -depth);
        const std::optional<Eigen::Index> cell = failing_cell(frame, from, from + length);
        if (!cell) {
            layers_.push_back({frame, from});
            return;
        }
        if (depth == 0) {
            refuse_inversions(frame);
        }
        if (depth == kMaxDepth) {
            refuse(frame, *cell, from, from + length);
        }
        add_halves(frame, from, depth + 1);
        add_halves(frame, from + length / 2, depth + 1);
    }

    // The first tetrahedron of which a pentachoron is not positive; nothing if all are.
    [[nodiscard]] std::optional<Eigen::Index> failing_cell(std::size_t frame,
                                                           double from,
                                                           double to) const {
        const bool is_odd = options_.alternate && layers_.size() % 2 == 1;
        const Simplices<5>& cells = prisms_[is_odd ? 1 : 0].cells;
        const Positions<3> below = positions_in(moving_, {frame, from});
        const Positions<3> above =
            positions_in(moving_, to < 1 ? TimeLayer{frame, to} : TimeLayer{frame + 1, 0});
        const double step = options_.time_scale * (time_at(frame, to) - time_at(frame, from));
        for (Eigen::Index cell = 0; cell < cells.cols(); ++cell) {
            Eigen::Matrix<double, 4, 5> corners;
            for (int k = 0; k < 5; ++k) {
                const std::uint32_t vertex = cells(k, cell);
                const bool is_above = vertex % 2 == 1;
                corners.col(k) << (is_above ? above : below).col(vertex / 2), (is_above ? step : 0);
            }
            if (!is_positive(corners)) {
                return cell / 4;
            }
        }
        return std::nullopt;
    }

    [[nodiscard]] double time_at(std::size_t frame, double share) const {
        return (1 - share) * moving_.times[frame] + share * moving_.times[frame + 1];
    }

    [[nodiscard]] VolumePolynomial volume_of(std::size_t frame, Eigen::Index cell) const {
        Corners from;
        Corners to;
        for (int i = 0; i < 4; ++i) {
            from.col(i) = moving_.positions[frame].col(moving_.base.cells(i, cell));
            to.col(i) = moving_.positions[frame + 1].col(moving_.base.cells(i, cell));
        }
        return volume_on_the_way(from, to);
    }

    [[nodiscard]] std::string name_of(Eigen::Index cell) const {
        return "cell " + std::to_string(moving_.cell_numbers[static_cast<std::size_t>(cell)]);
    }

    [[nodiscard]] std::string way_of(std::size_t frame) const {
        return moving_.frames[frame] + " to " + moving_.frames[frame + 1];
    }

    void refuse_inversions(std::size_t frame) const {
        for (Eigen::Index cell = 0; cell < moving_.base.cell_count(); ++cell) {
            refuse_inversion(frame, cell);
        }
    }

    // Throws if a tetrahedron does not stay positive on its way.
    void refuse_inversion(std::size_t frame, Eigen::Index cell) const {
        const VolumePolynomial volume = volume_of(frame, cell);
        for (const std::size_t end : {std::size_t{0}, std::size_t{1}}) {
            if (volume[3 * end] <= 0) {
                throw Error(moving_.frames[frame + end] + ": " + name_of(cell)
                            + formatted(" is inverted or flat at t = %g s",
                                        moving_.times[frame + end])
                            + "; every tetrahedron must be positive in every frame: mend the mesh,"
                              " or end the series before");
            }
        }
        const std::optional<double> s = first_inversion(volume);
        if (!s) {
            return;
        }
        const double time = time_at(frame, *s);
        throw Error(way_of(frame) + ": " + name_of(cell)
                    + formatted(" turns inside out at t = %g s on its straight way", time)
                    + "; save more frames there, or mend the mesh");
    }

    [[noreturn]] void refuse(std::size_t frame, Eigen::Index cell, double from, double to) const {
        refuse_inversion(frame, cell);
        const std::string where =
            way_of(frame) + ": " + name_of(cell)
            + formatted(" changes its shape too much from t = %g to %g s for one layer",
                        time_at(frame, from), time_at(frame, to));
        throw Error(where
                    + (options_.refine_time == 0
                           ? "; it is flat to rounding, or would take over 65536 layers"
                           : "; cut the step by --refine-time auto, or save more frames"));
    }

    const MovingMesh& moving_;
    const SpaceTimeOptions& options_;
    std::array<Prisms, 2> prisms_;
    std::vector<TimeLayer> layers_;
};

}  // namespace

VolumePolynomial volume_on_the_way(const Corners& from, const Corners& to) {
    std::array<Eigen::Vector3d, 3> b;
    std::array<Eigen::Vector3d, 3> t;
    for (int i = 0; i < 3; ++i) {
        b[i] = from.col(i + 1) - from.col(0);
        t[i] = to.col(i + 1) - to.col(0);
    }
    return {det3(b[0], b[1], b[2]),
            (det3(t[0], b[1], b[2]) + det3(b[0], t[1], b[2]) + det3(b[0], b[1], t[2])) / 3,
            (det3(b[0], t[1], t[2]) + det3(t[0], b[1], t[2]) + det3(t[0], t[1], b[2])) / 3,
            det3(t[0], t[1], t[2])};
}

std::optional<double> first_inversion(const VolumePolynomial& volume) {
    return inversion_within(volume, 0, 0);
}

Positions<3> positions_in(const MovingMesh& moving, const TimeLayer& layer) {
    if (layer.share == 0) {
        return moving.positions[layer.frame];
    }
    return (1 - layer.share) * moving.positions[layer.frame]
           + layer.share * moving.positions[layer.frame + 1];
}

std::vector<TimeLayer> choose_layers(const MovingMesh& moving,
                                     const OrderedCells<3>& ordered,
                                     const SpaceTimeOptions& options) {
    return LayerChoice(moving, ordered, options).choose();
}

}  // namespace pent::mesher
