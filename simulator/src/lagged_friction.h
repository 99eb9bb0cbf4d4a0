#pragma once

#include <pent/contact/contacts.h>
#include <pent/contact/friction.h>

#include <vector>

namespace pent::simulator {

/// Friction at some positions of a step: contacts that resist slip. Their responses are those of
/// friction alone.
template <int Dim>
struct FrictionState {
    std::vector<contact::Contact<Dim>> pairs;
    std::vector<contact::ObstacleContact<Dim>> obstacles;
    double energy = 0;  ///< J; of use in a line search alone, since it starts anew with each step.
};

/// Friction of all contacts of a scene, with the normal forces, normals and weights that they have at
/// the start of a step.
template <int Dim>
class LaggedFriction {
public:
    explicit LaggedFriction(const contact::Friction& friction) : friction_(friction) {}

    /// Starts a step of length h (s) at these positions and contacts.
    ///
    /// @param velocities  Null for a step that minimizes. For one of a single linear solve those at
    ///                    its start, m/s: they tell how fast contacts slip, and so their resistance.
    void begin_step(const std::vector<contact::Contact<Dim>>& pairs,
                    const std::vector<contact::ObstacleContact<Dim>>& obstacles,
                    const Positions<Dim>& positions,
                    const Positions<Dim>* velocities,
                    double h);

    [[nodiscard]] FrictionState<Dim> find(const Positions<Dim>& positions) const;

private:
    struct Lagged {
        contact::FrictionContact<Dim> contact;
        contact::Vector<Dim> start;                  // sum w_i x_i at the start of the step, m
        Eigen::Matrix<double, Dim, Dim> resistance;  // held, for a single linear solve; N/m
    };

    void add(contact::FrictionContact<Dim> contact,
             const contact::Vector<Dim>& force,
             const Positions<Dim>& positions,
             const Positions<Dim>* velocities,
             std::vector<Lagged>& list) const;
    [[nodiscard]] contact::Response<Dim> respond(const Lagged& lagged,
                                                 const Positions<Dim>& positions) const;

    contact::Friction friction_;
    double h_ = 0;
    bool is_linear_ = false;
    std::vector<Lagged> pairs_;
    std::vector<Lagged> obstacles_;
};

}  // namespace pent::simulator
