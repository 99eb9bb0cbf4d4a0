#pragma once

#include <pent/contact/stencil.h>

#include <array>
#include <cstdint>
#include <limits>
#include <vector>

namespace pent::contact {

/// One of the two things that touch: a body or an obstacle, by its place in the scene.
struct Collider {
    enum class Kind : std::uint8_t { Body, Obstacle };
    Kind kind = Kind::Body;
    std::uint32_t index = 0;

    [[nodiscard]] bool is_obstacle() const { return kind == Kind::Obstacle; }
    bool operator==(const Collider&) const = default;
};

enum class ContactKind : std::uint8_t {
    PointFacet,  ///< A vertex and a facet, or faces of these.
    Mixed,       ///< An edge and a ridge (in R^3 two edges), or faces of these.
    Surface,     ///< A vertex and the smooth surface of an obstacle.
};

/// The factor that takes the energy of a mixed pair to 0 where its simplices become parallel, and
/// its closest points jump: m(c) = (c / c0) (2 - c / c0) for c < c0, 1 beyond; continuously
/// differentiable. Source: [li2020] section 5.2, with the spanned volume in place of the cross
/// product.
struct Mollifier {
    double threshold = 0;  ///< c0, unit of c; 0 for a pair that needs none.

    [[nodiscard]] bool is_on() const { return threshold > 0; }
    [[nodiscard]] double value(double c) const {
        return c < threshold ? c / threshold * (2 - c / threshold) : 1;
    }
    [[nodiscard]] double slope(double c) const {
        return c < threshold ? 2 / threshold * (1 - c / threshold) : 0;
    }
    [[nodiscard]] double curvature(double c) const {
        return c < threshold ? -2 / (threshold * threshold) : 0;
    }
};

/// Two faces nearer than the activation distance, or a vertex and the surface of an obstacle: the
/// one type of contact, whatever the model.
///
/// The distance d of its points changes by direction . sum w_i dx_i. Its energy is psi(d), so that
/// the gradient by vertices[i] is w_i slope direction; a mollified one has more, see
/// Contacts::mollified.
///
/// Vertices of obstacles do not move: an obstacle always comes second, and its vertices last.
template <int Dim>
struct Contact {
    std::array<std::uint32_t, Dim + 1> vertices{};  ///< Of the first simplex, then of the second.
    Weights<Dim> weights = Weights<Dim>::Zero();    ///< beta, then -alpha; 0 where not in use.
    Vector<Dim> direction = Vector<Dim>::Zero();    ///< Unit length: that in which d grows.
    double distance = 0;                            ///< d, signed, m; negative inside.
    double radius = 0;  ///< m, >= 0: the points are d + radius apart; of an obstacle.
    double share = 1;   ///< Factor of the energy, held: of a mixed pair that fades, or of a
                        ///< facet that shares a vertex in a valley with others.
    double gain = 1;    ///< How fast d grows along direction, held; 1 but in valleys.
    std::int32_t multiplicity = 1;  ///< Pairs of simplices with these as their nearest faces.
    Mollifier mollifier;            ///< Of a mixed pair with all its corners, the edge first.
    Collider first;
    Collider second;
    ContactKind kind = ContactKind::PointFacet;
    bool is_fading = false;         ///< A penalty that fades out with the depth of a crossing.
    std::uint8_t count = 0;         ///< Vertices that may move, the first ones.
    std::uint8_t first_count = 0;   ///< Corners of the first simplex, which come first.
    std::uint8_t corner_count = 0;  ///< All corners.
    std::uint8_t active = 0;        ///< Bit i: corner i spans one of the nearest faces.

    double energy = 0;  ///< J, at the stiffness that find() was given.
    double slope = 0;   ///< psi' times the gain, J/m = N, at the same.

    [[nodiscard]] bool is_self() const { return first == second; }

    /// Force on vertices[i], N, without the share of a mollifier.
    [[nodiscard]] Vector<Dim> force(int i) const { return -weights[i] * (slope * direction); }
};

/// The part of the gradient that a mollifier adds to that of a contact, N.
template <int Dim>
struct MollifierGradient {
    std::uint32_t contact = 0;  ///< Its place in the list.
    StencilVector<Dim> vector;
};

/// Counts and extremes of contacts, and what it took to find them. All zero where nothing was
/// looked for.
struct ContactReport {
    std::int64_t point_facet = 0;     ///< Contacts of this kind between bodies.
    std::int64_t mixed = 0;           ///< Contacts of this kind between bodies.
    std::int64_t self = 0;            ///< Of both, those within one body.
    std::int64_t obstacle = 0;        ///< Contacts with obstacles.
    std::int64_t mollified = 0;       ///< Contacts that are nearly parallel.
    std::int64_t candidates = 0;      ///< Pairs of simplices that the narrow phase looked at.
    std::int64_t obstacle_tests = 0;  ///< Distances of vertices to obstacles.
    std::int64_t trees_built = 0;     ///< Trees built anew.
    std::int64_t trees_refit = 0;     ///< Trees fit to new positions.
    double deepest = 0;               ///< Deepest penetration of a vertex, m, >= 0.
    double smallest_distance =
        std::numeric_limits<double>::infinity();  ///< Least signed distance of a contact, m.
    double tree_seconds = 0;                      ///< Spent on trees.
    double search_seconds = 0;                    ///< Spent on finding pairs.
    double seconds = 0;                           ///< All of it.
};

/// All contacts at some positions, in an order that depends on the positions alone.
template <int Dim>
struct Contacts {
    std::vector<Contact<Dim>> list;  ///< Pairs of faces; then vertices at surfaces of obstacles.
    std::size_t pair_count = 0;      ///< Pairs of faces.
    std::vector<MollifierGradient<Dim>> mollified;  ///< By contact, ascending.
    double body_energy = 0;                         ///< Of bodies among each other, J.
    double obstacle_energy = 0;                     ///< Of bodies and obstacles, J.
    ContactReport report;
};

}  // namespace pent::contact
