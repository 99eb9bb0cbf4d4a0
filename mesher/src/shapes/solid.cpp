#include "solid_data.h"
#include "tet_boundary.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace pent::mesher {

namespace {

using Data = Solid::Data;
using Op = Data::Op;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

// How far a blend lies beyond the extreme of two values: the quadratic smooth minimum, which is not
// 0 where they differ by less than `smooth`, and whose slope does not jump.
double blend(double a, double b, double smooth) {
    const double overlap = std::max(smooth - std::abs(a - b), 0.0);
    return smooth > 0 ? overlap * overlap / (4 * smooth) : 0;
}

double combine(const Data::Node& node, double a, double b) {
    return node.op == Op::Min ? std::min(a, b) - blend(a, b, node.smooth)
                              : std::max(a, b) + blend(a, b, node.smooth);
}

double leaf_value(const Data::Leaf& leaf, const Eigen::Vector4d& p) {
    return leaf.factor * field_value(leaf.field, leaf.local(p));
}

double node_value(const Data& data, int node, const Eigen::Vector4d& p) {
    if (node < 0) {
        return leaf_value(data.leaves[~node], p);
    }
    const Data::Node& inner = data.nodes[node];
    return combine(inner, node_value(data, inner.left, p), node_value(data, inner.right, p));
}

// Of a leaf's own function, turned, scaled and signed as the leaf is.
ValueSlope placed(const Data::Leaf& leaf, const ValueSlope& own) {
    return {leaf.factor * own.value, leaf.factor * (leaf.to_field.transpose() * own.slope)};
}

ValueSlope node_slope(const Data& data, int node, const Eigen::Vector4d& p, double step) {
    if (node < 0) {
        const Data::Leaf& leaf = data.leaves[~node];
        return placed(leaf, field_slope(leaf.field, leaf.local(p), step / std::abs(leaf.factor)));
    }
    const Data::Node& inner = data.nodes[node];
    const ValueSlope a = node_slope(data, inner.left, p, step);
    const ValueSlope b = node_slope(data, inner.right, p, step);
    const bool is_first = inner.op == Op::Min ? a.value < b.value : a.value > b.value;
    const Eigen::Vector4d& deciding = is_first ? a.slope : b.slope;
    const Eigen::Vector4d& other = is_first ? b.slope : a.slope;
    // The slope of blend() over the difference of the two.
    const double overlap = std::max(inner.smooth - std::abs(a.value - b.value), 0.0);
    const double part = inner.smooth > 0 ? overlap / (2 * inner.smooth) : 0;
    return {combine(inner, a.value, b.value), (1 - part) * deciding + part * other};
}

ValueRange range_of(const Data& data, int node, const Eigen::Vector4d& center, double radius) {
    if (node < 0) {
        const Data::Leaf& leaf = data.leaves[~node];
        // Of the leaf's own space, where lengths are the factor smaller.
        const ValueRange own =
            field_range(leaf.field, leaf.local(center), radius / std::abs(leaf.factor));
        const double a = leaf.factor * own.low;
        const double b = leaf.factor * own.high;
        return {std::min(a, b), std::max(a, b)};
    }
    const Data::Node& inner = data.nodes[node];
    const ValueRange a = range_of(data, inner.left, center, radius);
    const ValueRange b = range_of(data, inner.right, center, radius);
    const double most_blended = inner.smooth / 4;
    return inner.op == Op::Min
               ? ValueRange{std::min(a.low, b.low) - most_blended, std::min(a.high, b.high)}
               : ValueRange{std::max(a.low, b.low), std::max(a.high, b.high) + most_blended};
}

// Appends the pieces near a point; returns the value.
double collect_pieces(
    const Data& data, int node, const Eigen::Vector4d& p, double margin, std::vector<int>& pieces) {
    if (node < 0) {
        const Data::Leaf& leaf = data.leaves[~node];
        const Eigen::Vector4d local = leaf.local(p);
        for (const int piece : pieces_near(leaf.field, local, margin / std::abs(leaf.factor))) {
            pieces.push_back(leaf.first_piece + piece);
        }
        return leaf.factor * field_value(leaf.field, local);
    }
    const Data::Node& inner = data.nodes[node];
    std::vector<int> of_left;
    std::vector<int> of_right;
    const double a = collect_pieces(data, inner.left, p, margin, of_left);
    const double b = collect_pieces(data, inner.right, p, margin, of_right);
    const double value = combine(inner, a, b);
    if (std::abs(a - b) < inner.smooth) {
        pieces.push_back(inner.piece);
        return value;
    }
    const double extreme = inner.op == Op::Min ? std::min(a, b) : std::max(a, b);
    if (std::abs(a - extreme) <= margin) {
        pieces.insert(pieces.end(), of_left.begin(), of_left.end());
    }
    if (std::abs(b - extreme) <= margin) {
        pieces.insert(pieces.end(), of_right.begin(), of_right.end());
    }
    return value;
}

// The node whose blend a piece is, or -1.
int blend_of(const Data& data, int piece) {
    const auto found = std::find_if(data.nodes.begin(), data.nodes.end(),
                                    [&](const Data::Node& node) { return node.piece == piece; });
    return found != data.nodes.end() ? static_cast<int>(found - data.nodes.begin()) : -1;
}

// The leaf that has a piece which is no blend.
const Data::Leaf& leaf_of(const Data& data, int piece) {
    const auto after = std::upper_bound(
        data.leaves.begin(), data.leaves.end(), piece,
        [](int number, const Data::Leaf& leaf) { return number < leaf.first_piece; });
    return *(after - 1);
}

// The boundary of tetrahedra that a solid's surface is, if it is nothing else.
const TetBoundary* sole_boundary(const Data& data) {
    const auto* field =
        data.root < 0 ? std::get_if<BoundaryField>(&data.leaves[~data.root].field) : nullptr;
    return field != nullptr ? field->boundary.get() : nullptr;
}

// All of one and of the other, with the root still to be made.
Data joined(const Data& a, const Data& b) {
    Data data = a;
    const auto leaves = static_cast<int>(a.leaves.size());
    const auto nodes = static_cast<int>(a.nodes.size());
    const auto moved = [&](int node) { return node < 0 ? node - leaves : node + nodes; };
    for (Data::Leaf leaf : b.leaves) {
        leaf.first_piece += a.pieces;
        data.leaves.push_back(std::move(leaf));
    }
    for (Data::Node node : b.nodes) {
        node.left = moved(node.left);
        node.right = moved(node.right);
        node.piece += a.pieces;
        data.nodes.push_back(node);
    }
    data.pieces = a.pieces + b.pieces;
    data.smallest_width = std::min(a.smallest_width, b.smallest_width);
    data.root = moved(b.root);
    return data;
}

Box4 grown(const Box4& box, double by) {
    return {box.low.array() - by, box.high.array() + by};
}

Box4 around(const Box4& a, const Box4& b) {
    return {a.low.cwiseMin(b.low), a.high.cwiseMax(b.high)};
}

// The bounds of a union. A blend is at most smooth / 4 below the lower of two values, so it adds
// nothing but points where that one is below smooth / 4. As the other differs by less than `smooth`
// there, it is below 1.25 smooth: the bound to use where small values of the first may be anywhere.
// Where those of both may, there is none, and LatticeTree throws if the body reaches beyond these.
Box4 bounds_of_union(const Data& a, const Data& b, double smooth) {
    const auto with_blend = [&](const Data& data, double level) {
        const double factor = std::isinf(data.reach.factor) ? 1 : data.reach.factor;
        return grown(data.bounds, factor * level);
    };
    const bool is_anywhere = std::isinf(a.reach.factor);
    if (smooth == 0 || is_anywhere == std::isinf(b.reach.factor)) {
        return around(with_blend(a, smooth / 4), with_blend(b, smooth / 4));
    }
    return around(with_blend(a, is_anywhere ? 0 : 1.25 * smooth),
                  with_blend(b, is_anywhere ? 1.25 * smooth : 0));
}

// Beyond each side of the common box values grow as those of the solid that has this side.
Reach reach_of_intersection(const Data& a, const Data& b) {
    const double least = std::min(a.reach.factor, b.reach.factor);
    Reach reach{0, false};
    for (int axis = 0; axis < 4; ++axis) {
        const auto consider = [&](double inset_a, double inset_b) {
            const double factor = inset_a > inset_b   ? a.reach.factor
                                  : inset_a < inset_b ? b.reach.factor
                                                      : least;
            reach.factor = std::max(reach.factor, factor);
        };
        consider(a.bounds.low[axis], b.bounds.low[axis]);
        consider(-a.bounds.high[axis], -b.bounds.high[axis]);
    }
    return reach;
}

Solid combine(const Solid& a, const Solid& b, Op op, double smooth) {
    Data data = joined(a.data(), b.data());
    data.nodes.push_back({op, smooth, a.data().root, data.root, data.pieces});
    ++data.pieces;
    data.root = static_cast<int>(data.nodes.size()) - 1;
    if (op == Op::Min) {
        data.bounds = bounds_of_union(a.data(), b.data(), smooth);
        data.reach = {std::max(a.data().reach.factor, b.data().reach.factor),
                      a.data().reach.is_round && b.data().reach.is_round};
    } else {
        data.bounds = {a.bounds().low.cwiseMax(b.bounds().low),
                       a.bounds().high.cwiseMin(b.bounds().high)};
        data.reach = reach_of_intersection(a.data(), b.data());
    }
    return Solid(std::make_shared<const Data>(std::move(data)));
}

Solid outside_of(const Solid& solid) {
    Data data = solid.data();
    for (Data::Leaf& leaf : data.leaves) {
        leaf.factor = -leaf.factor;
    }
    for (Data::Node& node : data.nodes) {
        node.op = node.op == Op::Min ? Op::Max : Op::Min;
    }
    data.bounds = {Eigen::Vector4d::Constant(-kInfinity), Eigen::Vector4d::Constant(kInfinity)};
    data.reach = {};
    return Solid(std::make_shared<const Data>(std::move(data)));
}

// The box along the axes around a box that was rotated; empty if that one is. An infinite side
// makes every side infinite that it has a part in.
Box4 placed_box(const Box4& box,
                const Eigen::Matrix4d& linear,
                const Eigen::Vector4d& translation) {
    if ((box.low.array() > box.high.array()).any()) {
        return {Eigen::Vector4d::Constant(kInfinity), Eigen::Vector4d::Constant(-kInfinity)};
    }
    Box4 result{translation, translation};
    for (int row = 0; row < 4; ++row) {
        for (int column = 0; column < 4; ++column) {
            const double entry = linear(row, column);
            if (entry != 0) {
                const double a = entry * box.low[column];
                const double b = entry * box.high[column];
                result.low[row] += std::min(a, b);
                result.high[row] += std::max(a, b);
            }
        }
    }
    return result;
}

}  // namespace

