#pragma once

#include <pent/contact/box_tree.h>

#include <vector>

namespace pent::contact {

/// A tree that is kept while its boxes move.
class RefitTree {
public:
    /// Fits the tree to boxes, or builds it anew where they are others or it has degraded.
    ///
    /// @return  Whether it was built anew.
    bool update(const std::vector<Box>& boxes) {
        if (tree_.size() == boxes.size() && !tree_.is_empty()) {
            tree_.refit(boxes);
            if (tree_.cost() <= kMaxCostGrowth * built_cost_) {
                return false;
            }
        }
        tree_ = BoxTree(boxes);
        built_cost_ = tree_.cost();
        return true;
    }

    [[nodiscard]] const BoxTree& tree() const { return tree_; }

private:
    // How much worse than when it was built a tree may get before it is built anew.
    static constexpr double kMaxCostGrowth = 1.5;

    BoxTree tree_;
    double built_cost_ = 0;
};

}  // namespace pent::contact
