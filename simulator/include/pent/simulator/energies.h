#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace pent::simulator {

/// A named part of the energy of a scene.
struct TermEnergy {
    std::string name;   ///< "elastic", "contact" and so on.
    double energy = 0;  ///< J.
    bool is_stored =
        true;  ///< Whether it can be recovered; that of friction, for line searches only, cannot.
};

/// Energies of a state, J: that of motion, and one for each part of the model that is there.
struct Energies {
    double kinetic = 0;
    std::vector<TermEnergy>
        terms;  ///< "elastic", "gravity", "contact", "obstacle", "friction", ...

    /// Energy of a term by its name; 0 where the model has no such part.
    [[nodiscard]] double of(std::string_view name) const {
        for (const TermEnergy& term : terms) {
            if (term.name == name) {
                return term.energy;
            }
        }
        return 0;
    }

    /// Kinetic and all that is stored.
    [[nodiscard]] double total() const {
        double sum = kinetic;
        for (const TermEnergy& term : terms) {
            sum += term.is_stored ? term.energy : 0;
        }
        return sum;
    }
};

}  // namespace pent::simulator
