#include "normals.h"

#include "gather.h"

#include <pent/dimensions.h>
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

#define PENT_INSTANTIATE(Dim) \
    template Positions<Dim> vertex_normals<Dim>(const Surface<Dim>&, const PositionsView<Dim>&);
PENT_FOR_EACH_DIMENSION(PENT_INSTANTIATE)
#undef PENT_INSTANTIATE

}  // namespace pent::contact
