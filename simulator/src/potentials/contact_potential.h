#pragma once

#include "model/bodies.h"
#include "model/held_vertices.h"
#include "model/obstacle_motions.h"
#include "potentials/potential.h"

#include <pent/contact/contact_finder.h>
#include <pent/parallel.h>
#include <pent/simulator/step_report.h>

#include <memory>
#include <string>
#include <vector>

namespace pent::simulator {

/// Contact between bodies, within them, and with obstacles: by penalties or by a barrier.
///
/// In a scene without [contact] and [[obstacle]] it is empty: no surface, no tree, no search.
template <int Dim>
class ContactPotential final : public Potential<Dim> {
public:
    ContactPotential(const Workers& workers,
                     const Scene& scene,
                     const Bodies<Dim>& bodies,
                     const HeldVertices<Dim>& held);

    [[nodiscard]] double evaluate(const Positions<Dim>& x, Positions<Dim>& gradient) override;
    void add_hessian(const Positions<Dim>& x,
                     double weight,
                     Filter filter,
                     NewtonSystem<Dim>& system) override;
    [[nodiscard]] std::vector<TermEnergy> energies() const override;
    [[nodiscard]] bool set_time(const TimeSpan& step) override;
    void add_couplings(Couplings& couplings) const override;
    [[nodiscard]] bool begin_step(const StepStart<Dim>& start) override;
    [[nodiscard]] double max_step(const Positions<Dim>& from, const Positions<Dim>& to) override;
    [[nodiscard]] bool is_bounded() const override { return is_barrier_; }
    [[nodiscard]] bool wants_balance() const override;
    [[nodiscard]] bool balance(const BlockVector<Dim>& own,
                               const BlockVector<Dim>& others) override;
    [[nodiscard]] bool adapt() override;
    [[nodiscard]] bool has_kink() const override {
        return !is_barrier_ && contacts_.body_energy > 0;
    }

    [[nodiscard]] bool is_empty() const { return finder_ == nullptr; }

    /// Whether two bodies, or a body and itself, may touch.
    [[nodiscard]] bool do_bodies_meet() const { return do_bodies_meet_; }

    /// Contacts at the positions last evaluated: the same for any history and any number of
    /// threads.
    [[nodiscard]] const contact::Contacts<Dim>& contacts() const { return contacts_; }

    /// Counts and extremes of these, without what they cost.
    [[nodiscard]] ContactSummary summary() const;

    /// Their gradient, Dim x vertices, N; no columns where nothing can touch.
    [[nodiscard]] const Positions<Dim>& gradient() const { return gradient_; }

    /// What was in the way where max_step() last was less than 1.
    [[nodiscard]] const contact::StepLimit& limit() const { return limit_; }

    /// Where obstacles are now.
    [[nodiscard]] const std::vector<pent::ObstacleShape<Dim>>& obstacles() const {
        return obstacles_;
    }
    [[nodiscard]] bool has_moving_obstacles() const;  ///< In the step.
    /// Bodies that touch, where both were last evaluated, an obstacle that moves in a step; some
    /// more than once.
    [[nodiscard]] std::vector<std::size_t> on_moving_obstacles(const TimeSpan& step) const;

    /// Contacts with obstacles where they are when the step begins; contacts() has them where they
    /// are at its end.
    [[nodiscard]] contact::Contacts<Dim> contacts_at_begin(const Positions<Dim>& x) const;

    /// How far the point of an obstacle that a contact touches when the step begins moves in it, m.
    [[nodiscard]] Vector<Dim> obstacle_displacement(const contact::Contact<Dim>& contact,
                                                    const Positions<Dim>& x) const;

    /// Why obstacles could not move in the step with all vertices where they are; empty if they
    /// could. Always so without a barrier.
    [[nodiscard]] std::string obstacle_in_the_way(const Positions<Dim>& x);

    /// A vertex that got through an obstacle between two states, deeper than the distance of
    /// contact and out again, and the obstacle; empty if there is none. Penalties see nothing of
    /// that: they look at where vertices are in the end.
    [[nodiscard]] std::string obstacle_passed(const Positions<Dim>& from,
                                              const Positions<Dim>& to) const;

