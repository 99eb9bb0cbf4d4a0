#pragma once

#include <pent/contact/box.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace pent::contact {

/// Boxes around patches, of which there is a power of two, in the order in which their surface was
/// halved: a complete binary tree over these, without anything but boxes. The children of node k
/// are 2 k and 2 k + 1, and the root is node 1.
class PatchTree {
public:
    PatchTree() = default;

    /// Around the boxes of all patches.
    explicit PatchTree(const std::vector<Box>& patches) : nodes_(2 * patches.size()) {
        std::copy(patches.begin(), patches.end(), nodes_.begin() + first_leaf());
        for (std::size_t k = patches.size(); k-- > 1;) {
            nodes_[k] = hull(nodes_[2 * k], nodes_[2 * k + 1]);
        }
    }

    [[nodiscard]] std::size_t size() const { return nodes_.size() / 2; }

    [[nodiscard]] const Box& box(std::size_t patch) const { return nodes_[size() + patch]; }

    /// Calls visit(patch), ascending, for each whose box overlaps another.
    template <typename Visit>
    void for_each_overlap(const Box& box, const Visit& visit) const {
        if (!nodes_.empty() && overlap(nodes_[1], box)) {
            visit_node(1, box, visit);
        }
    }

    [[nodiscard]] std::int64_t bytes() const {
        return static_cast<std::int64_t>(nodes_.size() * sizeof(Box));
    }

private:
    [[nodiscard]] std::ptrdiff_t first_leaf() const { return static_cast<std::ptrdiff_t>(size()); }

    template <typename Visit>
    void visit_node(std::size_t k, const Box& box, const Visit& visit) const {
        if (k >= size()) {
            visit(static_cast<std::uint32_t>(k - size()));
            return;
        }
        for (const std::size_t child : {2 * k, 2 * k + 1}) {
            if (overlap(nodes_[child], box)) {
                visit_node(child, box, visit);
            }
        }
    }

    std::vector<Box> nodes_;  // the first is not used
};

}  // namespace pent::contact
