#pragma once

#include <pent/contact/contact_scene.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace pent::contact {

/// The body that a vertex belongs to: bodies have their vertices one after the other.
template <int Dim>
[[nodiscard]] Collider body_of(const ContactScene<Dim>& scene, std::uint32_t vertex) {
    const auto after = std::upper_bound(scene.bodies.begin(), scene.bodies.end(), vertex,
                                        [](std::uint32_t v, const ContactBody<Dim>& body) {
                                            return v < body.surface.first_vertex;
                                        });
    const auto count = after - scene.bodies.begin();
    return {Collider::Kind::Body,
            static_cast<std::uint32_t>(std::max<std::ptrdiff_t>(count, 1) - 1)};
}

/// All surfaces of a scene in one list: its bodies and, under a barrier, the cores of the obstacles
/// that repel facets, which are bodies that do not move. Their vertices are counted on from those
/// of the scene.
template <int Dim>
class Colliders {
public:
    /// The scene must outlive this.
    explicit Colliders(const ContactScene<Dim>& scene);

    [[nodiscard]] const ContactScene<Dim>& scene() const { return scene_; }
    [[nodiscard]] bool is_barrier() const { return scene_.options.model == ContactModel::Barrier; }

    [[nodiscard]] int count() const {
        return static_cast<int>(scene_.bodies.size() + cores_.size());
    }
    [[nodiscard]] bool is_core(int i) const { return place(i) >= scene_.bodies.size(); }
    [[nodiscard]] const Surface<Dim>& surface(int i) const {
        return is_core(i) ? core(i).surface : scene_.bodies[place(i)].surface;
    }
    /// The cells of a collider; a core has none.
    [[nodiscard]] std::span<const std::uint32_t> cells(int i) const {
        return is_core(i) ? std::span<const std::uint32_t>() : scene_.bodies[place(i)].cells;
    }
    [[nodiscard]] bool is_kinematic(int i) const {
        return is_core(i) || scene_.bodies[place(i)].is_kinematic;
    }
    [[nodiscard]] Collider collider(int i) const {
        return is_core(i) ? Collider{Collider::Kind::Obstacle, core(i).obstacle}
                          : Collider{Collider::Kind::Body, static_cast<std::uint32_t>(i)};
    }

    /// How thick a collider is beyond its surface, m: the radius of a core.
    [[nodiscard]] double radius(int i) const { return is_core(i) ? core(i).radius : 0; }

    /// Whether contacts of the two, or within one, are looked for at all.
    [[nodiscard]] bool can_meet(int a, int b) const;

    /// Whether a vertex is held or moved from outside, as those of cores are.
    [[nodiscard]] bool is_fixed(std::uint32_t vertex) const {
        return vertex >= scene_.is_fixed.size() || scene_.is_fixed[vertex];
    }

    /// Whether a vertex may go where obstacles are; see ContactScene::is_always_fixed.
    [[nodiscard]] bool may_enter_obstacles(std::uint32_t vertex) const {
        return is_fixed(vertex)
               && (vertex >= scene_.is_always_fixed.size() || scene_.is_always_fixed[vertex]);
    }

    /// Whether all corners of a simplex are fixed.
    template <int Count>
    [[nodiscard]] bool is_fixed(const Simplices<Count>& simplices, Eigen::Index i) const {
        const auto corners = simplices.col(i);
        return std::all_of(corners.begin(), corners.end(),
                           [&](std::uint32_t corner) { return is_fixed(corner); });
    }

    /// Whether all corners of a simplex may.
    template <int Count>
    [[nodiscard]] bool may_enter_obstacles(const Simplices<Count>& simplices,
                                           Eigen::Index i) const {
        const auto corners = simplices.col(i);
        return std::all_of(corners.begin(), corners.end(),
                           [&](std::uint32_t corner) { return may_enter_obstacles(corner); });
    }

    /// Rest positions of all vertices, those of cores too.
    [[nodiscard]] const Positions<Dim>& rest() const { return rest_; }

    /// After the shapes of obstacles have moved.
    void update_cores();

    /// Calls work(positions) with those of the cores behind those of the scene.
    template <typename Work>
    [[nodiscard]] auto with_cores(const PositionsView<Dim>& positions, const Work& work) const {
        if (cores_.empty()) {
            return work(positions);
        }
        Positions<Dim> all(Dim, positions.cols() + core_points_.cols());
        all << positions, core_points_;
        return work(PositionsView<Dim>(all));
    }

private:
    struct Core {
        Surface<Dim> surface;
        std::uint32_t obstacle = 0;
        double radius = 0;
    };

    static std::size_t place(int i) { return static_cast<std::size_t>(i); }
    [[nodiscard]] const Core& core(int i) const { return cores_[place(i) - scene_.bodies.size()]; }
    void add_core(std::uint32_t obstacle);

    const ContactScene<Dim>& scene_;
    std::vector<Core> cores_;
    Positions<Dim> core_points_;
    Positions<Dim> rest_;
};

}  // namespace pent::contact
