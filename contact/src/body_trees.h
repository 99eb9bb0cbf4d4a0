#pragma once

#include <pent/contact/near_pairs.h>

namespace pent::contact {

/// The trees of one body's surface, each built when it is first needed.
template <int Dim>
class BodyTrees {
public:
    /// Fits the tree of the vertices around the positions and `margin`.
    void update_vertices(const Surface<Dim>& surface,
                         const PositionsView<Dim>& positions,
                         double margin) {
        update(vertices_, boxes_around<Dim, 1>(surface.vertices, positions, margin));
    }

    /// Fits those of edges, ridges and facets.
    void update_faces(const Surface<Dim>& surface,
                      const PositionsView<Dim>& positions,
                      double margin) {
        update(edges_, boxes_around<Dim, 2>(surface.edges, positions, margin));
        update(facets_, boxes_around<Dim, Dim>(surface.facets, positions, margin));
        if constexpr (Dim > 3) {
            update(ridges_, boxes_around<Dim, Dim - 1>(surface.ridges, positions, margin));
        }
    }

    /// What has been done to the trees so far.
    [[nodiscard]] std::int64_t built() const { return built_; }
    [[nodiscard]] std::int64_t refit() const { return refit_; }

    [[nodiscard]] std::int64_t bytes() const {
        return vertices_.tree.bytes() + edges_.tree.bytes() + ridges_.tree.bytes()
               + facets_.tree.bytes();
    }

    [[nodiscard]] const BoxTree& vertices() const { return vertices_.tree; }
    [[nodiscard]] const BoxTree& edges() const { return edges_.tree; }
    [[nodiscard]] const BoxTree& facets() const { return facets_.tree; }

    /// In R^3 the tree of the edges: ridges are edges there.
    [[nodiscard]] const BoxTree& ridges() const { return Dim > 3 ? ridges_.tree : edges_.tree; }

private:
    struct Tree {
        BoxTree tree;
        double built_cost = 0;
    };

    // How much worse than when it was built a tree may get before it is built anew.
    static constexpr double kWorn = 1.5;

    void update(Tree& tree, const std::vector<Box>& boxes) {
        if (tree.tree.size() == boxes.size()) {
            tree.tree.refit(boxes);
            ++refit_;
            if (tree.tree.cost() <= kWorn * tree.built_cost) {
                return;
            }
        }
        tree.tree = BoxTree(boxes);
        tree.built_cost = tree.tree.cost();
        ++built_;
    }

    Tree vertices_;
    Tree edges_;
    Tree ridges_;
    Tree facets_;
    std::int64_t built_ = 0;
    std::int64_t refit_ = 0;
};

}  // namespace pent::contact
