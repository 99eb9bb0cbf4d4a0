#include "pairs_within.h"

#include <array>

namespace pent::contact {

namespace {

// A subtree no deeper than the patches, and the box around it.
struct Branch {
    BoxTree::Range range;
    Box box;
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

// Pairs of patches that overlap.
class PatchWalk {
public:
    PatchWalk(const BoxTree& first, const BoxTree& second) : first_(first), second_(second) {}

    // Pieces of work, breadth first, so that they are of like size.
    [[nodiscard]] std::vector<Work> split() const {
        std::vector<Work> work;
        if (!first_.is_empty() && !second_.is_empty()) {
            work.push_back({root(first_), root(second_)});
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
    static Branch root(const BoxTree& tree) {
        return {tree.root(), tree.root_box(), 0, patch_depth(tree.size())};
    }

    static Branches halves(const BoxTree& tree, const Branch& branch) {
        if (branch.depth == 0) {
            return {{branch, Branch{}}, 1};
        }
        const auto [left, right] = tree.child_boxes(branch.range);
        const int depth = branch.depth - 1;
        return {{Branch{branch.range.left(), left, 2 * branch.patch, depth},
                 Branch{branch.range.right(), right, 2 * branch.patch + 1, depth}},
                2};
    }

    // The parts of a piece that have a pair; a patch is its own part. Within one tree, once each.
    template <typename Visit>
    void for_each_part(const Work& piece, const Visit& visit) const {
        const bool is_self =
            &first_ == &second_ && piece.first.range.begin == piece.second.range.begin;
        const Branches a = halves(first_, piece.first);
        const Branches b = halves(second_, piece.second);
        for (int i = 0; i < a.count; ++i) {
            for (int j = is_self ? i : 0; j < b.count; ++j) {
                if (overlap(a.branch[i].box, b.branch[j].box)) {
                    visit({a.branch[i], b.branch[j]});
                }
            }
        }
    }

    const BoxTree& first_;
    const BoxTree& second_;
};

}  // namespace

template <int Dim, int K, int L>
CandidateList pairs_within(const PatchedSet<Dim, K>& first,
                           const PatchedSet<Dim, L>& second,
                           const PositionsView<Dim>& positions,
                           double distance,
                           double rest_distance,
                           Closest closest) {
    const NearTest<Dim, K, L> test{.first = first.simplices,
                                   .second = second.simplices,
                                   .is_same_list = &first.tree == &second.tree,
                                   .positions = positions,
                                   .limit_squared = distance * distance,
                                   .closest = closest};
    const PatchWalk walk(first.tree, second.tree);
    const std::vector<Work> work = walk.split();
    std::vector<CandidateList> found(work.size());
    parallel_for(work.size(), [&](std::size_t piece) {
        walk.for_each_patches(work[piece], [&](const Work& patches) {
            const auto& [a, b] = patches;
            if (!stay_apart<Dim>(first.motions[a.patch], second.motions[b.patch], rest_distance,
                                 distance)) {
                BoxTree::for_each_overlap(
                    first.tree, second.tree, {a.range, b.range, a.box, b.box},
                    [&](std::uint32_t i, std::uint32_t j) { test(i, j, found[piece]); });
            }
        });
    });
    return sorted(joined(found));
}

#define PENT_INSTANTIATE(Dim, K, L)                                                              \
    template CandidateList pairs_within<Dim, K, L>(                                              \
        const PatchedSet<Dim, K>&, const PatchedSet<Dim, L>&, const PositionsView<Dim>&, double, \
        double, Closest);
PENT_INSTANTIATE(3, 1, 3)
PENT_INSTANTIATE(3, 2, 2)
PENT_INSTANTIATE(4, 1, 4)
PENT_INSTANTIATE(4, 2, 3)
#undef PENT_INSTANTIATE

}  // namespace pent::contact