Solid solid_of(Field field, const Box4& bounds, double smallest_width, const Reach& reach) {
    Data data;
    data.pieces = piece_count(field);
    data.leaves.push_back({.field = std::move(field)});
    data.root = ~0;
    data.bounds = bounds;
    data.smallest_width = smallest_width;
    data.reach = reach;
    return Solid(std::make_shared<const Data>(std::move(data)));
}

ValueSlope Solid::value_slope(const Eigen::Vector4d& p, double step) const {
    return node_slope(*data_, data_->root, p, step);
}

double Solid::value(const Eigen::Vector4d& p) const {
    return node_value(*data_, data_->root, p);
}

double Solid::value_near(const Eigen::Vector4d& p,
                         double enough,
                         std::span<const Sample> known) const {
    const TetBoundary* boundary = sole_boundary(*data_);
    if (boundary == nullptr) {
        return value(p);
    }
    const Data::Leaf& leaf = data_->leaves[~data_->root];
    std::vector<Sample> own;
    own.reserve(known.size());
    for (const Sample& sample : known) {
        own.push_back({leaf.local(sample.place), sample.value / leaf.factor});
    }
    return leaf.factor * boundary->value_near(leaf.local(p), enough / leaf.factor, own);
}

bool Solid::is_inside(const Eigen::Vector4d& p) const {
    const TetBoundary* boundary = sole_boundary(*data_);
    return boundary == nullptr
               ? value(p) < 0
               : boundary->winding_number(data_->leaves[~data_->root].local(p)) != 0;
}

