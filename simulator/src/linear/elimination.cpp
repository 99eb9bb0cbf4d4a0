#include "linear/elimination.h"

#include <algorithm>
#include <iterator>
#include <numeric>
#include <span>
#include <tuple>
#include <utility>

namespace pent::simulator {

namespace {

using Places = std::vector<std::uint32_t>;

// Relaxed supernodes: one is merged with its last child where at most this part of what they store
// together are zeros, or where together they have at most so many columns.
constexpr double kMaxZeros = 0.1;
constexpr std::uint32_t kNarrow = 4;

// So few dofs are not dissected any further.
constexpr std::size_t kLeaf = 24;

constexpr std::uint32_t kNone = 0xffffffffU;

Places inverse(const Places& order) {
    Places place(order.size());
    for (std::uint32_t k = 0; k < order.size(); ++k) {
        place[order[k]] = k;
    }
    return place;
}

Places ascending(std::size_t count) {
    Places order(count);
    std::iota(order.begin(), order.end(), 0U);
    return order;
}

class Dissection {
public:
    Dissection(const Links& links, const Eigen::Ref<const Eigen::MatrixXd>& places)
        : links_(links), places_(places), side_(links.size(), 0), order_(ascending(links.size())) {}

    Places run() {
        divide(order_);
        return std::move(order_);
    }

private:
    // Puts the dofs on one side of a cut first, then those on the other side, last the separator:
    // those of the other side that are linked to the first. Divides both sides in the same way.
    void divide(std::span<std::uint32_t> dofs) {
        const Eigen::Index axis = longest_axis(dofs);
        const auto at = [&](std::uint32_t dof) { return places_(axis, dof); };
        std::sort(dofs.begin(), dofs.end(), [&](std::uint32_t a, std::uint32_t b) {
            return std::make_pair(at(a), a) < std::make_pair(at(b), b);
        });
        auto cut =
            std::lower_bound(dofs.begin(), dofs.end(), at(dofs[dofs.size() / 2]),
                             [&](std::uint32_t dof, double value) { return at(dof) < value; });
        if (cut == dofs.begin()) {  // more than half of them have the least coordinate
            cut = std::find_if(cut, dofs.end(),
                               [&](std::uint32_t dof) { return at(dof) > at(dofs.front()); });
        }
        if (dofs.size() <= kLeaf || cut == dofs.end()) {
            return;
        }
        ++stamp_;
        std::for_each(dofs.begin(), cut, [&](std::uint32_t dof) { side_[dof] = stamp_; });
        const auto border = std::stable_partition(cut, dofs.end(), [&](std::uint32_t dof) {
            bool is_linked = false;
            links_.for_each(
                dof, [&](std::uint32_t other) { is_linked = is_linked || side_[other] == stamp_; });
            return !is_linked;
        });
        divide({dofs.begin(), cut});
        if (cut != border) {
            divide({cut, border});
        }
    }

    [[nodiscard]] Eigen::Index longest_axis(std::span<const std::uint32_t> dofs) const {
        Eigen::VectorXd low = places_.col(dofs[0]);
        Eigen::VectorXd high = low;
        for (const std::uint32_t dof : dofs) {
            low = low.cwiseMin(places_.col(dof));
            high = high.cwiseMax(places_.col(dof));
        }
        Eigen::Index axis = 0;
        (high - low).maxCoeff(&axis);
        return axis;
    }

    const Links& links_;
    const Eigen::Ref<const Eigen::MatrixXd>& places_;
    std::vector<std::uint32_t> side_;  // of each dof, the last cut with it on the first side
    std::uint32_t stamp_ = 0;
    Places order_;
};

// The elimination tree: the parent of a column is the first row below it in the factor
// [liu1990, 4].
Places elimination_tree(const Links& links, const Places& order, const Places& place) {
    Places parent(order.size(), kNone);
    Places ancestor(order.size(), kNone);
    for (std::uint32_t column = 0; column < order.size(); ++column) {
        links.for_each(order[column], [&](std::uint32_t other) {
            std::uint32_t at = place[other];
            while (at < column && ancestor[at] != column) {
                const std::uint32_t next = std::exchange(ancestor[at], column);
                if (next == kNone) {
                    parent[at] = column;
                    return;
                }
                at = next;
            }
        });
    }
    return parent;
}

// A postorder of the tree, in which every subtree is a range that ends with its root.
Places postorder(const Places& parent) {
    Places first_child(parent.size(), kNone);
    Places sibling(parent.size(), kNone);
    Places roots;
    for (auto node = static_cast<std::uint32_t>(parent.size()); node-- > 0;) {
        if (parent[node] == kNone) {
            roots.push_back(node);
        } else {
            sibling[node] = std::exchange(first_child[parent[node]], node);
        }
    }
    Places order;
    order.reserve(parent.size());
    for (auto root = roots.rbegin(); root != roots.rend(); ++root) {
        Places stack = {*root};
        while (!stack.empty()) {
            const std::uint32_t node = stack.back();
            if (first_child[node] != kNone) {
                stack.push_back(std::exchange(first_child[node], kNone));
                continue;
            }
            order.push_back(node);
            stack.pop_back();
            if (sibling[node] != kNone && node != *root) {
                stack.push_back(sibling[node]);
            }
        }
    }
    return order;
}

// Rows below a column of the factor: those of the matrix, and fill from its children's updates.
Places rows_below(const Links& links,
                  const Elimination& elimination,
                  std::uint32_t column,
                  const std::vector<const Places*>& children) {
    Places rows;
    links.for_each(elimination.order[column], [&](std::uint32_t other) {
        if (elimination.place[other] > column) {
            rows.push_back(elimination.place[other]);
        }
    });
    std::sort(rows.begin(), rows.end());
    Places all;
    for (const Places* child : children) {
        all.clear();
        std::set_union(rows.begin(), rows.end(),
                       std::upper_bound(child->begin(), child->end(), column), child->end(),
                       std::back_inserter(all));
        rows.swap(all);
    }
    return rows;
}

// Blocks of the lower triangle of a supernode.
double stored(double width, double rows) {
    return width * (width + 1) / 2 + width * rows;
}

class SupernodeMaker {
public:
    SupernodeMaker(const Links& links, Elimination& elimination)
        : links_(links), elimination_(elimination) {}

