#include "surface_trees.h"

#include "chunks.h"

namespace pent::contact {

namespace {

// The smallest boxes around those of the corners.
template <int Count>
std::vector<Box> hulls(const Simplices<Count>& simplices, const std::vector<Box>& boxes) {
    constexpr std::size_t kChunk = 4096;
    std::vector<Box> hulls(static_cast<std::size_t>(simplices.cols()));
    for_each_chunk(hulls.size(), kChunk,
                   [&](std::size_t /*chunk*/, std::size_t begin, std::size_t end) {
                       for (std::size_t i = begin; i < end; ++i) {
                           const auto corners = simplices.col(static_cast<Eigen::Index>(i));
                           Box box = boxes[corners[0]];
                           for (int corner = 1; corner < Count; ++corner) {
                               box = hull(box, boxes[corners[corner]]);
                           }
                           hulls[i] = box;
                       }
                   });
    return hulls;
}

}  // namespace

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

template class SurfaceTrees<3>;
template class SurfaceTrees<4>;

}  // namespace pent::contact
