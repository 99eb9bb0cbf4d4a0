#pragma once

#include <pent/simulator/scene.h>

namespace pent::simulator::test {

/// All of the body called "box" as one muscle, with fibers along one direction, of length 1: on
/// from the start, without a signal.
inline Activation muscle(double stretch, const Eigen::VectorXd& direction) {
    Activation activation;
    activation.body = "box";
    activation.select = {EverythingSelection{}};
    activation.stretch = stretch;
    activation.fibers = Fibers::Constant;
    activation.direction = direction;
    return activation;
}

}  // namespace pent::simulator::test
