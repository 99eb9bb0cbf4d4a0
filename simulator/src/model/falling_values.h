#pragma once

#include <pent/simulator/mesh_share.h>

#include <Eigen/Core>

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

namespace pent::simulator {

/// Numbers of the vertices of a mesh that only ever fall until they are right (distances, depths),
/// each found by the rank that owns the vertex from those at the corners of its cells. Where a rank
/// has finished with what it knows it takes over what others have found, and goes on, until nothing
/// falls on any of them.
class FallingValues {
public:
    template <int Dim>
    explicit FallingValues(const MeshShare<Dim>& share)
        : FallingValues(
            share.ranks,
            share.owners,
            {share.mesh.cells.data(), static_cast<std::size_t>(share.mesh.cells.size())}) {}

    /// Gives vertices of others at cells of this rank the values that their ranks have. Returns
    /// those that fell.
    [[nodiscard]] std::vector<std::uint32_t> take_over(Eigen::VectorXd& values);

    /// Whether it is so on any rank.
    [[nodiscard]] bool any(bool is_so) const;

private:
    FallingValues(const Ranks* ranks,
                  std::span<const std::uint32_t> owners,
                  std::span<const std::uint32_t> corners);

    const Ranks* ranks_ = nullptr;
    std::vector<std::uint32_t> own_;     // vertices of this rank
    std::vector<std::uint32_t> ghosts_;  // vertices of others at cells of this rank
    std::unique_ptr<GhostExchange> exchange_;
    Eigen::VectorXd columns_;  // of own vertices, then of ghosts
};

}  // namespace pent::simulator
