#include "pent/contact/contacts.h"

#include <pent/error.h>
#include <pent/parallel.h>

#include <algorithm>
#include <cmath>
#include <string>

namespace pent::contact {

namespace {

constexpr std::size_t kChunk = 1024;

void require(
    bool is_right, const char* name, const char* field, double value, const char* expected) {
    if (!is_right) {
        throw Error(std::string(name) + ": " + field + " is " + std::to_string(value)
                    + ", expected " + expected);
    }
}

}  // namespace

void check(const ContactOptions& options, const char* name) {
    require(std::isfinite(options.distance) && options.distance > 0, name, "distance",
            options.distance, "a length above 0 m");
    require(std::isfinite(options.stiffness) && options.stiffness > 0, name, "stiffness",
            options.stiffness, "a number above 0 N/m");
    require(std::isfinite(options.margin) && options.margin >= 0, name, "margin", options.margin,
            "a length of 0 m or more");
}

template <int Dim>
void add_forces(const std::vector<Contact<Dim>>& contacts, Positions<Dim>& forces) {
    for (const Contact<Dim>& contact : contacts) {
        for (int i = 0; i <= Dim; ++i) {
            forces.col(contact.vertices[i]) += contact.force(i);
        }
    }
}

template <int Dim>
std::vector<ObstacleContact<Dim>> find_obstacle_contacts(
    const std::vector<PenaltyObstacle<Dim>>& obstacles,
    const std::vector<std::uint32_t>& vertices,
    const PositionsView<Dim>& positions,
    Filter filter) {
    const std::size_t chunks = (vertices.size() + kChunk - 1) / kChunk;
    std::vector<std::vector<ObstacleContact<Dim>>> found(chunks * obstacles.size());
    parallel_for(found.size(), [&](std::size_t piece) {
        const std::size_t which = piece / chunks;
        const PenaltyObstacle<Dim>& obstacle = obstacles[which];
        const std::size_t begin = piece % chunks * kChunk;
        const std::size_t end = std::min(begin + kChunk, vertices.size());
        for (std::size_t i = begin; i < end; ++i) {
            const Vector<Dim> point = positions.col(vertices[i]);
            const double distance = signed_distance<Dim>(obstacle.shape, point);
            if (distance < obstacle.penalty.distance) {
                found[piece].push_back(
                    {vertices[i], static_cast<std::int32_t>(which), distance,
                     obstacle_response<Dim>(obstacle.shape, point, obstacle.penalty, filter)});
            }
        }
    });
    std::vector<ObstacleContact<Dim>> contacts;
    for (const auto& part : found) {
        contacts.insert(contacts.end(), part.begin(), part.end());
    }
    return contacts;
}

template void add_forces<3>(const std::vector<Contact<3>>&, Positions<3>&);
template std::vector<ObstacleContact<3>> find_obstacle_contacts<3>(
    const std::vector<PenaltyObstacle<3>>&,
    const std::vector<std::uint32_t>&,
    const PositionsView<3>&,
    Filter);
template void add_forces<4>(const std::vector<Contact<4>>&, Positions<4>&);
template std::vector<ObstacleContact<4>> find_obstacle_contacts<4>(
    const std::vector<PenaltyObstacle<4>>&,
    const std::vector<std::uint32_t>&,
    const PositionsView<4>&,
    Filter);

}  // namespace pent::contact
