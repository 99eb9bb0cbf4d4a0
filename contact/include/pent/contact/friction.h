#pragma once

#include <pent/contact/contact.h>
#include <pent/simplex_mesh.h>

#include <functional>
#include <vector>

namespace pent::contact {

/// Coulomb friction, smoothed at rest.
struct Friction {
    double coefficient = 0;  ///< mu, >= 0.
    double slip_speed =
        1e-3;  ///< m/s, > 0: what is slower sticks, by a force as of a viscous fluid.
    /// One for each body, in place of `coefficient`; none if that is all of theirs.
    std::vector<double> of_bodies = {};
    std::vector<double> of_obstacles = {};  ///< The same for obstacles.

    /// The coefficient between two things that touch: the geometric mean of theirs.
    [[nodiscard]] double between(const Collider& first, const Collider& second) const;
};

/// Which stiffness stands for friction at a slip.
enum class FrictionLaw : std::uint8_t {
    Energy,  ///< Gradient and Hessian of the energy at the slip: for Newton's method.
    /// The secant stiffness, which gives this force at this slip: for one linear solve, which holds
    /// it, and in place of a Hessian, which it bounds from above, as f1 is concave.
    Secant,
};

/// Energy of the slip at one contact, and its derivatives by it.
template <int Dim>
struct FrictionResponse {
    double energy = 0;     ///< J.
    Vector<Dim> gradient;  ///< N.
    Block<Dim> hessian;    ///< N/m, symmetric.
};

/// The energy is force f0(|u|) with f0' = f1, f1(y) = 2 y/e - y^2/e^2 below e and 1 beyond: convex,
/// so the Hessian is positive semidefinite as it is, with eigenvalues f1' along the slip and f1/|u|
/// across it. The force never points along the slip: friction only takes energy. Source: [li2020]
/// section 5.4; the tangent space has Dim - 1 dimensions, so there is no basis to choose: what
/// counts is the length of u.
///
/// @param normal  Unit length.
/// @param force   mu times the normal force, N, >= 0.
/// @param slip    m; u is its part normal to `normal`.
/// @param e       m, > 0: slip_speed times the length of the step.
template <int Dim>
[[nodiscard]] FrictionResponse<Dim> friction_response(
    const Vector<Dim>& normal, double force, const Vector<Dim>& slip, double e, FrictionLaw law);

/// Friction of all contacts of a scene, with the normal forces, normals and weights that they have
/// at the start of a step: held during it, which makes friction the gradient of an energy.
template <int Dim>
class LaggedFriction {
public:
    explicit LaggedFriction(const Friction& friction) : friction_(friction) {}

    /// Starts a step of length h (s) at these positions and contacts.
    ///
    /// @param velocities             Null for a step that minimizes. For one of a single linear
    ///                               solve those at its start, m/s: they tell how fast contacts
    ///                               slip, and so their resistance.
    /// @param obstacle_displacement  How far the point of an obstacle that a contact touches moves
    ///                               in the step, m; empty where none moves.
    void begin_step(
        const std::vector<Contact<Dim>>& contacts,
        const Positions<Dim>& positions,
        const Positions<Dim>* velocities,
        double h,
        const std::function<Vector<Dim>(const Contact<Dim>&)>& obstacle_displacement = {});

    /// Adds the gradient at these positions, N, and returns the energy, J: of use within a step
    /// alone, since it starts anew with each.
    double add_gradient(const Positions<Dim>& positions, Positions<Dim>& gradient) const;

    /// One for each contact that has a force. Where the slip of a contact has turned around since
    /// the last call in the step it is the secant for some calls, while the slip is above e / 2:
    /// there the energy is a cone with little or no curvature along the slip, over whose tip
    /// Newton's method would go to and fro.
    [[nodiscard]] StencilHessians<Dim> hessians(const Positions<Dim>& positions);

    /// Forgets what was held.
    void end_step() { lagged_.clear(); }

    /// Contacts that have a force.
    [[nodiscard]] std::size_t size() const { return lagged_.size(); }

private:
    struct Lagged {
        std::array<std::uint32_t, Dim + 1> vertices{};
        Weights<Dim> weights;
        int count = 0;          // vertices in use
        Vector<Dim> normal;     // unit length
        double force = 0;       // mu times the normal force, N
        Vector<Dim> start;      // sum w_i x_i at which there is no slip, m
        Block<Dim> resistance;  // secant stiffness held for a single linear solve, N/m
        Vector<Dim> slip = Vector<Dim>::Zero();  // when the Hessian was last asked for, m
        int patience = 0;                        // secants that the last turn around led to
        int secants = 0;                         // how many of these are left
    };

    [[nodiscard]] static Vector<Dim> weighted_sum(const Lagged& lagged,
                                                  const Positions<Dim>& vectors);
    [[nodiscard]] FrictionResponse<Dim> respond(const Lagged& lagged,
                                                const Vector<Dim>& slip,
                                                FrictionLaw law) const;

    Friction friction_;
    double slip_ = 0;  // slip_speed times the length of the step, m
    bool is_linear_ = false;
    std::vector<Lagged> lagged_;
};

}  // namespace pent::contact
