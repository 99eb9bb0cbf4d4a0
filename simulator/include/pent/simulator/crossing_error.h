#pragma once

#include <pent/error.h>
#include <pent/simplex_mesh.h>

#include <utility>

namespace pent::simulator {

/// Bodies that a barrier is to keep apart cross, touch or are inside one another from the start.
/// The message names the first pairs.
template <int Dim>
class CrossingError : public Error {
public:
    CrossingError(const std::string& message, SimplexMesh<Dim> offenders)
        : Error(message), offenders_(std::move(offenders)) {}

    /// The cells that the pairs are part of, where they are; one region for each body.
    [[nodiscard]] const SimplexMesh<Dim>& offenders() const { return offenders_; }

private:
    SimplexMesh<Dim> offenders_;
};

}  // namespace pent::simulator