bool Solid::is_near_surface(const Eigen::Vector4d& p, double distance) const {
    const TetBoundary* boundary = sole_boundary(*data_);
    if (boundary == nullptr) {
        return std::abs(value(p)) < distance;
    }
    const Data::Leaf& leaf = data_->leaves[~data_->root];
    return std::isfinite(boundary->distance(leaf.local(p), distance / leaf.factor));
}

Eigen::Vector4d Solid::slope(const Sample& at, double step) const {
    const std::optional<Eigen::Vector4d> there = foot(at.place);
    return there && at.value != 0 ? Eigen::Vector4d((at.place - *there) / at.value)
                                  : value_slope(at.place, step).slope;
}

bool Solid::is_boundary() const {
    return sole_boundary(*data_) != nullptr;
}

std::optional<Eigen::Vector4d> Solid::foot(const Eigen::Vector4d& p) const {
    const TetBoundary* boundary = sole_boundary(*data_);
    if (boundary == nullptr) {
        return std::nullopt;
    }
    const Data::Leaf& leaf = data_->leaves[~data_->root];
    return leaf.placed(boundary->foot(leaf.local(p)));
}

std::optional<double> Solid::first_crossing(const Eigen::Vector4d& outside,
                                            const Eigen::Vector4d& inside) const {
    const TetBoundary* boundary = sole_boundary(*data_);
    if (boundary == nullptr) {
        return std::nullopt;
    }
    const Data::Leaf& leaf = data_->leaves[~data_->root];
    return boundary->first_crossing(leaf.local(outside), leaf.local(inside));
}

