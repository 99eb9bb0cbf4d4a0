#pragma once

#include <pent/contact/barrier.h>
#include <pent/contact/crossings.h>

#include <array>
#include <cstdint>
#include <limits>
#include <memory>
#include <vector>

namespace pent::contact {

struct BarrierOptions {
    double distance = 0;    ///< dhat, m, > 0: the gap at which bodies begin to push each other.
    double separation = 0;  ///< m, >= 0: a distance that is never reached.
    bool self = false;      ///< Whether bodies meet themselves.
};

/// Throws an Error, beginning with `name`, unless the options are in their ranges.
void check(const BarrierOptions& options, const char* name);

/// The place of a point that does not move and has no vertex: the center of a ball.
inline constexpr std::uint32_t kFixedPoint = 0xffffffff;

/// Two faces nearer than the distance of contact. Pairs of simplices whose nearest faces are the same
/// are one contact with a multiplicity; a pair that is nearly parallel has all its corners and a
/// mollifier.
template <int Dim>
struct BarrierContact {
    std::array<std::uint32_t, Dim + 1> vertices{};  ///< Of `faces`; faces.count in use.
    NearestFaces<Dim> faces;
    Mollifier mollifier;
    double separation = 0;  ///< m; for a ball with its radius.
    std::int32_t multiplicity = 1;
    std::int32_t first_body = 0;  ///< -1 - i for obstacle i.
    std::int32_t second_body = 0;
};

/// A vertex nearer than the distance of contact to an obstacle other than a ball.
struct VertexContact {
    std::uint32_t vertex = 0;
    std::int32_t obstacle = 0;
    double distance = 0;  ///< m, > 0.
};

struct BarrierReport {
    std::int64_t contacts = 0;    ///< Pairs of faces, and vertices at obstacles.
    std::int64_t mollified = 0;   ///< Contacts that are nearly parallel.
    std::int64_t candidates = 0;  ///< Pairs of simplices that were looked at.
    double smallest_gap =
        std::numeric_limits<double>::infinity();  ///< m: distance less separation.
    double seconds = 0;
};

/// What is near what at some positions: geometry alone, without the stiffness.
template <int Dim>
struct BarrierContacts {
    std::vector<BarrierContact<Dim>> pairs;  ///< In an order that depends on the positions alone.
    std::vector<VertexContact> vertices;     ///< By obstacle, then ascending.
    BarrierReport report;
};

/// How far a step may go.
struct StepLimit {
    double fraction = 1;  ///< In [0, 1].
    Crossing limiting;    ///< What is in the way; of no meaning if fraction is 1.
    double seconds = 0;
};

/// Finds the contacts of a scene for the barrier model, and how far its vertices may move.
///
/// The energy is the sum over all pairs of a vertex and a facet, and of an edge and a ridge, of two
/// bodies (or of one, if asked; pairs that share a vertex are left out). Their least distance is that
/// of the surfaces, so no two surfaces cross while none of them falls to 0. Half-spaces, cavities and
/// bowls repel vertices; a ball repels facets, since a facet can cut it where no vertex does.
///
/// Results depend on positions alone: not on threads, nor on earlier calls. Threads are those of
/// workers_here().
template <int Dim>
class BarrierFinder {
public:
    /// @param bodies   Their surfaces index the columns of positions.
    /// @param is_held  One for each vertex of the scene: moved from outside. Held vertices do not push
    ///                 each other and do not meet obstacles, but a step does not lead them through
    ///                 each other.
    /// @param rest     Rest positions of all vertices.
    ///
    /// Throws an Error if options or obstacles are out of range.
    BarrierFinder(std::vector<ContactBody<Dim>> bodies,
                  std::vector<Obstacle<Dim>> obstacles,
                  std::vector<bool> is_held,
                  const PositionsView<Dim>& rest,
                  const BarrierOptions& options);
    ~BarrierFinder();
    BarrierFinder(BarrierFinder&&) noexcept;
    BarrierFinder& operator=(BarrierFinder&&) noexcept;
    BarrierFinder(const BarrierFinder&) = delete;
    BarrierFinder& operator=(const BarrierFinder&) = delete;

    /// Contacts at these positions (Dim x n, finite; not checked), which nothing crosses.
    [[nodiscard]] BarrierContacts<Dim> find(const PositionsView<Dim>& positions);

    /// How far all vertices can go from one place towards another without coming nearer than a tenth
    /// of their gaps, or of dhat where these are larger.
    [[nodiscard]] StepLimit limit_step(const PositionsView<Dim>& from,
                                       const PositionsView<Dim>& to);

    /// What crosses, touches or is inside something else; empty for a start that is fit.
    [[nodiscard]] std::vector<Crossing> find_crossings(const PositionsView<Dim>& positions) const;

    /// Corners of a contact, in the order of its vertices; columns beyond are 0.
    [[nodiscard]] Stencil<Dim> points_of(const BarrierContact<Dim>& contact,
                                         const PositionsView<Dim>& positions) const;

    /// Energy of all contacts, J.
    [[nodiscard]] double energy(const BarrierContacts<Dim>& contacts,
                                const PositionsView<Dim>& positions,
                                double stiffness) const;

    /// Adds the forces of all contacts to `forces` (Dim x n), N.
    void add_forces(const BarrierContacts<Dim>& contacts,
                    const PositionsView<Dim>& positions,
                    double stiffness,
                    Positions<Dim>& forces) const;

    /// Filtered Hessian of one contact, N/m.
    [[nodiscard]] StencilMatrix<Dim> hessian(const BarrierContact<Dim>& contact,
                                             const PositionsView<Dim>& positions,
                                             double stiffness,
                                             Filter filter) const;
    [[nodiscard]] Eigen::Matrix<double, Dim, Dim> hessian(const VertexContact& contact,
                                                          const PositionsView<Dim>& positions,
                                                          double stiffness,
                                                          Filter filter) const;

    [[nodiscard]] const std::vector<ContactBody<Dim>>& bodies() const;
    [[nodiscard]] const std::vector<Obstacle<Dim>>& obstacles() const;
    [[nodiscard]] const BarrierOptions& options() const;

private:
    class State;
    std::unique_ptr<State> state_;
};

}  // namespace pent::contact