    // Every column begins as a supernode of its own, which then absorbs, one after another, the
    // child that ends right before it.
    void run(const Places& parent) {
        std::vector<std::vector<std::size_t>> children(parent.size());  // of each column: nodes
        for (std::uint32_t column = 0; column < parent.size(); ++column) {
            std::vector<const Places*> below;
            for (const std::size_t child : children[column]) {
                below.push_back(&nodes_[child].rows);
            }
            Supernode node{.begin = column,
                           .width = 1,
                           .rows = rows_below(links_, elimination_, column, below),
                           .parent = -1};
            double zeros = 0;
            while (!nodes_.empty() && !children[column].empty()
                   && children[column].back() == nodes_.size() - 1
                   && takes_up(node, zeros, nodes_.back())) {
                zeros = zeros_of(node, zeros, nodes_.back());
                node.begin = nodes_.back().begin;
                node.width += nodes_.back().width;
                children[column].pop_back();
                children[column].insert(children[column].end(), own_.back().begin(),
                                        own_.back().end());
                nodes_.pop_back();
                zeros_.pop_back();
                own_.pop_back();
            }
            if (parent[column] != kNone) {
                children[parent[column]].push_back(nodes_.size());
            }
            own_.push_back(std::move(children[column]));
            nodes_.push_back(std::move(node));
            zeros_.push_back(zeros);
        }
        for (std::size_t node = 0; node < nodes_.size(); ++node) {
            for (const std::size_t child : own_[node]) {
                nodes_[child].parent = static_cast<std::int64_t>(node);
            }
        }
        elimination_.supernodes = std::move(nodes_);
    }

private:
    // How many zeros are stored once a node has absorbed the last child.
    [[nodiscard]] double zeros_of(const Supernode& node,
                                  double zeros,
                                  const Supernode& child) const {
        const double more = static_cast<double>(node.width) + static_cast<double>(node.rows.size())
                            - static_cast<double>(child.rows.size());
        return zeros + zeros_.back() + child.width * more;
    }

    [[nodiscard]] bool takes_up(const Supernode& node, double zeros, const Supernode& child) const {
        const std::uint32_t width = node.width + child.width;
        const double all = stored(width, static_cast<double>(node.rows.size()));
        return width <= kNarrow || zeros_of(node, zeros, child) <= kMaxZeros * all;
    }

    const Links& links_;
    Elimination& elimination_;
    std::vector<Supernode> nodes_;
    std::vector<double> zeros_;                  // stored in each node
    std::vector<std::vector<std::size_t>> own_;  // children of each node
};

void count_costs(Elimination& elimination) {
    std::vector<std::int64_t> waiting(elimination.supernodes.size(), 0);  // updates of children
    std::int64_t updates = 0;
    for (std::size_t s = 0; s < elimination.supernodes.size(); ++s) {
        const Supernode& node = elimination.supernodes[s];
        const auto width = static_cast<std::int64_t>(node.width);
        const auto rows = static_cast<std::int64_t>(node.rows.size());
        elimination.blocks += width * (width + rows);
        updates += rows * rows;
        elimination.peak_blocks = std::max(elimination.peak_blocks, elimination.blocks + updates);
        updates -= waiting[s];
        if (node.parent >= 0) {
            waiting[static_cast<std::size_t>(node.parent)] += rows * rows;
        }
        const auto w = static_cast<double>(width);
        const auto m = static_cast<double>(rows);
        elimination.products += w * w * w / 6 + w * w * m / 2 + w * m * m / 2;
    }
}

// Products that a profile factorization in the order of the dofs takes: a cheap upper bound, as if
// no block was zero between the first one of each row and the diagonal.
double products_in_profile(const Links& links) {
    double products = 0;
    for (std::uint32_t row = 0; row < links.size(); ++row) {
        std::uint32_t first = row;
        links.for_each(row, [&](std::uint32_t other) { first = std::min(first, other); });
        const auto before = static_cast<double>(row - first);
        products += before * (before + 1) / 2;
    }
    return products;
}

}  // namespace

Elimination eliminate(const Links& links, const Eigen::Ref<const Eigen::MatrixXd>& places) {
    if (links.size() == 0) {
        return {};
    }
    Elimination dissected = eliminate(links, Dissection(links, places).run());
    if (products_in_profile(links) < dissected.products) {
        Elimination in_order = eliminate(links, ascending(links.size()));
        if (in_order.products < dissected.products) {
            return in_order;
        }
    }
    return dissected;
}

Elimination eliminate(const Links& links, const std::vector<std::uint32_t>& order) {
    const Places post = postorder(elimination_tree(links, order, inverse(order)));
    Elimination elimination;
    elimination.order.reserve(order.size());
    for (const std::uint32_t place : post) {
        elimination.order.push_back(order[place]);
    }
    elimination.place = inverse(elimination.order);
    SupernodeMaker(links, elimination)
        .run(elimination_tree(links, elimination.order, elimination.place));
    count_costs(elimination);
    return elimination;
}

}  // namespace pent::simulator
