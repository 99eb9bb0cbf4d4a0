#pragma once

#include <pent/contact/surface.h>

#include <algorithm>

namespace pent::contact {

/// Straight paths of all vertices of a scene from one position to another: `from` and `to` are the
/// same array where nothing moves.
template <int Dim>
struct Paths {
    const PositionsView<Dim>& from;
    const PositionsView<Dim>& to;
    Vector<Dim> drift = Vector<Dim>::Zero();  ///< What all have in common, m.

    /// How far each vertex may leave its path, m; null if none does.
    const Eigen::VectorXd* inflation = nullptr;

    [[nodiscard]] bool is_still() const { return from.data() == to.data(); }

    [[nodiscard]] double inflation_of(std::uint32_t vertex) const {
        return inflation == nullptr ? 0 : (*inflation)[vertex];
    }

    /// The largest of the corners of a simplex.
    template <int Count>
    [[nodiscard]] double inflation_of(const Simplices<Count>& simplices, Eigen::Index i) const {
        double most = 0;
        for (int corner = 0; corner < Count; ++corner) {
            most = std::max(most, inflation_of(simplices(corner, i)));
        }
        return most;
    }
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

/// Sets the inflation of some vertices: `least` (m), or a part of the path, less the drift of all,
/// where that is more.
///
/// @param inflation  Of each vertex of the scene, as many as there are; others stay what they were,
///                   so that several threads may each set those of a body.
template <int Dim>
void set_inflation(const Simplices<1>& vertices,
                   const Paths<Dim>& paths,
                   double least,
                   double of_path,
                   Eigen::VectorXd& inflation);

}  // namespace pent::contact
