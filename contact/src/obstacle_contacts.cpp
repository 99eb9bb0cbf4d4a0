#include "obstacle_contacts.h"

#include <pent/dimensions.h>

namespace pent::contact {

namespace {

constexpr std::size_t kChunk = 1024;

template <int Dim>
Contact<Dim> surface_contact(std::uint32_t vertex,
                             std::uint32_t obstacle,
                             const SignedDistance<Dim>& distance) {
    Contact<Dim> contact;
    contact.vertices[0] = vertex;
    contact.weights[0] = 1;
    contact.direction = distance.gradient;
    contact.distance = distance.value;
    contact.kind = ContactKind::Surface;
    contact.second = {Collider::Kind::Obstacle, obstacle};
    contact.count = contact.first_count = contact.corner_count = 1;
    return contact;
}

}  // namespace

template <int Dim>
std::vector<std::uint32_t> vertices_at_obstacles(const Colliders<Dim>& colliders) {
    const ContactScene<Dim>& scene = colliders.scene();
    std::vector<std::uint32_t> vertices;
    if (scene.obstacles.empty()) {
        return vertices;
    }
    if (!colliders.is_barrier()) {
        for (std::uint32_t vertex = 0; vertex < scene.is_fixed.size(); ++vertex) {
            if (!scene.is_fixed[vertex]) {
                vertices.push_back(vertex);
            }
        }
        return vertices;
    }
    for (const ContactBody<Dim>& body : scene.bodies) {
        for (const std::uint32_t vertex : body.surface.vertices.reshaped()) {
            if (!body.is_kinematic && !colliders.may_enter_obstacles(vertex)) {
                vertices.push_back(vertex);
            }
        }
    }
    return vertices;
}

template <int Dim>
std::vector<Contact<Dim>> find_obstacle_contacts(const Colliders<Dim>& colliders,
                                                 const std::vector<std::uint32_t>& vertices,
                                                 const PositionsView<Dim>& positions,
                                                 const SharedWork& shared) {
    const ContactScene<Dim>& scene = colliders.scene();
    std::vector<Contact<Dim>> contacts;
    for (std::uint32_t o = 0; o < scene.obstacles.size(); ++o) {
        if (!meets_vertices(colliders, o)) {
            continue;
        }
        const ContactObstacle<Dim>& obstacle = scene.obstacles[o];
        const double distance = colliders.is_barrier()
                                    ? scene.options.distance + scene.options.separation
                                    : obstacle.distance;
        const std::vector<Contact<Dim>> found = shared.collect<Contact<Dim>>(
            vertices.size(), kChunk, [&](std::size_t i, std::vector<Contact<Dim>>& list) {
                const SignedDistance<Dim> at =
                    signed_distance<Dim>(obstacle.shape, positions.col(vertices[i]));
                if (at.value < distance) {
                    list.push_back(surface_contact<Dim>(vertices[i], o, at));
                    list.back().first = body_of<Dim>(scene, vertices[i]);
                }
            });
        contacts.insert(contacts.end(), found.begin(), found.end());
    }
    return contacts;
}

#define PENT_INSTANTIATE(Dim)                                                                \
    template std::vector<std::uint32_t> vertices_at_obstacles(const Colliders<Dim>&);        \
    template std::vector<Contact<Dim>> find_obstacle_contacts(                               \
        const Colliders<Dim>&, const std::vector<std::uint32_t>&, const PositionsView<Dim>&, \
        const SharedWork&);
PENT_FOR_EACH_DIMENSION(PENT_INSTANTIATE)
#undef PENT_INSTANTIATE

}  // namespace pent::contact
