#pragma once

#include <pent/contact/contact.h>
#include <pent/contact/contact_model.h>
#include <pent/contact/distance_energy.h>
#include <pent/contact/obstacles.h>
#include <pent/contact/surface.h>

#include <cstdint>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace pent::contact {

struct ContactOptions {
    ContactModel model = ContactModel::Penalty;
    double distance = 0;    ///< m, > 0: what is nearer is in contact; dhat of [li2020].
    double separation = 0;  ///< m, >= 0: a barrier keeps all distances above it [li2021].
    bool self = false;      ///< Whether bodies meet themselves.
    /// m, >= 0: of a penalty, as the skin of a Verlet list. Pairs found are kept until a vertex has
    /// moved this far, so that evaluations at nearby positions (those of a Newton step) cost
    /// little; finding them costs more then. 0 keeps nothing. Contacts are the same either way.
    double margin = 0;
};

/// Throws an Error, beginning with `name`, unless the options are in their ranges.
void check(const ContactOptions& options, const char* name);

/// One body of a scene, as contact sees it.
template <int Dim>
struct ContactBody {
    std::string name;           ///< For messages.
    Surface<Dim> surface;       ///< With the indices of the scene's vertices.
    bool is_kinematic = false;  ///< Moved from outside: two such bodies do not meet.
    /// The cells inside the surface: Dim + 1 corners of each, positively oriented at rest, with
    /// indices as those of the surface. They must outlive the scene. Of a convex body they spare
    /// searches for pairs within it; empty where they are not at hand.
    std::span<const std::uint32_t> cells = {};
};

/// An obstacle, and how it pushes under the penalty model.
template <int Dim>
struct ContactObstacle {
    ObstacleShape<Dim> shape;
    double distance = 0;   ///< m, > 0.
    double stiffness = 0;  ///< N/m, > 0.
};

/// All that can touch. A barrier takes all distances and stiffnesses from the options.
template <int Dim>
struct ContactScene {
    ContactOptions options;
    std::vector<ContactBody<Dim>> bodies;
    std::vector<ContactObstacle<Dim>> obstacles;
    /// One for each vertex of the scene: moved from outside. Such vertices do not push each other
    /// and are not pushed by obstacles, but a step does not lead them through each other.
    std::vector<bool> is_fixed;
    /// Those of them that are never let go. They may go where obstacles are; a step leads no other
    /// vertex into an obstacle, which would have it inside when it is let go. Empty: all that are
    /// fixed.
    std::vector<bool> is_always_fixed = {};
    Positions<Dim> rest;  ///< Rest positions of all vertices, m.
    /// Pairs of bodies that never touch each other, and bodies, as pairs of the same two, that
    /// never touch themselves: by their places, ascending, with the lower one first.
    std::vector<std::pair<std::uint32_t, std::uint32_t>> ignored = {};
};

/// The energy of a contact, at the stiffness given for bodies (of a barrier for all), N/m.
template <int Dim>
[[nodiscard]] DistanceEnergy energy_of(const ContactScene<Dim>& scene,
                                       const Contact<Dim>& contact,
                                       double stiffness);

}  // namespace pent::contact
