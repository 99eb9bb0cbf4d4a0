#pragma once

#include <pent/simulator/material.h>
#include <pent/simulator/motion.h>
#include <pent/simulator/selection.h>

#include <Eigen/Core>

#include <limits>
#include <string>
#include <vector>

namespace pent::simulator {

/// Where a mesh goes: scaled, then turned about the mesh's origin in the order given, then moved.
struct Placement {
    double scale = 1;  ///< > 0.
    std::vector<Turn> rotate;
    Eigen::VectorXd translate;  ///< m.
};

/// Cells of a body that are of another material.
struct Region {
    std::string name;  ///< As of a body; used once in it.
    std::vector<Selection>
        select;  ///< A union, on placed positions at t = 0; of cells, see select_cells().
    Material material;
    std::string source = {};  ///< Where its selection stands in a scene file; as Body::source.
};

struct Body {
    std::string name;  ///< Letters, digits, '-' and '_': part of file names.
    std::string mesh;  ///< Path of a .pent file.
    Placement place;
    Material material;         ///< Where no region says otherwise.
    Eigen::VectorXd velocity;  ///< At the start, m/s; empty is zero.
    std::string recipe;  ///< Arguments of pent-mesh that make the mesh, paths relative to the scene
                         ///< file; for pent-study. The simulator does not use it.
    std::vector<Spin> spin;  ///< At the start, about the center of mass, added to the velocity.
    double friction =
        std::numeric_limits<double>::infinity();  ///< Coulomb's coefficient, >= 0; infinite: that
                                                  ///< of ContactSettings.
    std::vector<Region> regions = {};             ///< Of what two select the later one has it.
    std::string source =
        {};  ///< Where its mesh stands in a scene file, as in "scene.toml:4:8", for messages;
             ///< empty if the scene was not read from a file.
};

}  // namespace pent::simulator
