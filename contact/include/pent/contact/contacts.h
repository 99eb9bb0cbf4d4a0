#pragma once

#include <pent/contact/length.h>
#include <pent/contact/obstacles.h>
#include <pent/contact/penalty.h>
#include <pent/contact/surface.h>

#include <array>
#include <cstdint>
#include <limits>
#include <memory>
#include <string>
#include <vector>

namespace pent::contact {

/// One body of a scene, as contact sees it.
template <int Dim>
struct ContactBody {
    std::string name;           ///< For messages.
    Surface<Dim> surface;       ///< With the indices of the scene's vertices.
    bool is_kinematic = false;  ///< Moved from outside: two such bodies do not meet.
};

struct ContactOptions {
    double distance = 0;   ///< eps, m, > 0: how near is in contact.
    double stiffness = 0;  ///< k, N/m, > 0.
    bool self = false;     ///< Whether bodies meet themselves.
    Filter filter = Filter::Clamp;
    /// m, >= 0: pairs found are kept until a vertex has moved this far, so that evaluations at
    /// nearby positions (those of a Newton step) cost little; finding them costs more then. 0 keeps
    /// nothing. Contacts are the same either way.
    double margin = 0;
};

/// Throws an Error, beginning with `name`, unless the options are in their ranges.
void check(const ContactOptions& options, const char* name);

enum class ContactKind : std::uint8_t {
    PointFacet,  ///< A vertex of the first and a facet of the second body.
    Mixed,       ///< An edge of the first and a ridge of the second body.
};

/// One pair of simplices in contact. The force on vertices[i] is
///
///     -weights[i] response.gradient,
///
/// the Hessian block of vertices i and j is weights[i] weights[j] response.hessian. Weights are held, and
/// so is the share of its energy that a mixed pair has, which fades towards a border and with its view.
template <int Dim>
struct Contact {
    std::array<std::uint32_t, Dim + 1> vertices{};  ///< Of the first simplex, then of the second.
    Weights<Dim> weights;
    double distance = 0;  ///< Signed, m; negative inside.
    Response<Dim> response;
    ContactKind kind = ContactKind::PointFacet;
    std::int32_t first_body = 0;
    std::int32_t second_body = 0;

    /// Force on vertices[i], N.
    [[nodiscard]] Vector<Dim> force(int i) const { return -weights[i] * response.gradient; }
};

struct ContactReport {
    std::int64_t point_facet = 0;  ///< Contacts of this kind.
    std::int64_t mixed = 0;        ///< Contacts of this kind.
    std::int64_t self = 0;         ///< Contacts of either kind within one body.
    std::int64_t candidates = 0;   ///< Pairs of boxes that the narrow phase looked at.
    std::int64_t trees_built = 0;  ///< Trees built anew.
    std::int64_t trees_refit = 0;  ///< Trees fit to new positions.
    double energy = 0;             ///< J.
    double deepest = 0;            ///< Deepest penetration of a vertex into a body, m, >= 0.
    double smallest_distance =
        std::numeric_limits<double>::infinity();  ///< Least signed distance of a
                                                  ///< contact, m.
    double tree_seconds = 0;                      ///< Spent on trees.
    double search_seconds = 0;                    ///< Spent on finding pairs.
    double seconds = 0;                           ///< All of it.
};

template <int Dim>
struct Contacts {
    std::vector<Contact<Dim>> pairs;  ///< By bodies, kind, and places in their surfaces.
    ContactReport report;
};

/// Adds contact forces, N, to `forces` (Dim x vertices of the scene), in the order of the contacts.
template <int Dim>
void add_forces(const std::vector<Contact<Dim>>& contacts, Positions<Dim>& forces);

/// Finds the contacts of a scene: the penalty model.
///
/// - A vertex and another body make one contact, with the nearest facet: at the signed distance of
///   the vertex to that body's surface, at any depth. Inside is where the surface goes round.
/// - An edge and a ridge make a contact where their closest points are inside both. A crossed pair is
///   known by the outward normals: the force goes on while the crossing is shallower than
///   `distance`. Pairs that see each other's back make no contact.
/// - Within a body both kinds are as the second. Pairs that share a vertex, that are nearer than
///   `distance` at rest, or look crossed but are nearer than three times that at rest (the two
///   sides of something thin) are no contacts.
///
/// The result depends on the positions alone: not on threads, nor on earlier calls. Threads are
/// those of workers_here().
template <int Dim>
class ContactFinder {
public:
    /// @param bodies  Their surfaces index the columns of `rest` and of positions.
    /// @param rest    Rest positions of all vertices of the scene; used for self-contact alone.
    ///
    /// Throws an Error if the options are out of range.
    ContactFinder(std::vector<ContactBody<Dim>> bodies,
                  const PositionsView<Dim>& rest,
                  const ContactOptions& options);
    ~ContactFinder();
    ContactFinder(ContactFinder&&) noexcept;
    ContactFinder& operator=(ContactFinder&&) noexcept;
    ContactFinder(const ContactFinder&) = delete;
    ContactFinder& operator=(const ContactFinder&) = delete;

    /// @param positions  Of all vertices of the scene, Dim x n, finite; not checked.
    [[nodiscard]] Contacts<Dim> find(const PositionsView<Dim>& positions);

    /// One line for each body whose edges are not long against the distance of contact, which then
    /// floods the scene with contacts; empty if there is none.
    [[nodiscard]] std::vector<std::string> warnings() const;

    /// Memory of surfaces, trees and kept pairs.
    [[nodiscard]] std::int64_t bytes() const;

    [[nodiscard]] const ContactOptions& options() const;

private:
    class State;
    std::unique_ptr<State> state_;
};

/// A vertex in contact with an obstacle.
template <int Dim>
struct ObstacleContact {
    std::uint32_t vertex = 0;
    std::int32_t obstacle = 0;
    double distance = 0;  ///< Signed, m.
    Response<Dim> response;
};

/// An obstacle and how it pushes.
template <int Dim>
struct PenaltyObstacle {
    Obstacle<Dim> shape;
    Penalty penalty;  ///< Reach::AnyDepth, so that nothing gets lost in it.
};

/// Contacts of vertices with obstacles, by obstacle, then in the order of `vertices`. Parallel.
///
/// @param vertices  Which columns of `positions` to look at.
template <int Dim>
[[nodiscard]] std::vector<ObstacleContact<Dim>> find_obstacle_contacts(
    const std::vector<PenaltyObstacle<Dim>>& obstacles,
    const std::vector<std::uint32_t>& vertices,
    const PositionsView<Dim>& positions,
    Filter filter);

}  // namespace pent::contact
