#pragma once

#include <pent/simulator/material.h>
#include <pent/simulator/motion.h>

#include <Eigen/Core>

#include <limits>
#include <string>
#include <vector>

namespace pent::simulator {

/// One rotation of a placement.
struct Turn {
    Plane plane;
    double degrees = 0;
};

/// Where a mesh goes: scaled, then turned about the mesh's origin in the order given, then moved.
struct Placement {
    double scale = 1;  ///< > 0.
    std::vector<Turn> rotate;
    Eigen::VectorXd translate;  ///< m.
};

struct Body {
    std::string name;  ///< Letters, digits, '-' and '_': part of file names.
    std::string mesh;  ///< Path of a .pent file.
    Placement place;
    Material material;
    Eigen::VectorXd velocity;  ///< At the start, m/s; empty is zero.
    std::string recipe;  ///< Arguments of pent-mesh that make the mesh, paths relative to the scene
                         ///< file; for pent-study. The simulator does not use it.
    std::vector<Spin> spin;  ///< At the start, about the center of mass, added to the velocity.
    double friction =
        std::numeric_limits<double>::infinity();  ///< Coulomb's coefficient, >= 0; infinite: that
                                                  ///< of Contact.
    std::string source =
        {};  ///< Where its mesh stands in a scene file, as in "scene.toml:4:8", for messages;
             ///< empty if the scene was not read from a file.
};

}  // namespace pent::simulator
