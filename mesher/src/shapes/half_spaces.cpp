#include "half_spaces.h"

#include <algorithm>
#include <limits>
#include <numeric>
#include <utility>

namespace pent::mesher {

namespace {

using Eigen::Vector4d;

constexpr std::uint32_t kLeaf = 4;  // pieces to a leaf

// Relative bound for the rounding of sums of five products.
constexpr double kRounding = 1e-14;

}  // namespace

HalfSpaces::HalfSpaces(std::vector<HalfSpace> pieces) : pieces_(std::move(pieces)) {
    order_.resize(pieces_.size());
    std::iota(order_.begin(), order_.end(), 0);
    for (const HalfSpace& piece : pieces_) {
        largest_offset_ = std::max(largest_offset_, std::abs(piece.offset));
    }
    build(0, static_cast<std::uint32_t>(pieces_.size()));
}

// Halves the pieces along the longest side of the box of their normals.
void HalfSpaces::build(std::uint32_t first, std::uint32_t count) {
    const auto piece_at = [&](std::uint32_t i) -> const HalfSpace& { return (*this)[order_[i]]; };
    Node own{piece_at(first).normal, piece_at(first).normal, piece_at(first).offset, first,
             count <= kLeaf ? count : 0};
    for (std::uint32_t i = first; i < first + count; ++i) {
        own.low = own.low.cwiseMin(piece_at(i).normal);
        own.high = own.high.cwiseMax(piece_at(i).normal);
        own.least_offset = std::min(own.least_offset, piece_at(i).offset);
    }
    const std::size_t node = nodes_.size();
    nodes_.push_back(own);
    if (count > kLeaf) {
        Eigen::Index axis = 0;
        (own.high - own.low).maxCoeff(&axis);
        const auto begin = order_.begin() + first;
        std::nth_element(begin, begin + count / 2, begin + count, [&](int a, int b) {
            const double key_a = (*this)[a].normal[axis];
            const double key_b = (*this)[b].normal[axis];
            return key_a != key_b ? key_a < key_b : a < b;
        });
        build(first, count / 2);
        build(first + count / 2, count - count / 2);
    }
    nodes_[node].after = static_cast<std::uint32_t>(nodes_.size());
}

// An upper bound for the values of the pieces of a node.
double HalfSpaces::most(const Node& node, const Vector4d& p) const {
    const double slack = kRounding * (p.cwiseAbs().sum() + largest_offset_);
    return node.low.cwiseProduct(p).cwiseMax(node.high.cwiseProduct(p)).sum() - node.least_offset
           + slack;
}

void HalfSpaces::search(std::uint32_t node, const Vector4d& p, Largest& best) const {
    const Node& here = nodes_[node];
    for (std::uint32_t i = here.first; i < here.first + here.count; ++i) {
        const int piece = order_[i];
        const double value = (*this)[piece].value(p);
        if (value > best.value || (value == best.value && piece < best.piece)) {
            best = {value, piece};
        }
    }
    if (here.count > 0) {
        return;
    }
    std::pair<double, std::uint32_t> one = {most(nodes_[node + 1], p), node + 1};
    std::pair<double, std::uint32_t> other = {0, nodes_[node + 1].after};
    other.first = most(nodes_[other.second], p);
    if (other.first > one.first) {
        std::swap(one, other);
    }
    for (const auto& [bound, child] : {one, other}) {
        if (bound >= best.value) {
            search(child, p, best);
        }
    }
}

int HalfSpaces::deciding(const Vector4d& p) const {
    Largest best{-std::numeric_limits<double>::infinity(), count()};
    search(0, p, best);
    return best.piece;
}

std::vector<int> HalfSpaces::pieces_above(const Vector4d& p, double least) const {
    std::vector<int> found;
    for (std::uint32_t node = 0; node < nodes_.size();) {
        const Node& here = nodes_[node];
        if (most(here, p) < least) {
            node = here.after;
            continue;
        }
        for (std::uint32_t i = here.first; i < here.first + here.count; ++i) {
            if ((*this)[order_[i]].value(p) >= least) {
                found.push_back(order_[i]);
            }
        }
        ++node;
    }
    std::sort(found.begin(), found.end());
    return found;
}

}  // namespace pent::mesher
