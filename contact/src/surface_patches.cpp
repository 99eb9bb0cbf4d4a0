#include "surface_patches.h"

#include "boxes_around.h"

#include <pent/dimensions.h>

namespace pent::contact {

template <int Dim>
SurfacePatches<Dim>::SurfacePatches(const Surface<Dim>& surface, const PositionsView<Dim>& rest) {
    const auto set = [&]<int Count>(const Simplices<Count>& simplices) {
        PatchesOnPaths<Dim>& patches = kinds_[Count - 1];
        patches.partition = PatchPartition(boxes_around<Dim, Count>(simplices, rest, 0));
        patches.vertices = PatchVertices(simplices, patches.partition);
    };
    set(surface.vertices);
    set(surface.edges);
    set(surface.template simplices<3>());
    if constexpr (Dim > 3) {
        set(surface.facets);
    }
}

template <int Dim>
void SurfacePatches<Dim>::fit(const Paths<Dim>& paths, const std::vector<Box>& of_vertex) {
    constexpr int kPatches = 64;
    for (PatchesOnPaths<Dim>& patches : kinds_) {
        const std::size_t size = patches.partition.size();
        patches.around.resize(size);
        patches.inflation.resize(size);
        parallel_for(size, kPatches, [&](std::size_t patch) {
            Box all = kNowhere;
            double most = 0;
            for (const std::uint32_t v : patches.vertices[patch]) {
                all = hull(all, of_vertex[v]);
                most = std::max(most, paths.inflation_of(v));
            }
            patches.around[patch] = all;
            patches.inflation[patch] = most;
        });
        patches.tree = BoxTree::in_order(patches.around);
        ++refit_;
    }
}

template <int Dim>
void SurfacePatches<Dim>::set_lanes(const Paths<Dim>& paths) {
    for (PatchesOnPaths<Dim>& patches : kinds_) {
        patches.at_start.set(patches.vertices, paths.from);
        if (!paths.is_still()) {
            patches.at_end.set(patches.vertices, paths.to);
        }
    }
}

template <int Dim>
std::int64_t SurfacePatches<Dim>::bytes() const {
    std::int64_t sum = 0;
    for (const PatchesOnPaths<Dim>& patches : kinds_) {
        sum += patches.partition.bytes() + patches.vertices.bytes() + patches.tree.bytes()
               + patches.at_start.bytes() + patches.at_end.bytes()
               + static_cast<std::int64_t>(patches.around.size() * sizeof(Box)
                                           + patches.inflation.size() * sizeof(double));
    }
    return sum;
}

#define PENT_INSTANTIATE(Dim) template class SurfacePatches<Dim>;
PENT_FOR_EACH_DIMENSION(PENT_INSTANTIATE)
#undef PENT_INSTANTIATE

}  // namespace pent::contact
