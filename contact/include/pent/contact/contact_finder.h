#pragma once

#include <pent/contact/contact.h>
#include <pent/contact/contact_scene.h>
#include <pent/contact/crossings.h>
#include <pent/contact/filter.h>
#include <pent/contact/team.h>

#include <memory>
#include <string>
#include <vector>

namespace pent::contact {

/// How far a step may go.
struct StepLimit {
    double fraction = 1;  ///< In [0, 1].
    Crossing limiting;    ///< What is in the way; of no meaning if fraction is 1.
    double seconds = 0;
};

/// Finds what touches in a scene, what it is worth, and how far its vertices may move.
///
/// Penalty:
/// - A vertex and another body make one contact, with the nearest facet: at the signed distance of
///   the vertex to that body's surface, at any depth. Inside: winding number above 0.
/// - An edge and a ridge make a contact where their closest points are inside both. A crossed pair
///   is known by the outward normals: the force goes on while the crossing is shallower than
///   `distance`. Pairs of which only one faces the other make no contact.
/// - Within a body both kinds are as the second. Pairs that share a vertex, that are nearer than
///   `distance` at rest, or look crossed but are nearer than three times that at rest (the two
///   sides of something thin) are no contacts.
/// - Obstacles repel vertices, at any depth.
///
/// Barrier: the energy is the sum over all pairs of a vertex and a facet, and of an edge and a
/// ridge, of two bodies (or of one, if asked; pairs that share a vertex are left out). Their least
/// distance is that of the surfaces, so no two surfaces cross while none of them falls to 0. Pairs
/// with the same nearest faces are one contact with a multiplicity. Obstacles repel what they say
/// they do.
///
/// Results depend on positions alone: not on threads, nor on earlier calls. Threads are
/// the workers_here().
template <int Dim>
class ContactFinder {
public:
    /// Throws an Error if options or obstacles are out of range.
    ///
    /// @param team  Null for one process alone. All have the same scene, call find(), limit_step()
    ///              and limit_obstacles() at the same positions, and get the same.
    explicit ContactFinder(ContactScene<Dim> scene, std::shared_ptr<const Team> team = nullptr);
    ~ContactFinder();
    ContactFinder(ContactFinder&&) noexcept;
    ContactFinder& operator=(ContactFinder&&) noexcept;
    ContactFinder(const ContactFinder&) = delete;
    ContactFinder& operator=(const ContactFinder&) = delete;

    /// @param positions  Of all vertices of the scene, Dim x n, finite; not checked. With a barrier
    ///                   nothing may cross there.
    /// @param stiffness  N/m, > 0; of an obstacle under the penalty model its own counts.
    [[nodiscard]] Contacts<Dim> find(const PositionsView<Dim>& positions, double stiffness);

    /// Hessians of contacts that find() gave for these positions and this stiffness, in their
    /// order.
    ///
    /// Those of a barrier are exact, so the weights move with the corners; those of a penalty hold
    /// them.
    ///
    /// @param memory  Lists to write to, whatever is in them: those of the last call save an
    ///                allocation.
    [[nodiscard]] StencilHessians<Dim> hessians(const Contacts<Dim>& contacts,
                                                const PositionsView<Dim>& positions,
                                                double stiffness,
                                                Filter filter,
                                                StencilHessians<Dim> memory = {}) const;

    /// The largest fraction of the way, by continuous collision detection, that all vertices can go
    /// from one place towards another with a tenth of every gap left, or of dhat where that is
    /// less. All of it with penalties.
    [[nodiscard]] StepLimit limit_step(const PositionsView<Dim>& from,
                                       const PositionsView<Dim>& to);

    /// Puts obstacles somewhere else: one shape for each, of the same kind and size as before.
    void move_obstacles(const std::vector<ObstacleShape<Dim>>& shapes);

    /// How far obstacles may go from these shapes to where they are now, while all vertices stay:
    /// less than 1 where a barrier has them in the way, as limit_step() says, or 0 where a vertex
    /// is then inside of one that repels vertices.
    [[nodiscard]] StepLimit limit_obstacles(const std::vector<ObstacleShape<Dim>>& from,
                                            const PositionsView<Dim>& positions);

    /// What crosses, touches or is inside something else, no more than `most`, in order of bodies;
    /// empty for a start that is fit for a barrier. Fixed vertices alone may touch.
    [[nodiscard]] std::vector<Crossing> find_crossings(const PositionsView<Dim>& positions,
                                                       std::size_t most = 1000) const;

    /// One line for each body whose edges are not long against the distance of contact, which then
    /// floods the scene with contacts; empty if there is none.
    [[nodiscard]] std::vector<std::string> warnings() const;

    [[nodiscard]] const ContactScene<Dim>& scene() const;

    /// Memory of surfaces, trees and kept pairs.
    [[nodiscard]] std::int64_t bytes() const;

private:
    class State;
    std::unique_ptr<State> state_;
};

/// Adds the gradient of the energy of all contacts, N, to `gradient` (Dim x vertices of the scene).
/// Parallel.
template <int Dim>
void add_gradient(const Contacts<Dim>& contacts, Positions<Dim>& gradient);

}  // namespace pent::contact
