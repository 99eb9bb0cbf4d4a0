#pragma once

#include "model/bodies.h"
#include "model/motion_chain.h"
#include "model/nearest_point.h"
#include "potentials/potential.h"
#include "potentials/spring.h"

#include <pent/parallel.h>
#include <pent/simulator/step_report.h>

#include <array>
#include <cstdint>
#include <vector>

namespace pent::simulator {

/// The springs of all attachments of a scene.
///
/// One spring ties a vertex x to a point q: that of a cell of another body with fixed barycentric
/// coordinates, or a point in space that may move; its stretch is x - q. The coordinates add up to
/// 1, so that the forces on vertex and cell add up to zero; they have no moment, either, wherever
/// they are, but for the damping of what is stretched. An offset is kept by the coordinates of the
/// vertex itself, extrapolated beyond the faces of the cell: it turns and stretches with the cell.
template <int Dim>
class Attachments final : public Potential<Dim> {
public:
    /// Finds the nearest points. Throws an Error that says where, if nothing is selected, a vertex
    /// is farther from its target than allowed, or a cell is too flat to carry an offset.
    ///
    /// @param bodies  Must outlive this.
    Attachments(const Workers& workers, const Scene& scene, const Bodies<Dim>& bodies);

    [[nodiscard]] double evaluate(const Positions<Dim>& x, Positions<Dim>& gradient) override;
    void add_hessian(const Positions<Dim>& x,
                     double weight,
                     Filter filter,
                     NewtonSystem<Dim>& system) override;
    [[nodiscard]] std::vector<TermEnergy> energies() const override;
    [[nodiscard]] bool begin_step(const StepStart<Dim>& start) override;
    [[nodiscard]] bool set_time(const TimeSpan& step) override;
    void add_couplings(Couplings& couplings) const override;

    /// One an attachment, at the positions last evaluated.
    [[nodiscard]] std::vector<AttachmentSummary> summaries() const;

    /// Breaks springs that pull too hard at the positions last evaluated; returns the bodies that
    /// were tied by them.
    [[nodiscard]] std::vector<std::size_t> break_springs();

    /// One a spring: 1 if it is broken, else 0.
    [[nodiscard]] const std::vector<std::uint8_t>& broken() const { return broken_; }
    void set_broken(const std::vector<std::uint8_t>& broken) { broken_ = broken; }

private:
    struct Tie : Spring<Dim> {
        Vector<Dim> place = Vector<Dim>::Zero();  // of a point in space at t = 0, m
    };
    // The springs of one attachment.
    struct Bundle {
        const Attachment* attachment = nullptr;
        std::size_t body = 0;
        std::size_t target = 0;  // the same for points in space
        std::size_t begin = 0;   // of its springs
        std::size_t end = 0;
        std::vector<CenteredMotion<Dim>> motions = {};
        Matrix<Dim> hessian = Matrix<Dim>::Zero();
        bool is_on = false;
        bool is_driven = false;  // in this step it comes or goes, or its points move
    };

    void add_springs(const Workers& workers, const Bodies<Dim>& bodies, Bundle& bundle);
    [[nodiscard]] static Tie tie_to_space(const Bodies<Dim>& bodies,
                                          const Attachment& attachment,
                                          std::uint32_t vertex);
    [[nodiscard]] static Tie tie_to_body(const Bodies<Dim>& bodies,
                                         const Bundle& bundle,
                                         std::uint32_t vertex,
                                         const MaterialPoint<Dim>& nearest);
    [[nodiscard]] bool is_there(const Attachment& attachment, double begin) const;
    template <typename Visit>
    void for_each_spring(const Visit& visit) const;

    std::vector<Attachment> list_;
    double dt_;
    std::vector<Bundle> bundles_;
    std::vector<Tie> springs_;
    std::vector<std::uint8_t> broken_;
    double rate_ = 0;  // 1/s; 0 between steps
    double energy_ = 0;
    double damping_energy_ = 0;
};

}  // namespace pent::simulator
