#pragma once

#include "fields.h"

#include <pent/mesher/solid.h>

#include <vector>

namespace pent::mesher {

/// Where the function of a solid is below some level above 0, which is what a blend may add to the
/// body: within the bounds grown by `factor` times the level.
struct Reach {
    double factor = 1;  ///< Infinite where small values may be anywhere.
    bool is_round =
        false;  ///< Holds after any rotation, as of a distance; else corners reach further.
};

/// A tree of minima and maxima over fields in places of their own.
struct Solid::Data {
    struct Leaf {
        Field field;
        Eigen::Matrix4d to_field = Eigen::Matrix4d::Identity();
        Eigen::Vector4d offset = Eigen::Vector4d::Zero();
        double factor = 1;  ///< Of the value: the scale, negative for the outside.
        int first_piece = 0;

        [[nodiscard]] Eigen::Vector4d local(const Eigen::Vector4d& p) const {
            return to_field * p + offset;
        }

        /// The other way: `to_field` is a rotation over the scale.
        [[nodiscard]] Eigen::Vector4d placed(const Eigen::Vector4d& own) const {
            return factor * factor * (to_field.transpose() * (own - offset));
        }
    };
    enum class Op { Min, Max };
    struct Node {
        Op op = Op::Min;
        double smooth = 0;
        int left = 0;  ///< A node, or a leaf as ~leaf.
        int right = 0;
        int piece = 0;  ///< The one where the two blend.
    };

    std::vector<Leaf> leaves;
    std::vector<Node> nodes;
    int root = 0;
    int pieces = 0;
    Box4 bounds;
    Reach reach;
    double smallest_width = 0;
};

/// One primitive.
///
/// @param bounds          Of what is inside, infinite where it has none.
/// @param smallest_width  See Solid::smallest_width().
/// @param reach           Around these bounds.
[[nodiscard]] Solid solid_of(Field field,
                             const Box4& bounds,
                             double smallest_width,
                             const Reach& reach);

}  // namespace pent::mesher
