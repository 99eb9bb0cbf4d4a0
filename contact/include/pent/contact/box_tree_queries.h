#pragma once

// The function templates of BoxTree; box_tree.h includes this.
#include <pent/contact/box_tree.h>

#include <cstdint>

namespace pent::contact {

template <typename Visit>
void BoxTree::for_each_overlap(const Box& box, const Visit& visit) const {
    if (!is_empty() && overlap(root_, box)) {
        visit_box(root(), box, visit);
    }
}

template <typename Visit>
void BoxTree::visit_box(const Range& range, const Box& box, const Visit& visit) const {
    if (range.is_leaf()) {
        visit(leaves_[range.begin]);
        return;
    }
    const Node& node = nodes_[range.node];
    if (overlap(node.left, box)) {
        visit_box(range.left(), box, visit);
    }
    if (overlap(node.right, box)) {
        visit_box(range.right(), box, visit);
    }
}

template <int Dim, typename Visit>
void BoxTree::for_each_near(const Vector<Dim>& point, double bound, const Visit& visit) const {
    if (!is_empty() && distance_squared<Dim>(point, root_) <= bound) {
        visit_near<Dim>(root(), point, bound, visit);
    }
}

template <int Dim, typename Visit>
void BoxTree::visit_near(const Range& range,
                         const Vector<Dim>& point,
                         double& bound,
                         const Visit& visit) const {
    if (range.is_leaf()) {
        bound = visit(leaves_[range.begin]);
        return;
    }
    const Node& node = nodes_[range.node];
    const double left = distance_squared<Dim>(point, node.left);
    const double right = distance_squared<Dim>(point, node.right);
    const bool is_left_first = left <= right;
    if ((is_left_first ? left : right) <= bound) {
        visit_near<Dim>(is_left_first ? range.left() : range.right(), point, bound, visit);
    }
    if ((is_left_first ? right : left) <= bound) {
        visit_near<Dim>(is_left_first ? range.right() : range.left(), point, bound, visit);
    }
}

template <typename Visit>
void BoxTree::for_each_overlap(const BoxTree& first,
                               const BoxTree& second,
                               const Work& work,
                               const Visit& visit) {
    const bool is_self = &first == &second && work.first.begin == work.second.begin
                         && work.first.count == work.second.count;
    if (is_self) {
        visit_self(first, work.first, visit);
    } else {
        visit_pairs(first, {work.first, work.first_box}, second, {work.second, work.second_box},
                    visit);
    }
}

template <typename Visit>
void BoxTree::visit_pairs(
    const BoxTree& first, const Part& a, const BoxTree& second, const Part& b, const Visit& visit) {
    if (a.range.is_leaf()) {
        const std::uint32_t i = first.leaves_[a.range.begin];
        second.visit_box(b.range, a.box, [&](std::uint32_t j) { visit(i, j); });
        return;
    }
    if (b.range.is_leaf()) {
        const std::uint32_t j = second.leaves_[b.range.begin];
        first.visit_box(a.range, b.box, [&](std::uint32_t i) { visit(i, j); });
        return;
    }
    const Node& m = first.nodes_[a.range.node];
    const Node& n = second.nodes_[b.range.node];
    if (overlap(m.left, n.left)) {
        visit_pairs(first, {a.range.left(), m.left}, second, {b.range.left(), n.left}, visit);
    }
    if (overlap(m.left, n.right)) {
        visit_pairs(first, {a.range.left(), m.left}, second, {b.range.right(), n.right}, visit);
    }
    if (overlap(m.right, n.left)) {
        visit_pairs(first, {a.range.right(), m.right}, second, {b.range.left(), n.left}, visit);
    }
    if (overlap(m.right, n.right)) {
        visit_pairs(first, {a.range.right(), m.right}, second, {b.range.right(), n.right}, visit);
    }
}

template <typename Visit>
void BoxTree::visit_self(const BoxTree& tree, const Range& range, const Visit& visit) {
    if (range.is_leaf()) {
        return;
    }
    visit_self(tree, range.left(), visit);
    visit_self(tree, range.right(), visit);
    const Node& node = tree.nodes_[range.node];
    if (overlap(node.left, node.right)) {
        visit_pairs(tree, {range.left(), node.left}, tree, {range.right(), node.right}, visit);
    }
}

}  // namespace pent::contact
