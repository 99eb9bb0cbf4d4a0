#pragma once

#include "kernels/kernels.h"
#include "model/active_strain.h"
#include "model/bodies.h"
#include "model/held_vertices.h"
#include "potentials/element_layout.h"
#include "potentials/potential.h"

#include <pent/parallel.h>

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

namespace pent::simulator {

/// The elastic energy of all bodies.
///
/// Elements without a free corner have no part in what a step minimizes: the solve does not change
/// them. They are evaluated between steps, for reports, and only where something may strain them,
/// see is_held_and_strained(). Those of bodies that sleep keep the energy and the forces with which
/// these fell asleep.
template <int Dim>
class Elasticity final : public Potential<Dim> {
public:
    /// @param workers, kernels, bodies  Must outlive this.
    /// @param held   At the start; not needed afterwards.
    /// @param scene  Of which the bodies have been made. Throws as ActiveStrain does.
    Elasticity(const Workers& workers,
               const Kernels<Dim>& kernels,
               const Bodies<Dim>& bodies,
               const HeldVertices<Dim>& held,
               const Scene& scene);

    /// Lays elements out anew.
    ///
    /// @param dofs       Of the bodies that are awake.
    /// @param asleep     One entry a body.
    /// @param positions  Dim x vertices: where sleeping bodies lie, m.
    void set_dofs(const DofMap& dofs,
                  const HeldVertices<Dim>& held,
                  const std::vector<bool>& asleep,
                  const Positions<Dim>& positions);

    /// Factor on the Hessian alone: how Rayleigh damping enters a step of a single linear solve.
    void set_hessian_factor(double factor) { hessian_factor_ = factor; }

    [[nodiscard]] double evaluate(const Positions<Dim>& x, Positions<Dim>& gradient) override;
    void add_hessian(const Positions<Dim>& x,
                     double weight,
                     Filter filter,
                     NewtonSystem<Dim>& system) override;
    [[nodiscard]] std::vector<TermEnergy> energies() const override {
        return {{"elastic", energy_.energy + held_.energy.energy}};
    }
    [[nodiscard]] bool set_time(const TimeSpan& step) override;
    void add_couplings(Couplings& couplings) const override;
    [[nodiscard]] double rounding() const override;

    /// The work of activations on bodies that go from one place to another in a step, J: what the
    /// change of rest shapes alone changes of the energy, as the mean of that at both places.
    [[nodiscard]] double activation_work(const Positions<Dim>& from,
                                         const Positions<Dim>& to,
                                         const TimeSpan& step);
    [[nodiscard]] const ActiveStrain<Dim>& strain() const { return strain_; }

    /// Evaluates the elements without a free corner.
    void evaluate_held(const Positions<Dim>& x);

    /// Their gradient, Dim x vertices, N; empty if there are none.
    [[nodiscard]] const Positions<Dim>& held_gradient() const { return held_.gradient; }

    /// Adds the Hessian at positions x to a matrix on pattern(), and takes that of vertices that
    /// have no dof and move by `displacement` (Dim x vertices, m) off `right` (Dim x dofs).
    void add_tangent(const Positions<Dim>& x,
                     Filter filter,
                     const Positions<Dim>& displacement,
                     BlockMatrix<Dim, double>& matrix,
                     BlockVector<Dim>& right) const;

    /// The pattern of the matrix of the elements: never rewritten, but replaced by set_dofs().
    [[nodiscard]] const std::shared_ptr<const BlockPattern>& pattern() const { return pattern_; }
    /// J: of elements that a step may change.
    [[nodiscard]] double energy() const { return energy_.energy; }
    /// Of all elements: what is collapsed, and J.
    [[nodiscard]] std::int64_t collapsed() const {
        return energy_.collapsed + held_.energy.collapsed;
    }
    [[nodiscard]] std::vector<double> energy_of_ranges() const;
    [[nodiscard]] std::int64_t inverted_cells(const Positions<Dim>& x) const;

    // Of all ranks together.
    [[nodiscard]] std::int64_t element_count() const { return size_.elements; }
    [[nodiscard]] std::int64_t block_count() const { return size_.blocks; }
    [[nodiscard]] std::int64_t bytes() const { return size_.bytes + held_.bytes; }

    /// Vertices of other ranks that the matrix has columns of.
    [[nodiscard]] std::int64_t ghost_count() const { return ghost_count_; }

    /// Elements of this rank whose Hessian the filter has changed, the last time it was added.
    [[nodiscard]] std::int64_t filtered() const { return filtered_; }

private:
    [[nodiscard]] ElementLayout<Dim> lay_out(const DofMap& dofs,
                                             const Grips* grips = nullptr) const;
    void take(ElementLayout<Dim> layout);
    void lay_out_held(const HeldVertices<Dim>& held);
    void activate();
    [[nodiscard]] ElasticEnergy add_shared(ElasticEnergy energy,
                                           Positions<Dim>& own,
                                           Positions<Dim>& gradient) const;
    [[nodiscard]] double energy_at(const Positions<Dim>& x, double time);

    const Workers* workers_;
    const Kernels<Dim>* kernels_;
    const Bodies<Dim>* bodies_;
    ElementKind kind_;
    ActiveStrain<Dim> strain_;
    TimeSpan step_;  // rest shapes are those of its end
    std::shared_ptr<const BlockPattern> pattern_;
    std::optional<Elements<Dim>> elements_;  // on the pattern; always set
    struct {
        std::int64_t elements = 0;
        std::int64_t blocks = 0;
        std::int64_t bytes = 0;
    } size_;  // of all ranks together
    std::int64_t ghost_count_ = 0;
    // The part of bodies that sleep, which does not change.
    Positions<Dim> frozen_gradient_;  // Dim x vertices, N; empty if none sleeps
    ElasticEnergy frozen_;
    ElasticEnergy energy_;
    // Elements without a free corner: those that something may strain, none on most scenes.
    struct {
        Grips grips;
        std::optional<Elements<Dim>> elements;
        Positions<Dim> gradient;  // as held_gradient()
        ElasticEnergy energy;
        std::int64_t bytes = 0;  // of all ranks together
    } held_;
    double hessian_factor_ = 1;
    std::int64_t filtered_ = 0;
};

}  // namespace pent::simulator