    /// What crosses where a barrier is to keep things apart; empty without one.
    [[nodiscard]] std::vector<contact::Crossing> find_crossings(
        const Positions<Dim>& positions) const;
    /// The same if these vertices were held, and no others, with obstacles where they are at a
    /// time, s.
    [[nodiscard]] std::vector<contact::Crossing> find_crossings(const Scene& scene,
                                                                const Bodies<Dim>& bodies,
                                                                const HeldVertices<Dim>& held,
                                                                const Positions<Dim>& x,
                                                                double time) const;

    /// Something that touches in the state that a step has led to, from which no step can begin;
    /// empty if nothing does. Newton's method keeps gaps above 0, but what is held arrives where it
    /// is told to, however near that is.
    ///
    /// @param to  Where contacts were last evaluated.
    [[nodiscard]] std::string touching(const Positions<Dim>& from, const Positions<Dim>& to) const;

    /// One line about a crossing or what is in the way of a step.
    [[nodiscard]] std::string describe(const contact::Crossing& crossing) const;

    /// Stiffness of a barrier now, N/m, never below that of the scene; 0 without one.
    [[nodiscard]] double stiffness() const { return is_barrier_ ? stiffness_ : 0; }
    void set_stiffness(double stiffness) { stiffness_ = is_barrier_ ? stiffness : stiffness_; }
    [[nodiscard]] const ContactSettings& settings() const { return settings_; }

    /// Contacts of a sleeping body keep the stiffness with which it fell asleep: what else is in
    /// them sleeps, too, or moves from outside. Returns whether the value has changed.
    ///
    /// @param stiffness  Of a barrier, one a body, N/m; 0 of those that are awake.
    [[nodiscard]] bool set_sleepers(std::vector<double> stiffness);

    /// After what is held has changed.
    void set_held(const Scene& scene, const Bodies<Dim>& bodies, const HeldVertices<Dim>& held);

    /// What it cost since this was last asked.
    [[nodiscard]] ContactWork take_work();

    /// Lines for the user about a distance of contact that does not suit the meshes.
    [[nodiscard]] std::vector<std::string> warnings() const;

    [[nodiscard]] std::int64_t bytes() const;

private:
    [[nodiscard]] double gap() const {
        return contacts_.report.smallest_distance - settings_.separation;
    }
    [[nodiscard]] bool is_close() const;  // so that stiffness has to balance other forces

    [[nodiscard]] contact::Contacts<Dim> find(const Positions<Dim>& x) const;
    [[nodiscard]] double stiffness_over_current(const contact::Contact<Dim>& contact) const;
    [[nodiscard]] contact::Contacts<Dim> own_contacts() const;
    void put_obstacles(double time);
    void add_obstacle_displacements(const Positions<Dim>& x);

    const Workers* workers_;
    const Sharing* sharing_;
    ContactSettings settings_;
    bool is_barrier_ = false;
    bool do_bodies_meet_ = false;
    bool has_obstacles_ = false;
    double stiffness_ = 0;                       // of bodies, N/m
    std::vector<double> stiffness_of_sleepers_;  // one a body, of a barrier, N/m; 0 of others
    double last_gap_ = 0;                        // m, of the last accepted iterate
    ObstacleMotions<Dim> motions_;
    TimeSpan step_;
    bool are_at_begin_ = false;  // whether obstacles are where the step begins, not where it ends;
                                 // then their displacement in it is a part of the gradient
    std::vector<pent::ObstacleShape<Dim>> obstacles_;      // where they are
    std::unique_ptr<contact::ContactFinder<Dim>> finder_;  // null where nothing can touch
    contact::Contacts<Dim> contacts_;                      // at the positions last evaluated
    Positions<Dim> gradient_;                              // there
    contact::StepLimit limit_;
    contact::StencilHessians<Dim> hessians_;  // while a system is assembled
    ContactWork work_;                        // since it was last taken
};

/// Hands Hessians of a few vertices to a system; they must last until it is assembled.
///
/// @param first  Of the weighted ones the first to go; those before it go last.
template <int Dim>
void add_stencils(double weight,
                  const contact::StencilHessians<Dim>& hessians,
                  std::size_t first,
                  NewtonSystem<Dim>& system);

}  // namespace pent::simulator
