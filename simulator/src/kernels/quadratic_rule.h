#pragma once

namespace pent::simulator {

// Functions for compile time only (see kernels.h): at run time there are only their tables.

/// Nodes of a quadratic simplex: its corners, then the middles of its edges (0,1) (0,2) .. (1,2) ..
template <int Dim>
inline constexpr int kQuadraticNodes = (Dim + 1) * (Dim + 2) / 2;

/// Quadrature points of a quadratic simplex: one near each corner, of equal weight, exact for
/// polynomials of degree 2 [hammer1956]. With fewer there would be motions without energy
/// (hourglass modes).
template <int Dim>
inline constexpr int kQuadraticPoints = Dim + 1;

/// Barycentric coordinates of a point: `kNear` for the corner it is near to, `kFar` for all others,
/// with far = (Dim + 2 - sqrt(Dim + 2)) / ((Dim + 1) (Dim + 2)).
template <int Dim>
struct QuadraticPoint;
template <>
struct QuadraticPoint<3> {
    static constexpr double kNear = 0.585410196624968454;
    static constexpr double kFar = 0.138196601125010515;
};
template <>
struct QuadraticPoint<4> {
    static constexpr double kNear = 0.526598632371090413;
    static constexpr double kFar = 0.118350341907227397;
};

/// Rows of ElementRun::rest for a quadratic simplex.
template <int Dim>
inline constexpr int kQuadraticRestRows = kQuadraticPoints<Dim>*(Dim* Dim + 1) + 1;

/// At each of its points a quadratic simplex deforms as some linear simplex does.
///
/// With barycentric coordinates l,
///
///     x(l) = sum over corners of l_a (2 l_a - 1) x_a + sum over edges of 4 l_a l_b x_ab
///     dx / dl_a = y_a = (4 l_a - 1) x_a + 4 sum over b != a of l_b x_ab,
///
/// so that F at l is that of the linear simplex with corners y_a, whose rest positions follow from
/// those of the nodes in the same way.
template <int Dim>
struct QuadraticRule {
    /// The node at corner a if a == b, else that in the middle of the edge between a and b.
    int node[Dim + 1][Dim + 1];
    int first[kQuadraticNodes<Dim>];   ///< The corners, or corner, that a node is between.
    int second[kQuadraticNodes<Dim>];  ///< At least `first`.
    /// The factor of the node between a and b in y_a: [point][a][b].
    double share[kQuadraticPoints<Dim>][Dim + 1][Dim + 1];
};

template <int Dim>
consteval QuadraticRule<Dim> make_quadratic_rule() {
    QuadraticRule<Dim> rule{};
    int middle = Dim + 1;
    for (int a = 0; a <= Dim; ++a) {
        for (int b = a; b <= Dim; ++b) {
            const int node = a == b ? a : middle++;
            rule.node[a][b] = node;
            rule.node[b][a] = node;
            rule.first[node] = a;
            rule.second[node] = b;
        }
    }
    for (int point = 0; point < kQuadraticPoints<Dim>; ++point) {
        for (int a = 0; a <= Dim; ++a) {
            for (int b = 0; b <= Dim; ++b) {
                const double l =
                    b == point ? QuadraticPoint<Dim>::kNear : QuadraticPoint<Dim>::kFar;
                rule.share[point][a][b] = 4 * l - (a == b ? 1 : 0);
            }
        }
    }
    return rule;
}

template <int Dim>
inline constexpr QuadraticRule<Dim> kQuadraticRule = make_quadratic_rule<Dim>();

}  // namespace pent::simulator
