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

// A subtree no deeper than the patches, with boxes around its simplices and their normals.
struct Branch {
    BoxTree::Range range;
    Box box;
    Box normals;
    std::uint32_t patch = 0;  // of those at its depth
    int depth = 0;            // how often it can be halved before it is a patch
};

struct Branches {
    std::array<Branch, 2> branch;
    int count = 0;
};

struct Work {
    Branch first;
    Branch second;

    [[nodiscard]] bool is_patches() const { return first.depth == 0 && second.depth == 0; }
};

// Pairs of patches that overlap and can face each other.
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
    [[nodiscard]] std::vector<Work> split() const {
        std::vector<Work> work;
        if (!first_.is_empty() && !second_.is_empty()) {
            work.push_back({root(first_, first_normals_), root(second_, second_normals_)});
        }
        std::vector<Work> next;
        bool is_split = true;
        while (is_split && work.size() < kPieces) {
            next.clear();
            is_split = false;
            for (const Work& piece : work) {
                is_split |= !piece.is_patches();
                for_each_part(piece, [&](const Work& part) { next.push_back(part); });
            }
            std::swap(work, next);
        }
        return work;
    }

    // Calls visit(patches) for all pairs of patches in a piece.
    template <typename Visit>
    void for_each_patches(const Work& piece, const Visit& visit) const {
        if (piece.is_patches()) {
            visit(piece);
        } else {
            for_each_part(piece, [&](const Work& part) { for_each_patches(part, visit); });
        }
    }

private:
    static Branch root(const BoxTree& tree, const BoxTree& normals) {
        return {tree.root(), tree.root_box(), normals.root_box(), 0, patch_depth(tree.size())};
    }

    static Branches halves(const BoxTree& tree, const BoxTree& normals, const Branch& branch) {
        if (branch.depth == 0) {
            return {{branch, Branch{}}, 1};
        }
        const auto [left, right] = tree.child_boxes(branch.range);
        const auto [left_normals, right_normals] = normals.child_boxes(branch.range);
        const int depth = branch.depth - 1;
        return {{Branch{branch.range.left(), left, left_normals, 2 * branch.patch, depth},
                 Branch{branch.range.right(), right, right_normals, 2 * branch.patch + 1, depth}},
                2};
    }

    // The parts of a piece that have a pair; a patch is its own part. Within one tree, once each.
    template <typename Visit>
    void for_each_part(const Work& piece, const Visit& visit) const {
        const bool is_self =
            &first_ == &second_ && piece.first.range.begin == piece.second.range.begin;
        const Branches a = halves(first_, first_normals_, piece.first);
        const Branches b = halves(second_, second_normals_, piece.second);
        for (int i = 0; i < a.count; ++i) {
            for (int j = is_self ? i : 0; j < b.count; ++j) {
                const Branch& first = a.branch[i];
                const Branch& second = b.branch[j];
                if (overlap(first.box, second.box) && can_face(first.normals, second.normals)) {
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
NearPairs facing_pairs(const FacingSet<Dim, K>& first,
                       const FacingSet<Dim, L>& second,
                       const PositionsView<Dim>& positions,
                       double distance,
                       double rest_distance,
                       Closest closest) {
    const bool is_same_list = &first.tree == &second.tree;
    const bool has_motions = !first.motions.empty() && !second.motions.empty();
    const FacingWalk walk(first.tree, first.normals, second.tree, second.normals);
    const std::vector<Work> work = walk.split();
    std::vector<NearPairs> found(work.size());
    const auto visit_pair = [&](std::uint32_t i, std::uint32_t j, NearPairs& here) {
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
    };
    const auto visit_patches = [&](const Work& patches, NearPairs& here) {
        const auto& [a, b] = patches;
        if (has_motions
            && stay_apart<Dim>(first.motions[a.patch], second.motions[b.patch], rest_distance,
                               distance)) {
            return;
        }
        BoxTree::for_each_overlap(
            first.tree, second.tree, {a.range, b.range, a.box, b.box},
            [&](std::uint32_t i, std::uint32_t j) { visit_pair(i, j, here); });
    };
    tbb::parallel_for(
        std::size_t{0}, work.size(),
        [&](std::size_t piece) {
            walk.for_each_patches(
                work[piece], [&](const Work& patches) { visit_patches(patches, found[piece]); });
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
#define PENT_INSTANTIATE(Dim, K, L)                                                                \
    template NearPairs facing_pairs<Dim, K, L>(const FacingSet<Dim, K>&, const FacingSet<Dim, L>&, \
                                               const PositionsView<Dim>&, double, double,          \
                                               Closest);
PENT_INSTANTIATE(3, 1, 3)
PENT_INSTANTIATE(3, 2, 2)
PENT_INSTANTIATE(4, 1, 4)
PENT_INSTANTIATE(4, 2, 3)
#undef PENT_INSTANTIATE

}  // namespace pent::contact
