#pragma once

#include "model/bodies.h"
#include "model/held_vertices.h"
#include "potentials/potential.h"

#include <pent/parallel.h>

#include <cstdint>
#include <vector>

namespace pent::simulator {

/// Pressure on parts of the boundaries of bodies, which follows them as they move: a force of
/// -pressure n on each unit of a facet as it is now, n being its outward normal.
///
/// On a closed surface that is minus the gradient of pressure times the volume V inside. A surface
/// with a rim is closed by walls: facets from the ridges of the rim to an apex, the mean of the
/// rim's vertices at the start of a step, which does not move. The gradient of pressure times the
/// volume inside is right at every vertex but those of the rim; these feel the pressure on the
/// walls in addition. That additional force, as it is at the start of a step, is taken off again:
///
///     E(x) = p V(x) - (p dV_walls(x_start)) . (x - x_start).
///
/// So pressure has the right size and direction at the start of each step, as friction has, and
/// within the step follows whatever moves but the walls.
template <int Dim>
class PressureLoads final : public Potential<Dim> {
public:
    /// @param workers  Must outlive this.
    /// @param bodies, held  At the start; not needed afterwards.
    ///
    /// Throws an Error where a load selects no whole facet of the boundary.
    PressureLoads(const Workers& workers,
                  const Scene& scene,
                  const Bodies<Dim>& bodies,
                  const HeldVertices<Dim>& held);

    [[nodiscard]] bool is_empty() const { return pressed_.empty(); }

    [[nodiscard]] bool set_time(const TimeSpan& step) override;
    void add_couplings(Couplings& couplings) const override;
    [[nodiscard]] bool begin_step(const StepStart<Dim>& start) override;
    [[nodiscard]] double evaluate(const Positions<Dim>& x, Positions<Dim>& gradient) override;
    void add_hessian(const Positions<Dim>& x,
                     double weight,
                     Filter filter,
                     NewtonSystem<Dim>& system) override;
    [[nodiscard]] std::vector<TermEnergy> energies() const override;
    [[nodiscard]] double rounding() const override { return rounding_; }

private:
    using Point = Eigen::Matrix<double, Dim, 1>;

    // Corners are vertices of all bodies counted through, or kNoVertex for the apex.
    struct PressedSurface {
        std::size_t body = 0;
        Simplices<Dim> facets;  // outward; those of the surface, behind them the walls
        Eigen::Index walls = 0;
        std::vector<std::uint32_t> rim;  // vertices of walls
        double pressure = 0;
        std::vector<Keyframe> keyframes;
        double factor = 1;
        bool is_changing = false;  // in the step
        bool is_stored = true;  // E does not depend on the start of a step: no rim, or a fixed one
        Point apex;
        Positions<Dim> start;  // of the rim, m
        Positions<Dim> taken;  // the volume's gradient by the walls there, taken off, m^(Dim-1)
    };

    [[nodiscard]] static PressedSurface make_pressed(const Load& load,
                                                     const Scene& scene,
                                                     const Bodies<Dim>& bodies,
                                                     const HeldVertices<Dim>& held);
    static void hold_walls(PressedSurface& pressed, const Positions<Dim>& x);

    const Workers* workers_;
    std::vector<PressedSurface> pressed_;
    double stored_ = 0;  // J
    double lagged_ = 0;  // J, of those that are not stored
    double rounding_ = 0;
    std::vector<double> hessians_;  // while a system is assembled
};

}  // namespace pent::simulator
