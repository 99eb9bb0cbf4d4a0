#pragma once

#include "linear/sharing.h"

#include <algorithm>

namespace pent::simulator {

/// What other ranks have to do with vectors over the dofs; nothing, where there are none.
struct Halo {
    const Sharing* sharing = nullptr;
    GhostExchange* ghosts = nullptr;  ///< Of the columns of others that the matrix has.

    [[nodiscard]] double sum(double value) const {
        return sharing != nullptr ? sharing->sum(value) : value;
    }
    [[nodiscard]] double max(double value) const {
        if (sharing == nullptr) {
            return value;
        }
        const std::vector<double> all = sharing->list(value);
        return *std::max_element(all.begin(), all.end());
    }
    template <int Dim>
    void update(Positions<Dim>& x) const {
        if (ghosts != nullptr) {
            ghosts->update(x.data(), Dim);
        }
    }
};

}  // namespace pent::simulator
