#include "surface_trees.h"

#include "boxes_around.h"

#include <pent/dimensions.h>

namespace pent::contact {

template <int Dim>
template <int Count>
void SurfaceTrees<Dim>::update(const Surface<Dim>& surface, const std::vector<Box>& boxes) {
    const Simplices<Count>& simplices = surface.template simplices<Count>();
    if (simplices.cols() == 0) {
        return;
    }
    const bool is_new = trees_[Count - 1].update(hulls<Count>(simplices, boxes));
    built_ += is_new ? 1 : 0;
    refit_ += is_new ? 0 : 1;
}

template <int Dim>
void SurfaceTrees<Dim>::update_vertices(const Surface<Dim>& surface,
                                        const std::vector<Box>& boxes) {
    update<1>(surface, boxes);
}

template <int Dim>
void SurfaceTrees<Dim>::update_facets(const Surface<Dim>& surface, const std::vector<Box>& boxes) {
    update<Dim>(surface, boxes);
}

template <int Dim>
void SurfaceTrees<Dim>::update_faces(const Surface<Dim>& surface, const std::vector<Box>& boxes) {
    update<2>(surface, boxes);
    update<3>(surface, boxes);
    if constexpr (Dim > 3) {
        update<4>(surface, boxes);
    }
}

template <int Dim>
std::int64_t SurfaceTrees<Dim>::bytes() const {
    std::int64_t sum = 0;
    for (const RefitTree& tree : trees_) {
        sum += tree.tree().bytes();
    }
    return sum;
}

#define PENT_INSTANTIATE(Dim) template class SurfaceTrees<Dim>;
PENT_FOR_EACH_DIMENSION(PENT_INSTANTIATE)
#undef PENT_INSTANTIATE

}  // namespace pent::contact
