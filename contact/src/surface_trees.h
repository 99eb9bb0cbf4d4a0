#pragma once

#include "refit_tree.h"

#include <pent/contact/surface.h>

#include <array>
#include <vector>

namespace pent::contact {

/// The trees of one surface: over its vertices, edges, ridges and facets, each built when it is
/// first needed. In R^3 ridges are edges, and have one tree.
template <int Dim>
class SurfaceTrees {
public:
    /// Fits the tree of the vertices.
    ///
    /// @param boxes  Around each vertex of the scene, and all that is to be near it; read for those
    ///               of the surface.
    void update_vertices(const Surface<Dim>& surface, const std::vector<Box>& boxes);

    /// Fits that of the facets.
    void update_facets(const Surface<Dim>& surface, const std::vector<Box>& boxes);

    /// Fits those of edges, ridges and facets.
    void update_faces(const Surface<Dim>& surface, const std::vector<Box>& boxes);

    template <int Count>
    [[nodiscard]] const BoxTree& tree() const {
        return trees_[Count - 1].tree();
    }

    /// What has been done to the trees so far.
    [[nodiscard]] std::int64_t built() const { return built_; }
    [[nodiscard]] std::int64_t refit() const { return refit_; }

    [[nodiscard]] std::int64_t bytes() const;

private:
    template <int Count>
    void update(const Surface<Dim>& surface, const std::vector<Box>& boxes);

    std::array<RefitTree, Dim> trees_;  // by corners, less one
    std::int64_t built_ = 0;
    std::int64_t refit_ = 0;
};

}  // namespace pent::contact
