#pragma once

#include "patches.h"
#include "refit_tree.h"

#include <array>
#include <vector>

namespace pent::contact {

/// Simplices of one body, a tree over boxes that hold them, in their order, and how the patches of
/// this tree have moved from rest.
template <int Dim, int Count>
struct PatchedSet {
    const Simplices<Count>& simplices;
    const BoxTree& tree;
    const std::vector<PatchMotion<Dim>>& motions;
};

/// The trees of one surface: over its vertices, edges, ridges and facets, each built when it is
/// first needed. In R^3 ridges are edges, and have one tree.
template <int Dim>
class SurfaceTrees {
public:
    /// Fits the tree of the vertices.
    ///
    /// @param boxes  Around each vertex of the scene, and all that is to be within reach of it;
    /// read for
    ///               those of the surface.
    void update_vertices(const Surface<Dim>& surface, const std::vector<Box>& boxes);

    /// Fits those of edges, ridges and facets.
    void update_faces(const Surface<Dim>& surface, const std::vector<Box>& boxes);

    /// Finds how the patches of these trees have moved from `rest`, both of all vertices of the
    /// scene.
    void update_patches(const Surface<Dim>& surface,
                        const PositionsView<Dim>& rest,
                        const PositionsView<Dim>& positions);

    template <int Count>
    [[nodiscard]] const BoxTree& tree() const {
        return trees_[Count - 1].fitted.tree();
    }

    /// What pairs within a body are found with, as of update_patches().
    template <int Count>
    [[nodiscard]] PatchedSet<Dim, Count> patched(const Surface<Dim>& surface) const {
        return {surface.template simplices<Count>(), tree<Count>(),
                trees_[Count - 1].patches.motions()};
    }

    /// What has been done to the trees so far.
    [[nodiscard]] std::int64_t built() const { return built_; }
    [[nodiscard]] std::int64_t refit() const { return refit_; }

    [[nodiscard]] std::int64_t bytes() const;

private:
    struct Tree {
        RefitTree fitted;
        Patches<Dim> patches;  // none if not of this tree any more
    };

    template <int Count>
    void update(const Surface<Dim>& surface, const std::vector<Box>& boxes);
    template <int Count>
    void update_patches_of(const Surface<Dim>& surface,
                           const PositionsView<Dim>& rest,
                           const PositionsView<Dim>& positions);

    std::array<Tree, Dim> trees_;  // by corners, less one
    std::int64_t built_ = 0;
    std::int64_t refit_ = 0;
};

}  // namespace pent::contact
