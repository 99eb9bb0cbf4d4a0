#pragma once

#include <pent/contact/box.h>

#include <cstdint>
#include <span>
#include <utility>
#include <vector>

namespace pent::contact {

/// A bounding-volume tree over boxes: binary, balanced, each inner node with the boxes of both its
/// children in 64 bytes. The children of a node follow from its place and its count of boxes, so
/// nothing else is stored: a tree over n boxes has n - 1 nodes.
///
/// The tree depends on the boxes alone, not on the number of threads.
class BoxTree {
public:
    /// A subtree: its root node, and which range of the leaves it holds. A single leaf has no node.
    struct Range {
        std::uint32_t node = 0;
        std::uint32_t begin = 0;
        std::uint32_t count = 0;
        [[nodiscard]] bool is_leaf() const { return count == 1; }
        [[nodiscard]] Range left() const { return {node + 1, begin, (count + 1) / 2}; }
        [[nodiscard]] Range right() const {
            const std::uint32_t in_left = (count + 1) / 2;
            return {node + in_left, begin + in_left, count - in_left};
        }
    };

    /// Two subtrees whose boxes overlap: a piece of work for one thread.
    struct Work {
        Range first;
        Range second;
        Box first_box{};
        Box second_box{};
    };

    BoxTree() = default;

    /// Splits at the median along the longest side of the centers, in time n log n.
    explicit BoxTree(std::span<const Box> boxes);

    /// A tree whose leaves are the boxes in their order, in which neighbors are to follow each
    /// other: visits are ascending.
    [[nodiscard]] static BoxTree in_order(std::span<const Box> boxes);

    /// Fits the same tree around moved boxes, of the same number and order; asserted. Linear time.
    void refit(std::span<const Box> boxes);

    [[nodiscard]] std::size_t size() const { return leaves_.size(); }
    [[nodiscard]] bool is_empty() const { return leaves_.empty(); }
    [[nodiscard]] std::int64_t bytes() const {
        return static_cast<std::int64_t>(nodes_.size() * sizeof(Node)
                                         + leaves_.size() * sizeof(std::uint32_t));
    }
    [[nodiscard]] const Box& root_box() const { return root_; }
    [[nodiscard]] Range root() const { return {0, 0, static_cast<std::uint32_t>(size())}; }

    /// Which box is at a leaf; leaves of near boxes are near each other.
    [[nodiscard]] std::uint32_t leaf(std::uint32_t place) const { return leaves_[place]; }

    /// Boxes around the two halves of a range, which is not a leaf.
    [[nodiscard]] std::pair<Box, Box> child_boxes(const Range& range) const;

    /// Sum of the sides of all node boxes, m: how much a query has to look at. A tree refit so
    /// often that this has grown by a half is better built anew.
    [[nodiscard]] double cost() const { return cost_; }

    /// Calls visit(i) for each box i that overlaps `box`.
    template <typename Visit>
    void for_each_overlap(const Box& box, const Visit& visit) const;

    /// Whether any box overlaps `box`.
    [[nodiscard]] bool has_overlap(const Box& box) const;

    /// Calls visit(i) for boxes i in an order that meets near ones first, and leaves out those
    /// whose squared distance to the point is beyond the bound that the last visit returned.
    ///
    /// @param bound  Squared distance to start with, m^2.
    /// @param visit  double visit(std::uint32_t i): the new bound, not above the last.
    template <int Dim, typename Visit>
    void for_each_near(const Vector<Dim>& point, double bound, const Visit& visit) const;

    /// Pieces of work that together are all overlaps of two trees, or of one tree with itself: each
    /// pair of different boxes once. At least `least` pieces where there is enough to do; their
    /// order and number depend on the trees alone.
    [[nodiscard]] static std::vector<Work> split(const BoxTree& first,
                                                 const BoxTree& second,
                                                 std::size_t least);

    /// Calls visit(i, j) for each box i of the first and j of the second tree that overlap, within
    /// one piece of work. Nothing is stored.
    template <typename Visit>
    static void for_each_overlap(const BoxTree& first,
                                 const BoxTree& second,
                                 const Work& work,
                                 const Visit& visit);

private:
    struct alignas(64) Node {
        Box left;
        Box right;
    };

    BoxTree(std::span<const Box> boxes, std::vector<std::uint32_t> leaves);
    Box fit(const Range& range, std::span<const Box> boxes, double& cost);

    [[nodiscard]] bool has_overlap(const Range& range, const Box& box) const;

    template <typename Visit>
    void visit_box(const Range& range, const Box& box, const Visit& visit) const;
    template <int Dim, typename Visit>
    void visit_near(const Range& range,
                    const Vector<Dim>& point,
                    double& bound,
                    const Visit& visit) const;
    // A subtree and the box around it.
    struct Part {
        Range range;
        const Box& box;
    };
    template <typename Visit>
    static void visit_pairs(const BoxTree& first,
                            const Part& a,
                            const BoxTree& second,
                            const Part& b,
                            const Visit& visit);
    template <typename Visit>
    static void visit_self(const BoxTree& tree, const Range& range, const Visit& visit);

    std::vector<Node> nodes_;
    std::vector<std::uint32_t> leaves_;  // index of the box at each leaf
    Box root_{};
    double cost_ = 0;
};

}  // namespace pent::contact

#include <pent/contact/box_tree_queries.h>  // IWYU pragma: export
