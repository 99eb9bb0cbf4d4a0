#include "normals.h"

#include "gather.h"

#include <pent/parallel.h>

namespace pent::contact {

namespace {

// Normals of one thread at a time.
constexpr int kChunk = 1024;

}  // namespace

Vector<2> normal_to(const Eigen::Matrix<double, 2, 1>& edges) {
    return {-edges(1, 0), edges(0, 0)};
}

Vector<3> normal_to(const Eigen::Matrix<double, 3, 2>& edges) {
    return {edges(1, 0) * edges(2, 1) - edges(2, 0) * edges(1, 1),
            edges(2, 0) * edges(0, 1) - edges(0, 0) * edges(2, 1),
            edges(0, 0) * edges(1, 1) - edges(1, 0) * edges(0, 1)};
}

Vector<4> normal_to(const Eigen::Matrix<double, 4, 3>& edges) {
    const auto minor = [&](int a, int b, int c) {
        return edges(a, 0) * (edges(b, 1) * edges(c, 2) - edges(c, 1) * edges(b, 2))
               - edges(b, 0) * (edges(a, 1) * edges(c, 2) - edges(c, 1) * edges(a, 2))
               + edges(c, 0) * (edges(a, 1) * edges(b, 2) - edges(b, 1) * edges(a, 2));
    };
    return {-minor(1, 2, 3), minor(0, 2, 3), -minor(0, 1, 3), minor(0, 1, 2)};
}

template <int Dim>
Vector<Dim> facet_normal(const Corners<Dim, Dim>& corners) {
    const Eigen::Matrix<double, Dim, Dim - 1> edges =
        corners.template rightCols<Dim - 1>().colwise() - corners.col(0);
    // normal_to() has its vector last in the determinant, the outward rule first.
    return Dim % 2 == 0 ? Vector<Dim>(-normal_to(edges)) : normal_to(edges);
}

template <int Dim>
Positions<Dim> vertex_normals(const Surface<Dim>& surface, const PositionsView<Dim>& positions) {
    Positions<Dim> of_facets(Dim, surface.facets.cols());
    parallel_for(of_facets.cols(), kChunk, [&](Eigen::Index f) {
        of_facets.col(f) = facet_normal<Dim>(gather<Dim, Dim>(surface.facets, f, positions));
    });
    Positions<Dim> normals(Dim, surface.vertices.cols());
    parallel_for(normals.cols(), kChunk, [&](Eigen::Index i) {
        Vector<Dim> sum = Vector<Dim>::Zero();
        for (std::uint32_t k = surface.facet_begin[i]; k < surface.facet_begin[i + 1]; ++k) {
            sum += of_facets.col(surface.facet_of[k]);
        }
        normals.col(i) = sum.stableNormalized();
    });
    return normals;
}

template Vector<3> facet_normal<3>(const Corners<3, 3>&);
template Vector<4> facet_normal<4>(const Corners<4, 4>&);
template Positions<3> vertex_normals<3>(const Surface<3>&, const PositionsView<3>&);
template Positions<4> vertex_normals<4>(const Surface<4>&, const PositionsView<4>&);

}  // namespace pent::contact
