#include "normals.h"

#include "gather.h"

#include <pent/geometry.h>
#include <pent/parallel.h>

namespace pent::contact {

namespace {

// Normals of one thread at a time.
constexpr int kChunk = 1024;

}  // namespace

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

#ifndef PENT_ONLY_4D
template Positions<3> vertex_normals<3>(const Surface<3>&, const PositionsView<3>&);
#endif
template Positions<4> vertex_normals<4>(const Surface<4>&, const PositionsView<4>&);

}  // namespace pent::contact
