#pragma once

#include <pent/contact/contact_model.h>
#include <pent/simulator/solver_options.h>
#include <pent/simulator/words.h>

#include <array>
#include <string>
#include <vector>

namespace pent::simulator {

/// How bodies that touch push each other; a barrier not with the linear Euler integrator.
using contact::ContactModel;
template <>
inline constexpr std::array kWords<ContactModel> = {
    Word<ContactModel>{ContactModel::Penalty, "penalty"},
    Word<ContactModel>{ContactModel::Barrier, "barrier"},
};

/// Two bodies by their names, in any order; one twice for what it does to itself.
struct BodyPair {
    std::string first;
    std::string second;
};

/// Contact between bodies, and within them if asked.
struct ContactSettings {
    ContactModel model = ContactModel::Penalty;
    double distance = 0.02;   ///< m, > 0: how near is in contact; a quarter of an edge is good.
    double stiffness = 1000;  ///< N/m for each pair, > 0; a barrier raises it where it has to.
    bool self = false;        ///< Whether bodies meet themselves.
    Filter filter = Filter::Clamp;
    double separation = 0;     ///< m, >= 0: a distance that a barrier never lets be reached.
    double friction = 0;       ///< Coulomb's coefficient, >= 0; of bodies and obstacles. Of two
                               ///< with coefficients of their own it is the geometric mean.
    double slip_speed = 1e-3;  ///< m/s, > 0: what slides slower than that sticks.
    std::vector<BodyPair> ignore = {};  ///< Pairs that do not see each other.
    std::vector<BodyPair> only = {};    ///< If there are any, no other pair sees each other.
};

}  // namespace pent::simulator
