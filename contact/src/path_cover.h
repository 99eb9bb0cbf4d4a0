#pragma once

#include <pent/contact/surface.h>

#include <Eigen/Core>

#include <algorithm>

namespace pent::contact {

/// Straight paths of some vertices, and how far each may leave its own: the positions that a list
/// of pairs holds for.
///
/// Only how vertices move against one another matters to pairs. So paths, and the ways that
/// vertices have gone from them, are measured less the mean of all: what flies or falls as a whole
/// does not move.
template <int Dim>
class PathCover {
public:
    using Vertices = Simplices<1>;

    /// Forgets all; nothing is covered then.
    void clear();

    /// Sets the paths of these vertices; others stay what they were.
    ///
    /// @param from, to       Of all vertices.
    /// @param inflation      How far any may leave its path, m.
    /// @param of_path        The same as a part of its path, where that is more.
    void set(const Vertices& vertices,
             const PositionsView<Dim>& from,
             const PositionsView<Dim>& to,
             double inflation,
             double of_path);

    /// Whether there is one time at which each of the vertices, but for a common shift, is within
    /// its inflation of where its path is.
    [[nodiscard]] bool covers(const Vertices& vertices, const PositionsView<Dim>& positions) const;

    /// How far any of the vertices gets from the ends of the paths, but for a common shift, on a
    /// straight way between two positions. Written to `of_vertex`; returns the largest.
    float displacement(const Vertices& vertices,
                       const PositionsView<Dim>& from,
                       const PositionsView<Dim>& to,
                       Eigen::VectorXf& of_vertex) const;

    [[nodiscard]] const Positions<Dim>& start() const { return start_; }
    [[nodiscard]] const Positions<Dim>& end() const { return end_; }
    [[nodiscard]] const Eigen::VectorXd& inflation() const { return inflation_; }

    /// The largest of the corners of a simplex.
    template <int Count>
    [[nodiscard]] double inflation_of(const Simplices<Count>& simplices, Eigen::Index i) const {
        double max = 0;
        for (int corner = 0; corner < Count; ++corner) {
            max = std::max(max, inflation_[simplices(corner, i)]);
        }
        return max;
    }

    [[nodiscard]] bool is_empty() const { return start_.cols() == 0; }
    [[nodiscard]] std::int64_t bytes() const {
        return static_cast<std::int64_t>(sizeof(double))
               * (start_.size() + end_.size() + inflation_.size());
    }

private:
    Positions<Dim> start_;
    Positions<Dim> end_;
    Eigen::VectorXd inflation_;  // m
};

/// Mean of b - a over some vertices; 0 of none.
template <int Dim>
[[nodiscard]] Vector<Dim> mean_shift(const Simplices<1>& vertices,
                                     const PositionsView<Dim>& a,
                                     const PositionsView<Dim>& b);

/// The longest way of any of the vertices from one place to another, less the mean of all, m.
template <int Dim>
[[nodiscard]] double longest_path(const Simplices<1>& vertices,
                                  const PositionsView<Dim>& from,
                                  const PositionsView<Dim>& to);

}  // namespace pent::contact
