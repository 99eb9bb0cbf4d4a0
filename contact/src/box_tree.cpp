#include "pent/contact/box_tree.h"

#include "halving.h"

#include <pent/dimensions.h>
#include <pent/parallel.h>

#include <array>
#include <cassert>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

namespace pent::contact {

namespace {

// Subtrees below this size are built and fit by one thread.
constexpr std::uint32_t kSerial = 4096;

// A float at or below the value: the product with two units in the last place is more than both
// roundings.
float round_down(double value) {
    const float nearest = static_cast<float>(value);
    return nearest - std::abs(nearest) * 2.4e-7F - std::numeric_limits<float>::min();
}

float round_up(double value) {
    return -round_down(-value);
}

double side_sum(const Box& box) {
    double sum = 0;
    for (int axis = 0; axis < 4; ++axis) {
        sum += static_cast<double>(box.high[axis]) - static_cast<double>(box.low[axis]);
    }
    return sum;
}

// 0, 1, 2 and so on.
std::vector<std::uint32_t> counted(std::size_t count) {
    std::vector<std::uint32_t> numbers(count);
    std::iota(numbers.begin(), numbers.end(), 0U);
    return numbers;
}

// Splits work breadth first, so that pieces are of like size.
class Splitter {
public:
    Splitter(const BoxTree& first, const BoxTree& second) : first_(first), second_(second) {}

    std::vector<BoxTree::Work> run(const BoxTree::Work& start, std::size_t least) {
        std::vector<BoxTree::Work> work{start};
        while (!work.empty() && work.size() < least) {
            next_.clear();
            bool is_split = false;
            for (const BoxTree::Work& piece : work) {
                is_split = split(piece) || is_split;
            }
            std::swap(work, next_);
            if (!is_split) {
                break;
            }
        }
        return work;
    }

private:
    struct Half {
        BoxTree::Range range;
        Box box{};
    };
    struct Halves {
        std::array<Half, 2> half;
        int count = 0;
    };

    // Adds what a piece falls into; returns whether it could be split.
    bool split(const BoxTree::Work& piece) {
        const bool is_self = &first_ == &second_ && piece.first.begin == piece.second.begin
                             && piece.first.count == piece.second.count;
        const Halves a = halves(first_, piece.first, piece.first_box);
        const Halves b = halves(second_, piece.second, piece.second_box);
        for (int i = 0; i < a.count; ++i) {
            for (int j = is_self ? i : 0; j < b.count; ++j) {
                const Half& first = a.half[i];
                const Half& second = b.half[j];
                const bool is_one_leaf = is_self && i == j && first.range.is_leaf();
                if (!is_one_leaf && overlap(first.box, second.box)) {
                    next_.push_back({first.range, second.range, first.box, second.box});
                }
            }
        }
        return a.count * b.count > 1;
    }

    static Halves halves(const BoxTree& tree, const BoxTree::Range& range, const Box& box) {
        if (range.is_leaf()) {
            return {{Half{range, box}, Half{}}, 1};
        }
        const auto [left, right] = tree.child_boxes(range);
        return {{Half{range.left(), left}, Half{range.right(), right}}, 2};
    }

    const BoxTree& first_;
    const BoxTree& second_;
    std::vector<BoxTree::Work> next_;
};

}  // namespace

Box hull(const Box& a, const Box& b) {
    using Four = Pack<float, 4>;
    Box box;  // NOLINT(cppcoreguidelines-pro-type-member-init): filled here
    min(Four::load_aligned(b.low), Four::load_aligned(a.low)).store(box.low);
    max(Four::load_aligned(b.high), Four::load_aligned(a.high)).store(box.high);
    return box;
}

template <int Dim, int Count>
Box box_around(const Eigen::Matrix<double, Dim, Count>& points, double margin) {
    const Vector<Dim> low = points.rowwise().minCoeff();
    const Vector<Dim> high = points.rowwise().maxCoeff();
    Box box{};
    for (int axis = 0; axis < Dim; ++axis) {
        box.low[axis] = round_down(low[axis] - margin);
        box.high[axis] = round_up(high[axis] + margin);
    }
    return box;
}

BoxTree::BoxTree(std::span<const Box> boxes, std::vector<std::uint32_t> leaves)
    : nodes_(boxes.empty() ? 0 : boxes.size() - 1), leaves_(std::move(leaves)) {
    refit(boxes);
}

BoxTree::BoxTree(std::span<const Box> boxes)
    : BoxTree(boxes, order_by_halving(boxes, counted(boxes.size() + 1))) {}

BoxTree BoxTree::in_order(std::span<const Box> boxes) {
    return {boxes, counted(boxes.size())};
}

void BoxTree::refit(std::span<const Box> boxes) {
    assert(boxes.size() == size());
    cost_ = 0;
    if (!boxes.empty()) {
        root_ = fit(root(), boxes, cost_);
    }
}

Box BoxTree::fit(const Range& range, std::span<const Box> boxes, double& cost) {
    if (range.is_leaf()) {
        return boxes[leaves_[range.begin]];
    }
    Node& node = nodes_[range.node];
    if (range.count < kSerial) {
        node.left = fit(range.left(), boxes, cost);
        node.right = fit(range.right(), boxes, cost);
    } else {
        double left_cost = 0;
        double right_cost = 0;
        parallel_invoke([&] { node.left = fit(range.left(), boxes, left_cost); },
                        [&] { node.right = fit(range.right(), boxes, right_cost); });
        cost += left_cost + right_cost;
    }
    const Box box = hull(node.left, node.right);
    cost += side_sum(box);
    return box;
}

std::pair<Box, Box> BoxTree::child_boxes(const Range& range) const {
    const Node& node = nodes_[range.node];
    return {node.left, node.right};
}

bool BoxTree::has_overlap(const Box& box) const {
    return !is_empty() && overlap(root_, box) && has_overlap(root(), box);
}

bool BoxTree::has_overlap(const Range& range, const Box& box) const {
    if (range.is_leaf()) {
        return true;
    }
    const Node& node = nodes_[range.node];
    return (overlap(node.left, box) && has_overlap(range.left(), box))
           || (overlap(node.right, box) && has_overlap(range.right(), box));
}

std::vector<BoxTree::Work> BoxTree::split(const BoxTree& first,
                                          const BoxTree& second,
                                          std::size_t least) {
    if (first.is_empty() || second.is_empty() || !overlap(first.root_, second.root_)) {
        return {};
    }
    return Splitter(first, second)
        .run({first.root(), second.root(), first.root_, second.root_}, least);
}

#define PENT_INSTANTIATE(Dim, Count) \
    template Box box_around(const Eigen::Matrix<double, Dim, Count>&, double);
PENT_FOR_EACH_DIMENSION(PENT_INSTANTIATE, 1)
PENT_FOR_EACH_DIMENSION(PENT_INSTANTIATE, 2)
PENT_FOR_EACH_DIMENSION(PENT_INSTANTIATE, 3)
PENT_FOR_EACH_DIMENSION(PENT_INSTANTIATE, 4)
PENT_INSTANTIATE(4, 5)
#undef PENT_INSTANTIATE

}  // namespace pent::contact
