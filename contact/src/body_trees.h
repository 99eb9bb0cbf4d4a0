#pragma once

#include "fitted_tree.h"
#include "pairs_within.h"

#include <pent/contact/near_pairs.h>

#include <vector>

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

    /// Finds how the patches of these trees have moved from `rest`, both of all vertices of the scene.
    void update_patches(const Surface<Dim>& surface,
                        const PositionsView<Dim>& rest,
                        const PositionsView<Dim>& positions) {
        update_patches(vertices_, surface.vertices, rest, positions);
        update_patches(edges_, surface.edges, rest, positions);
        update_patches(facets_, surface.facets, rest, positions);
        if constexpr (Dim > 3) {
            update_patches(ridges_, surface.ridges, rest, positions);
        }
    }

    /// What has been done to the trees so far.
    [[nodiscard]] std::int64_t built() const { return built_; }
    [[nodiscard]] std::int64_t refit() const { return refit_; }

    [[nodiscard]] std::int64_t bytes() const {
        std::int64_t sum = 0;
        for (const Tree* tree : {&vertices_, &edges_, &ridges_, &facets_}) {
            sum += tree->fitted.tree().bytes() + tree->patches.bytes();
        }
        return sum;
    }

    [[nodiscard]] const BoxTree& vertices() const { return vertices_.fitted.tree(); }
    [[nodiscard]] const BoxTree& edges() const { return edges_.fitted.tree(); }
    [[nodiscard]] const BoxTree& facets() const { return facets_.fitted.tree(); }

    /// In R^3 the tree of the edges: ridges are edges there.
    [[nodiscard]] const BoxTree& ridges() const { return ridge_tree().fitted.tree(); }

    /// What pairs_within() takes, as of update_patches().
    [[nodiscard]] PatchedSet<Dim, 1> patched_vertices(const Surface<Dim>& surface) const {
        return patched(surface.vertices, vertices_);
    }
    [[nodiscard]] PatchedSet<Dim, 2> patched_edges(const Surface<Dim>& surface) const {
        return patched(surface.edges, edges_);
    }
    [[nodiscard]] PatchedSet<Dim, Dim - 1> patched_ridges(const Surface<Dim>& surface) const {
        return patched(surface.ridges, ridge_tree());
    }
    [[nodiscard]] PatchedSet<Dim, Dim> patched_facets(const Surface<Dim>& surface) const {
        return patched(surface.facets, facets_);
    }

private:
    struct Tree {
        FittedTree fitted;
        Patches<Dim> patches;  // none if not of this tree any more
    };

    [[nodiscard]] const Tree& ridge_tree() const { return Dim > 3 ? ridges_ : edges_; }

    void update(Tree& tree, const std::vector<Box>& boxes) {
        const bool is_new = tree.fitted.update(boxes);
        if (is_new) {
            tree.patches = Patches<Dim>();
        }
        built_ += is_new ? 1 : 0;
        refit_ += is_new ? 0 : 1;
    }

    template <int Count>
    static void update_patches(Tree& tree,
                               const Simplices<Count>& simplices,
                               const PositionsView<Dim>& rest,
                               const PositionsView<Dim>& positions) {
        if (tree.patches.motions().empty()) {
            tree.patches = Patches<Dim>(simplices, tree.fitted.tree(), rest);
        }
        tree.patches.fit(positions);
    }

    template <int Count>
    static PatchedSet<Dim, Count> patched(const Simplices<Count>& simplices, const Tree& tree) {
        return {simplices, tree.fitted.tree(), tree.patches.motions()};
    }

    Tree vertices_;
    Tree edges_;
    Tree ridges_;
    Tree facets_;
    std::int64_t built_ = 0;
    std::int64_t refit_ = 0;
};

}  // namespace pent::contact
