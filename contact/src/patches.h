#pragma once

#include <pent/contact/box_tree.h>
#include <pent/contact/surface.h>

#include <limits>
#include <vector>

namespace pent::contact {

/// How a patch of a surface has moved from rest. A point X of its simplices is now at
///
///     center + map (X - rest_center) + d,   |d| <= deviation.
template <int Dim>
struct PatchMotion {
    Vector<Dim> rest_center = Vector<Dim>::Zero();
    Vector<Dim> center = Vector<Dim>::Zero();
    Eigen::Matrix<double, Dim, Dim> map = Eigen::Matrix<double, Dim, Dim>::Zero();
    double least_stretch = 0;  ///< Smallest singular value of the map.
    double radius = 0;         ///< Farthest that |X - rest_center| gets, m.
    double deviation = std::numeric_limits<double>::infinity();  ///< m; infinite where not known.
};

/// Whether a point of one and a point of the other patch that are `rest_distance` apart at rest, or
/// more, are certainly more than `distance` apart now. Never true where something is not finite.
///
/// With G the mean of both maps, x - y is G (X - Y), which is no shorter than the rest distance
/// times the least stretch of G, and what the maps and centers lack to agree with G.
template <int Dim>
[[nodiscard]] bool stay_apart(const PatchMotion<Dim>& first,
                              const PatchMotion<Dim>& second,
                              double rest_distance,
                              double distance);

/// How many times a tree over so many simplices is halved to get patches.
[[nodiscard]] int patch_depth(std::size_t simplices);

/// The subtrees of a tree at patch_depth(), in the order of their leaves.
[[nodiscard]] std::vector<BoxTree::Range> patch_ranges(const BoxTree& tree);

/// How each patch of a tree, one of its patch_ranges(), has moved.
template <int Dim>
class Patches {
public:
    Patches() = default;

    /// Fits nothing yet.
    ///
    /// @param tree  Over the simplices, in their order.
    /// @param rest  Rest positions of all vertices of the scene.
    template <int Count>
    Patches(const Simplices<Count>& simplices, const BoxTree& tree, const PositionsView<Dim>& rest);

    /// Finds the motion of each patch: the affine map that fits its vertices best. Parallel.
    void fit(const PositionsView<Dim>& positions);

    /// In the order of their leaves; empty if there are no patches.
    [[nodiscard]] const std::vector<PatchMotion<Dim>>& motions() const { return motions_; }

    [[nodiscard]] std::int64_t bytes() const;

private:
    // What a patch is at rest.
    struct Rest {
        std::size_t begin = 0;  // its vertices: [begin, begin of the next)
        bool is_flat = false;   // across axes.col(0) there is nothing to fit to
        Eigen::Matrix<double, Dim, Dim> axes = Eigen::Matrix<double, Dim, Dim>::Zero();
    };

    void add(const std::vector<std::uint32_t>& vertices, const PositionsView<Dim>& rest);
    [[nodiscard]] PatchMotion<Dim> fit(std::size_t patch,
                                       const PositionsView<Dim>& positions) const;

    std::vector<Rest> patches_;  // and one more, for its begin
    std::vector<PatchMotion<Dim>> motions_;
    std::vector<std::uint32_t> vertices_;
    std::vector<Vector<Dim>> offsets_;  // of each vertex from the center at rest
    std::vector<Vector<Dim>> weights_;  // map = sum of position weight^T over the vertices
};

}  // namespace pent::contact
