#include "surface_patches.h"

#include "boxes_around.h"

#include <pent/dimensions.h>

namespace pent::contact {

template <int Dim>
template <typename Work>
void SurfacePatches<Dim>::for_each_kind(const Work& work) {
    work(surface_.vertices, kinds_[0]);
    work(surface_.edges, kinds_[1]);
    work(surface_.template simplices<3>(), kinds_[2]);
    if constexpr (Dim > 3) {
        work(surface_.facets, kinds_[Dim - 1]);
    }
}

template <int Dim>
SurfacePatches<Dim>::SurfacePatches(const Surface<Dim>& surface, const PositionsView<Dim>& rest)
    : surface_(surface) {
    for_each_kind([&]<int Count>(const Simplices<Count>& simplices, PatchesOnPaths<Dim>& patches) {
        patches.partition = PatchPartition(boxes_around<Dim, Count>(simplices, rest, 0));
    });
}

template <int Dim>
void SurfacePatches<Dim>::fit(const Paths<Dim>& paths, const std::vector<Box>& of_vertex) {
    constexpr int kPatches = 64;
    for_each_kind([&]<int Count>(const Simplices<Count>& simplices, PatchesOnPaths<Dim>& patches) {
        const std::size_t size = patches.partition.size();
        patches.around.resize(size);
        patches.inflation.assign(size, 0);
        parallel_for(size, kPatches, [&](std::size_t patch) {
            const std::span<const std::uint32_t> members = patches.partition[patch];
            Box all = of_vertex[simplices(0, members[0])];
            double most = 0;
            for (const std::uint32_t i : members) {
                for (int corner = 0; corner < Count; ++corner) {
                    const std::uint32_t v = simplices(corner, i);
                    all = hull(all, of_vertex[v]);
                    most = std::max(most, paths.inflation_of(v));
                }
            }
            patches.around[patch] = all;
            patches.inflation[patch] = most;
        });
        patches.tree = BoxTree::in_order(patches.around);
        ++refit_;
    });
}

template <int Dim>
void SurfacePatches<Dim>::set_lanes(const Paths<Dim>& paths) {
    for_each_kind([&]<int Count>(const Simplices<Count>& simplices, PatchesOnPaths<Dim>& patches) {
        patches.at_start.set(simplices, patches.partition, paths.from);
        if (!paths.is_still()) {
            patches.at_end.set(simplices, patches.partition, paths.to);
        }
    });
}

template <int Dim>
std::int64_t SurfacePatches<Dim>::bytes() const {
    std::int64_t sum = 0;
    for (const PatchesOnPaths<Dim>& patches : kinds_) {
        sum += patches.partition.bytes() + patches.tree.bytes() + patches.at_start.bytes()
               + patches.at_end.bytes()
               + static_cast<std::int64_t>(patches.around.size() * sizeof(Box)
                                           + patches.inflation.size() * sizeof(double));
    }
    return sum;
}

#define PENT_INSTANTIATE(Dim) template class SurfacePatches<Dim>;
PENT_FOR_EACH_DIMENSION(PENT_INSTANTIATE)
#undef PENT_INSTANTIATE

}  // namespace pent::contact
