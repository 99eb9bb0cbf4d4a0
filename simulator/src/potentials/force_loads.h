#pragma once

#include "model/bodies.h"
#include "potentials/potential.h"

#include <cstdint>
#include <utility>
#include <vector>

namespace pent::simulator {

/// Forces of given size and direction on vertices, wherever these go: - sum of f . x. Each vertex
/// that a [[load]] with a force selects has a part of that force in proportion to its mass, so that
/// the force acts at their center of mass. A host may add forces of its own.
template <int Dim>
class ForceLoads final : public Potential<Dim> {
public:
    /// @param bodies  Placed; not needed afterwards.
    ForceLoads(const Scene& scene, const Bodies<Dim>& bodies);

    [[nodiscard]] bool is_empty() const { return loads_.empty() && of_host_.cols() == 0; }

    /// Dim x vertices, N; no columns for none.
    void set_of_host(Positions<Dim> forces) { of_host_ = std::move(forces); }
    [[nodiscard]] const Positions<Dim>& of_host() const { return of_host_; }

    [[nodiscard]] bool set_time(const TimeSpan& step) override;
    void add_couplings(Couplings& couplings) const override;
    [[nodiscard]] double evaluate(const Positions<Dim>& x, Positions<Dim>& gradient) override;
    void add_hessian(const Positions<Dim>& /*x*/,
                     double /*weight*/,
                     Filter /*filter*/,
                     NewtonSystem<Dim>& /*system*/) override {}
    [[nodiscard]] std::vector<TermEnergy> energies() const override {
        return is_empty() ? std::vector<TermEnergy>() : std::vector<TermEnergy>{{"force", energy_}};
    }

private:
    // The forces of one load.
    struct VertexForces {
        std::size_t body = 0;
        std::vector<std::uint32_t> vertices;
        Positions<Dim> forces;  // Dim x vertices of the load, N
        std::vector<Keyframe> keyframes;
        double factor = 1;
        bool is_changing = false;  // in the step
    };

    std::vector<VertexForces> loads_;
    Positions<Dim> of_host_ = Positions<Dim>(Dim, 0);
    double energy_ = 0;
};

}  // namespace pent::simulator
