#pragma once

#include <pent/simulator/motion.h>
#include <pent/simulator/selection.h>

#include <Eigen/Core>

#include <string>
#include <vector>

namespace pent::simulator {

/// Something that pushes a body from outside, on what is selected on placed positions at t = 0.
struct Load {
    std::string body;
    std::vector<Selection> select;  ///< A union.
    /// N, of constant direction: of all selected vertices together, each with a part like its mass.
    Eigen::VectorXd force = {};  ///< Empty is none.
    /// N/m^(Dim-1), against the outward normals, as they are now, of the facets of the boundary of
    /// which every vertex is selected.
    double pressure = 0;
    std::vector<Keyframe> keyframes = {};  ///< What both are multiplied by; none: 1.
    std::string source = {};  ///< Where its selection stands in a scene file; as Body::source.
};

}  // namespace pent::simulator
