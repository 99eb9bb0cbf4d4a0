#pragma once

#include "candidate.h"
#include "paths.h"

#include <pent/contact/surface.h>

#include <Eigen/Core>

namespace pent::contact {

/// Straight paths of some vertices, and how far each may leave its own: the positions for which a
/// list of pairs is complete.
///
/// Only how vertices move against one another matters to pairs. So paths, and the ways that
/// vertices have gone from them, are measured less the mean of all: what flies or falls as a whole
/// does not move.
template <int Dim>
class PathCover {
public:
    /// Without vertices: covers all positions.
    PathCover() = default;

    /// @param vertices  Those of the scene that count.
    /// @param paths     With their inflation.
    PathCover(Simplices<1> vertices, const Paths<Dim>& paths);

    /// Whether there is one time at which each of the vertices, but for a common shift, is within
    /// its inflation of where its path is.
    [[nodiscard]] bool covers(const PositionsView<Dim>& positions) const;

    /// How far each of the vertices gets from the end of its path, but for a common shift, on a
    /// straight way between two positions.
    ///
    /// @param displacement  With a place for each.
    void find_displacement(const PositionsView<Dim>& from,
                           const PositionsView<Dim>& to,
                           Displacement& displacement) const;

    /// The longest path, m.
    [[nodiscard]] double longest_path() const { return longest_path_; }

    /// How far the farthest of the vertices is from the end of its path, m.
    [[nodiscard]] double farthest_from_end(const PositionsView<Dim>& positions) const;

    [[nodiscard]] const Simplices<1>& vertices() const { return vertices_; }
    [[nodiscard]] std::int64_t bytes() const;

private:
    [[nodiscard]] Vector<Dim> mean(const PositionsView<Dim>& positions) const;
    [[nodiscard]] Vector<Dim> mean_of_sum(const Vector<Dim>& sum) const;
    [[nodiscard]] double squared_from_end(const PositionsView<Dim>& positions,
                                          const Vector<Dim>& mean,
                                          Eigen::Index k) const;

    // In the order of the vertices; starts and ways less the mean of all.
    Simplices<1> vertices_;
    Positions<Dim> start_;       // of the paths
    Positions<Dim> way_;         // from start to end
    Eigen::VectorXd inflation_;  // m
    double longest_path_ = 0;    // m
    double squared_ways_ = 0;    // the sum of their squares, m^2
};

}  // namespace pent::contact