ValueRange Solid::values_within(const Eigen::Vector4d& center, double radius) const {
    return range_of(*data_, data_->root, center, radius);
}

bool Solid::is_lipschitz() const {
    return std::none_of(data_->leaves.begin(), data_->leaves.end(), [](const Data::Leaf& leaf) {
        return std::holds_alternative<ExpressionField>(leaf.field)
               || std::holds_alternative<ImageField>(leaf.field);
    });
}

std::vector<int> Solid::pieces_near(const Eigen::Vector4d& p, double margin) const {
    if (data_->root < 0) {
        const Data::Leaf& leaf = data_->leaves[~data_->root];
        return mesher::pieces_near(leaf.field, leaf.local(p), margin / std::abs(leaf.factor));
    }
    std::vector<int> pieces;
    collect_pieces(*data_, data_->root, p, margin, pieces);
    std::sort(pieces.begin(), pieces.end());
    return pieces;
}

int Solid::piece_count() const {
    return data_->pieces;
}

double Solid::piece_value(int piece, const Eigen::Vector4d& p) const {
    if (const int node = blend_of(*data_, piece); node >= 0) {
        return node_value(*data_, node, p);
    }
    const Data::Leaf& leaf = leaf_of(*data_, piece);
    return leaf.factor * mesher::piece_value(leaf.field, piece - leaf.first_piece, leaf.local(p));
}

ValueSlope Solid::piece_slope(int piece, const Eigen::Vector4d& p, double step) const {
    if (const int node = blend_of(*data_, piece); node >= 0) {
        return node_slope(*data_, node, p, step);
    }
    const Data::Leaf& leaf = leaf_of(*data_, piece);
    return placed(leaf, mesher::piece_slope(leaf.field, piece - leaf.first_piece, leaf.local(p),
                                            step / std::abs(leaf.factor)));
}

std::optional<Eigen::Vector4d> Solid::piece_foot(int piece, const Eigen::Vector4d& p) const {
    if (blend_of(*data_, piece) >= 0) {
        return std::nullopt;
    }
    const Data::Leaf& leaf = leaf_of(*data_, piece);
    const auto* field = std::get_if<BoundaryField>(&leaf.field);
    if (field == nullptr) {
        return std::nullopt;
    }
    return leaf.placed(field->boundary->foot(leaf.local(p), piece - leaf.first_piece));
}

const Box4& Solid::bounds() const {
    return data_->bounds;
}

bool Solid::is_bounded() const {
    return data_->bounds.low.allFinite() && data_->bounds.high.allFinite();
}

double Solid::smallest_width() const {
    return data_->smallest_width;
}

Solid unite(const Solid& a, const Solid& b, double smooth) {
    return combine(a, b, Op::Min, smooth);
}

Solid intersect(const Solid& a, const Solid& b, double smooth) {
    return combine(a, b, Op::Max, smooth);
}

Solid subtract(const Solid& a, const Solid& b, double smooth) {
    return combine(a, outside_of(b), Op::Max, smooth);
}

Solid place(const Solid& solid,
            double scale,
            const Eigen::Matrix4d& rotation,
            const Eigen::Vector4d& translation) {
    Data data = solid.data();
    const Eigen::Matrix4d inverse = rotation.transpose() / scale;
    for (Data::Leaf& leaf : data.leaves) {
        leaf.offset -= leaf.to_field * inverse * translation;
        leaf.to_field = leaf.to_field * inverse;
        leaf.factor *= scale;
    }
    for (Data::Node& node : data.nodes) {
        node.smooth *= scale;
    }
    data.bounds = placed_box(data.bounds, scale * rotation, translation);
    if (!data.reach.is_round) {
        data.reach.factor *= rotation.cwiseAbs().rowwise().sum().maxCoeff();
    }
    data.smallest_width *= scale;
    return Solid(std::make_shared<const Data>(std::move(data)));
}

}  // namespace pent::mesher
