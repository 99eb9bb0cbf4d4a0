#pragma once

#include "closest_points_oracle.h"
#include "contact_energy.h"
#include "distance_hessian.h"
#include "pair_spectra.h"
#include "spectral.h"

#include <random>

namespace pent::contact::test {

/// The contact of two simplices with all their corners, which are vertices 0, 1, ...
template <int Dim, int K, int L>
[[nodiscard]] Contact<Dim> contact_at(const Stencil<Dim>& points) {
    const ClosestPoints<Dim, K, L> closest =
        closest_points<Dim, K, L>(points.template leftCols<K>(), points.template rightCols<L>());
    Contact<Dim> contact;
    for (std::uint32_t i = 0; i < contact.vertices.size(); ++i) {
        contact.vertices[i] = i;
    }
    contact.weights << closest.beta, -closest.alpha;
    contact.distance = std::sqrt(closest.distance_squared);
    contact.direction = closest.difference / contact.distance;
    contact.kind = K == 1 ? ContactKind::PointFacet : ContactKind::Mixed;
    contact.first_count = K;
    contact.count = contact.corner_count = K + L;
    contact.active = static_cast<std::uint8_t>(closest.first_face | closest.second_face << K);
    return contact;
}

/// A pair with the energy at its true distance: what derivatives are compared with knows nothing of
/// faces and weights.
template <int Dim, int K, int L>
struct PairEnergy {
    DistanceEnergy energy;
    double threshold = 0;  ///< Of the mollifier; 0 for none.

    [[nodiscard]] Contact<Dim> contact(const Stencil<Dim>& points) const {
        Contact<Dim> contact = contact_at<Dim, K, L>(points);
        contact.mollifier.threshold = threshold;
        evaluate<Dim>(energy, Positions<Dim>(points), contact);
        return contact;
    }
    [[nodiscard]] double value(const Stencil<Dim>& points) const { return contact(points).energy; }
    [[nodiscard]] StencilVector<Dim> gradient(const Stencil<Dim>& points) const {
        const Contact<Dim> at = contact(points);
        StencilVector<Dim> gradient = at.slope * outer<Dim>(at.weights, at.direction);
        if (at.mollifier.is_on()) {
            gradient += mollifier_gradient<Dim>(energy, at, Positions<Dim>(points));
        }
        return gradient;
    }
    [[nodiscard]] StencilMatrix<Dim> hessian(const Stencil<Dim>& points, Filter filter) const {
        const Contact<Dim> at = contact(points);
        SpectralHessian<Dim> hessian{at.vertices, at.count};
        std::vector<double> numbers(PairSpectra<Dim>::most_numbers(at, filter));
        PairSpectra<Dim> spectra(filter, numbers.data());
        spectra.add(energy, at, Positions<Dim>(points), hessian);
        spectra.finish();
        return DenseSpectrum<Dim>(hessian, numbers).matrix();
    }
};

/// Random simplices of coordinates in [-1, 1].
class RandomCorners {
public:
    explicit RandomCorners(unsigned seed) : random_(seed) {}

    template <int Dim, int Count>
    [[nodiscard]] Corners<Dim, Count> corners() {
        return Corners<Dim, Count>::NullaryExpr([&] { return coordinate_(random_); });
    }
    template <int Dim>
    [[nodiscard]] Stencil<Dim> stencil() {
        return corners<Dim, Dim + 1>();
    }

private:
    std::mt19937 random_;
    std::uniform_real_distribution<double> coordinate_{-1, 1};
};

/// The same points with one coordinate moved.
template <int Dim>
[[nodiscard]] Stencil<Dim> moved(const Stencil<Dim>& points, int coordinate, double h) {
    Stencil<Dim> result = points;
    result.data()[coordinate] += h;
    return result;
}

}  // namespace pent::contact::test
