#pragma once

#include <pent/simulator/motion.h>
#include <pent/simulator/selection.h>
#include <pent/simulator/words.h>

#include <Eigen/Core>

#include <array>
#include <string>
#include <vector>

namespace pent::simulator {

/// How much of an activation is there at a time.
enum class Signal {
    Constant,  ///< 1.
    Sine,      ///< Up and down between 0 and 1: (1 + sin(2 pi phase)) / 2.
    Pulses,    ///< 1 during `duty` of each period, with smooth flanks; else 0.
};
template <>
inline constexpr std::array kWords<Signal> = {
    Word<Signal>{Signal::Constant, "constant"},
    Word<Signal>{Signal::Sine, "sine"},
    Word<Signal>{Signal::Pulses, "pulses"},
};

/// Which way the fibers of an activation run.
enum class Fibers {
    None,      ///< It is the same in all directions: growth.
    Constant,  ///< Along `direction` at t = 0; they turn with the body.
    Mesh,      ///< As the mesh says for each cell.
    Distance,  ///< Along the shortest way within the body from what `away_from` selects.
};
template <>
inline constexpr std::array kWords<Fibers> = {
    Word<Fibers>{Fibers::None, "none"},
    Word<Fibers>{Fibers::Constant, "constant"},
    Word<Fibers>{Fibers::Mesh, "mesh"},
    Word<Fibers>{Fibers::Distance, "distance"},
};

/// A muscle, or growth: makes what is selected of a body want another shape.
///
/// The deformation F of a cell is Fe Fa, and its energy that of its material at Fe for each volume
/// of the activated shape, det Fa psi(F Fa^-1) [nardinocchi2007]. With s = 1 + u (stretch - 1), u
/// being the signal, Fa stretches by s along the fibers, and across them by 1, or, if it preserves
/// volume, by s^(-1 / (Dim - 1)); without fibers by s in all directions.
struct Activation {
    std::string body;
    std::vector<Selection> select;  ///< A union; of cells, as of a Region.
    double stretch = 1;             ///< > 0: of the fully active fiber, over its length at rest.
    Fibers fibers = Fibers::None;
    Eigen::VectorXd direction = {};         ///< Of Fibers::Constant, unit length.
    std::vector<Selection> away_from = {};  ///< Of Fibers::Distance; a union of vertices.
    bool preserves_volume = false;
    Signal signal = Signal::Constant;
    double frequency = 1;       ///< Hz, > 0; of sine and pulses.
    double phase = 0;           ///< Periods that the signal is ahead.
    double duty = 0.5;          ///< Of pulses, in (0, 1).
    Eigen::VectorXd wave = {};  ///< Periods per m by which it is later along an axis, at rest.
    double distance_wave = 0;   ///< The same for each m of distance; of Fibers::Distance.
    std::vector<Keyframe> keyframes = {};  ///< What the signal is multiplied by; none: 1.
    std::string source = {};  ///< Where its selection stands in a scene file; as Body::source.
};

}  // namespace pent::simulator
