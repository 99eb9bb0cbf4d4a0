#include "shell.h"

#include "cgal_mesh.h"

#include <CGAL/Side_of_triangle_mesh.h>
#include <utility>

namespace pent::mesher {

struct Shell::Tree {
    explicit Tree(const Surface& surface) : mesh(to_cgal(surface)), side(mesh) {}

    CgalMesh mesh;
    CGAL::Side_of_triangle_mesh<CgalMesh, Kernel> side;
};

Shell::Shell(Surface surface) : surface_(std::move(surface)), volume_(enclosed_volume(surface_)) {
    for (const auto& point : surface_.points.colwise()) {
        box_.extend(Eigen::Vector3d(point));
    }
}

Shell::~Shell() = default;
Shell::Shell(Shell&& other) noexcept = default;

bool Shell::is_around(const Eigen::Vector3d& point) {
    if (!box_.contains(point)) {
        return false;
    }
    if (tree_ == nullptr) {
        tree_ = std::make_unique<Tree>(surface_);
    }
    return tree_->side(Kernel::Point_3(point[0], point[1], point[2])) == CGAL::ON_BOUNDED_SIDE;
}

}  // namespace pent::mesher
