#pragma once

#include "linear/sharing.h"

#include <algorithm>

namespace pent::simulator {

/// Exchange of ghosts and reductions over ranks for vectors over the dofs; without ranks, nothing.
struct Halo {
    const Sharing* sharing = nullptr;
    GhostExchange* ghosts = nullptr;  ///< Of the ghost columns of the matrix.

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
