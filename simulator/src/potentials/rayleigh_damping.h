#pragma once

#include "potentials/elasticity.h"
#include "potentials/potential.h"

#include <cstdint>
#include <memory>
#include <utility>

namespace pent::simulator {

/// The part of Rayleigh damping that is proportional to stiffness: 1/2 |x - origin|_K^2, K being
/// the elastic tangent at the start of the step.
///
/// A step of a single linear solve has that tangent in its matrix already: there this term is zero,
/// and a factor on the elastic Hessian takes its place, see Elasticity::set_hessian_factor().
template <int Dim>
class RayleighDamping final : public Potential<Dim> {
public:
    /// @param workers, kernels, elasticity, sharing  Must outlive this.
    RayleighDamping(const Workers& workers,
                    const BlockKernels& kernels,
                    const Elasticity<Dim>& elasticity,
                    std::shared_ptr<const DofMap> dofs,
                    const Sharing& sharing,
                    Filter filter)
        : workers_(&workers),
          kernels_(&kernels),
          elasticity_(&elasticity),
          dofs_(std::move(dofs)),
          sharing_(&sharing),
          filter_(filter) {}

    /// The dofs from the next step on.
    void set_dofs(std::shared_ptr<const DofMap> dofs) {
        dofs_ = std::move(dofs);
        tangent_.reset();
        pattern_.reset();
    }

    [[nodiscard]] bool begin_step(const StepStart<Dim>& start) override;
    [[nodiscard]] double evaluate(const Positions<Dim>& x, Positions<Dim>& gradient) override;
    void add_hessian(const Positions<Dim>& x,
                     double weight,
                     Filter filter,
                     NewtonSystem<Dim>& system) override;

    /// Whether this step has a tangent of its own.
    [[nodiscard]] bool has_tangent() const { return is_on_; }

    /// Elements assembled for tangents since this was last asked.
    [[nodiscard]] std::int64_t take_hessians();
    [[nodiscard]] std::int64_t tangent_blocks() const {
        return tangent_ ? tangent_->pattern().blocks() : 0;
    }

private:
    const Workers* workers_;
    const BlockKernels* kernels_;
    const Elasticity<Dim>* elasticity_;
    std::shared_ptr<const DofMap> dofs_;
    const Sharing* sharing_;
    Filter filter_;
    Positions<Dim> origin_;  // of the step
    bool is_on_ = false;
    std::shared_ptr<const BlockPattern> pattern_;
    std::unique_ptr<BlockMatrix<Dim, double>> tangent_;  // on it
    BlockVector<Dim> dirichlet_part_;  // Dim x dofs: K times how far Dirichlet vertices move
    std::int64_t hessians_ = 0;
};

}  // namespace pent::simulator
