#include "facing_pairs.h"

#include "collect_pairs.h"

#include <array>
#include <tbb/parallel_for.h>
#include <tbb/partitioner.h>

namespace pent::contact {

namespace {

// Whether normals within the two boxes can differ by 2 kLeastView; a little less, for rounding.
bool can_face(const Box& a, const Box& b) {
    constexpr float kLimit = static_cast<float>(4 * kLeastView * kLeastView * 0.999);
    float most = 0;
    for (int axis = 0; axis < 4; ++axis) {
        const float difference = std::max(b.high[axis] - a.low[axis], a.high[axis] - b.low[axis]);
        most += difference * difference;
    }
    return most >= kLimit;
}

// Pieces that a walk is cut into: the finer, the more of a smooth surface is left out.
constexpr std::size_t kFacingPieces = 8 * kPieces;

// A subtree, with boxes around its simplices and their normals.
struct Patch {
    BoxTree::Range range;
    Box box;
    Box normals;
};

struct Patches {
    std::array<Patch, 2> patch;
    int count = 0;
};

// Pairs of subtrees that overlap and can face each other.
class FacingWalk {
public:
    FacingWalk(const BoxTree& first,
               const BoxTree& first_normals,
               const BoxTree& second,
               const BoxTree& second_normals)
        : first_(first),
          first_normals_(first_normals),
          second_(second),
          second_normals_(second_normals) {}

    // Pieces of work, breadth first, so that they are of like size.
    [[nodiscard]] std::vector<BoxTree::Work> split() const {
        std::vector<Work> work;
        if (!first_.is_empty() && !second_.is_empty()) {
            work.push_back({{first_.root(), first_.root_box(), first_normals_.root_box()},
                            {second_.root(), second_.root_box(), second_normals_.root_box()}});
        }
        std::vector<Work> next;
        bool is_split = true;
        while (is_split && work.size() < kFacingPieces) {
            next.clear();
            is_split = false;
            for (const Work& piece : work) {
                is_split |= !is_leaf(piece);
                for_each_part(piece, [&](const Work& part) { next.push_back(part); });
            }
            std::swap(work, next);
        }
        std::vector<BoxTree::Work> pieces;
        for (const Work& piece : work) {
            pieces.push_back(
                {piece.first.range, piece.second.range, piece.first.box, piece.second.box});
        }
        return pieces;
    }

private:
    struct Work {
        Patch first;
        Patch second;
    };

    static bool is_leaf(const Work& piece) {
        return piece.first.range.is_leaf() && piece.second.range.is_leaf();
    }

    static Patches halves(const BoxTree& tree, const BoxTree& normals, const Patch& patch) {
        if (patch.range.is_leaf()) {
            return {{patch, Patch{}}, 1};
        }
        const auto [left, right] = tree.child_boxes(patch.range);
        const auto [left_normals, right_normals] = normals.child_boxes(patch.range);
        return {{Patch{patch.range.left(), left, left_normals},
                 Patch{patch.range.right(), right, right_normals}},
                2};
    }

    // The parts of a piece that have a pair; a leaf is its own part. Within one tree, once each.
    template <typename Visit>
    void for_each_part(const Work& piece, const Visit& visit) const {
        const bool is_self = &first_ == &second_
                             && piece.first.range.begin == piece.second.range.begin
                             && piece.first.range.count == piece.second.range.count;
        const Patches a = halves(first_, first_normals_, piece.first);
        const Patches b = halves(second_, second_normals_, piece.second);
        for (int i = 0; i < a.count; ++i) {
            for (int j = is_self ? i : 0; j < b.count; ++j) {
                const Patch& first = a.patch[i];
                const Patch& second = b.patch[j];
                const bool is_one_leaf = is_self && i == j && first.range.is_leaf();
                if (!is_one_leaf && overlap(first.box, second.box)
                    && can_face(first.normals, second.normals)) {
                    visit({first, second});
                }
            }
        }
    }

    const BoxTree& first_;
    const BoxTree& first_normals_;
    const BoxTree& second_;
    const BoxTree& second_normals_;
};

}  // namespace

template <int Dim, int Count>
std::vector<Box> normal_boxes(const Simplices<Count>& simplices, const Positions<Dim>& normals) {
    std::vector<Box> boxes(static_cast<std::size_t>(simplices.cols()));
    tbb::parallel_for(std::size_t{0}, boxes.size(), [&](std::size_t i) {
        const Corners<Dim, Count> corners =
            gather<Dim, Count>(simplices, static_cast<Eigen::Index>(i), normals);
        // A mean p of the corners becomes p / |p|, which is 1 - |p| away, and |p| is at least what
        // any unit vector has in common with all corners.
        const Vector<Dim> middle = corners.rowwise().sum().stableNormalized();
        const double least = (middle.transpose() * corners).minCoeff();
        boxes[i] = box_around<Dim, Count>(corners, std::max(0.0, 1 - least));
    });
    return boxes;
}

template <int Dim, int K, int L>
NearPairs facing_pairs(const FacingSet<K>& first,
                       const FacingSet<L>& second,
                       const PositionsView<Dim>& positions,
                       double distance,
                       Closest closest) {
    const bool is_same_list = &first.tree == &second.tree;
    const std::vector<BoxTree::Work> work =
        FacingWalk(first.tree, first.normals, second.tree, second.normals).split();
    std::vector<NearPairs> found(work.size());
    tbb::parallel_for(
        std::size_t{0}, work.size(),
        [&](std::size_t piece) {
            NearPairs& here = found[piece];
            BoxTree::for_each_overlap(
                first.tree, second.tree, work[piece], [&](std::uint32_t i, std::uint32_t j) {
                    ++here.candidates;
                    if (!can_face(first.normal_boxes[i], second.normal_boxes[j])
                        || share_a_vertex<K, L>(first.simplices, i, second.simplices, j)) {
                        return;
                    }
                    if (is_same_list && j < i) {
                        std::swap(i, j);
                    }
                    add_if_near<Dim, K, L>(first.simplices, i, second.simplices, j, positions,
                                           distance * distance, closest, here);
                });
        },
        tbb::simple_partitioner());
    return merge(found);
}

template std::vector<Box> normal_boxes<3, 1>(const Simplices<1>&, const Positions<3>&);
template std::vector<Box> normal_boxes<3, 2>(const Simplices<2>&, const Positions<3>&);
template std::vector<Box> normal_boxes<3, 3>(const Simplices<3>&, const Positions<3>&);
template std::vector<Box> normal_boxes<4, 1>(const Simplices<1>&, const Positions<4>&);
template std::vector<Box> normal_boxes<4, 2>(const Simplices<2>&, const Positions<4>&);
template std::vector<Box> normal_boxes<4, 3>(const Simplices<3>&, const Positions<4>&);
template std::vector<Box> normal_boxes<4, 4>(const Simplices<4>&, const Positions<4>&);
template NearPairs facing_pairs<3, 1, 3>(
    const FacingSet<1>&, const FacingSet<3>&, const PositionsView<3>&, double, Closest);
template NearPairs facing_pairs<3, 2, 2>(
    const FacingSet<2>&, const FacingSet<2>&, const PositionsView<3>&, double, Closest);
template NearPairs facing_pairs<4, 1, 4>(
    const FacingSet<1>&, const FacingSet<4>&, const PositionsView<4>&, double, Closest);
template NearPairs facing_pairs<4, 2, 3>(
    const FacingSet<2>&, const FacingSet<3>&, const PositionsView<4>&, double, Closest);

}  // namespace pent::contact
