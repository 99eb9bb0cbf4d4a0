// What a host sees of a simulation.

#include "handles.h"

#include <pent/contact/contact.h>
#include <pent/facets.h>
#include <pent/simulator/picking.h>

#include <algorithm>
#include <utility>

using namespace pent;
using namespace pent::plugin;

namespace {

// `array(simulation)` for a body that is there.
template <typename Number, typename Array>
const Number* numbers(const pent_simulation* simulation, int body, const Array& array) {
    return with_body<const Number*>(
        simulation, body, nullptr,
        [&](auto& held, Opened& /*opened*/) -> const Number* { return array(held).data(); });
}

template <int Dim>
pent_hit c_hit(const simulator::Pick<Dim>& pick) {
    pent_hit hit = {};
    hit.point.body = pick.point.body;
    hit.point.cell = pick.point.cell;
    std::copy_n(pick.point.weights.data(), Dim + 1, hit.point.weights);
    std::copy_n(pick.place.data(), Dim, hit.place);
    hit.distance = pick.distance;
    return hit;
}

template <int Dim>
pent_contact c_contact(const contact::Contact<Dim>& contact) {
    pent_contact seen = {};
    seen.first = static_cast<std::int32_t>(contact.first.index);
    seen.second = static_cast<std::int32_t>(contact.second.index);
    seen.is_obstacle = contact.second.is_obstacle() ? 1 : 0;
    seen.distance = contact.distance;
    Eigen::Map<Eigen::Matrix<double, Dim, 1>> force(seen.force);
    for (int i = 0; i < contact.first_count; ++i) {
        force += contact.force(i);
    }
    return seen;
}

}  // namespace

int pent_dimension(const pent_simulation* simulation) {
    return with(simulation, -1, [](auto& held, Opened& /*opened*/) {
        return kDimOf<std::remove_reference_t<decltype(held)>>;
    });
}

double pent_time_step(const pent_simulation* simulation) {
    return with(simulation, -1.0, [](auto& held, Opened& /*opened*/) { return held.scene().dt(); });
}

double pent_time(const pent_simulation* simulation) {
    return with(simulation, -1.0, [](auto& held, Opened& /*opened*/) { return held.time(); });
}

int pent_body_count(const pent_simulation* simulation) {
    return with(simulation, -1, [](auto& held, Opened& /*opened*/) { return held.body_count(); });
}

int pent_obstacle_count(const pent_simulation* simulation) {
    return with(simulation, -1, [](auto& held, Opened& /*opened*/) {
        return static_cast<int>(held.obstacles().size());
    });
}

const char* pent_body_name(const pent_simulation* simulation, int body) {
    return with_body<const char*>(simulation, body, nullptr, [&](auto& held, Opened& /*opened*/) {
        return held.scene().bodies[static_cast<std::size_t>(body)].name.c_str();
    });
}

int pent_find_body(const pent_simulation* simulation, const char* name) {
    return with(simulation, -1, [&](auto& held, Opened& /*opened*/) {
        require(name, "name");
        const auto& bodies = held.scene().bodies;
        const auto found = std::find_if(bodies.begin(), bodies.end(),
                                        [&](const auto& body) { return body.name == name; });
        if (found == bodies.end()) {
            std::string names;
            for (const auto& body : bodies) {
                names += (names.empty() ? "" : ", ") + body.name;
            }
            throw Error(std::string("no body is called \"") + name + "\"; there are " + names);
        }
        return static_cast<int>(found - bodies.begin());
    });
}

int64_t pent_vertex_count(const pent_simulation* simulation, int body) {
    return with_body<int64_t>(simulation, body, -1, [&](auto& held, Opened& /*opened*/) {
        return held.mesh(body).vertex_count();
    });
}

int64_t pent_cell_count(const pent_simulation* simulation, int body) {
    return with_body<int64_t>(simulation, body, -1, [&](auto& held, Opened& /*opened*/) {
        return held.mesh(body).cell_count();
    });
}

const uint32_t* pent_cells(const pent_simulation* simulation, int body) {
    return numbers<uint32_t>(
        simulation, body, [&](auto& held) -> const auto& { return held.mesh(body).cells; });
}

const double* pent_rest_positions(const pent_simulation* simulation, int body) {
    return numbers<double>(
        simulation, body, [&](auto& held) -> const auto& { return held.mesh(body).positions; });
}

const double* pent_positions(const pent_simulation* simulation, int body) {
    return numbers<double>(simulation, body, [&](auto& held) { return held.positions(body); });
}

const double* pent_velocities(const pent_simulation* simulation, int body) {
    return numbers<double>(simulation, body, [&](auto& held) { return held.velocities(body); });
}

const double* pent_forces(const pent_simulation* simulation, int body) {
    return numbers<double>(simulation, body, [&](auto& held) { return held.forces(body); });
}

const double* pent_masses(const pent_simulation* simulation, int body) {
    return numbers<double>(simulation, body, [&](auto& held) { return held.masses(body); });
}

int pent_is_asleep(const pent_simulation* simulation, int body) {
    return with_body(simulation, body, -1, [&](auto& held, Opened& /*opened*/) {
        return held.sleep()[static_cast<std::size_t>(body)].is_asleep ? 1 : 0;
    });
}

const uint32_t* pent_boundary(pent_simulation* simulation, int body, int64_t* count) {
    return with_body<const uint32_t*>(
        simulation, body, nullptr, [&](auto& held, Opened& opened) -> const uint32_t* {
            constexpr int kDim = kDimOf<std::remove_reference_t<decltype(held)>>;
            require(count, "count");
            std::vector<std::uint32_t>& found = (*opened.boundaries)[body].facets;
            if (found.empty()) {  // of a body it never is
                const auto& mesh = held.mesh(body);
                const Simplices<kDim> facets =
                    match_facets<kDim>(mesh.cells, mesh.vertex_count()).boundary;
                found.assign(facets.data(), facets.data() + facets.size());
            }
            *count = static_cast<int64_t>(found.size()) / kDim;
            return found.data();
        });
}

int pent_pick(const pent_simulation* simulation,
              const double* normal,
              double offset,
              const double* origin,
              const double* direction,
              pent_hit* hit) {
    return with(simulation, -1, [&](auto& held, Opened& /*opened*/) {
        constexpr int kDim = kDimOf<std::remove_reference_t<decltype(held)>>;
        require(hit, "hit");
        const simulator::Ray<kDim> ray{vector<kDim>(origin, "origin"),
                                       vector<kDim>(direction, "direction")};
        const auto found =
            normal == nullptr
                ? simulator::pick<kDim>(held, ray)
                : simulator::pick<kDim>(held, {vector<kDim>(normal, "normal"), offset}, ray);
        if (found) {
            *hit = c_hit<kDim>(*found);
        }
        return found ? 1 : 0;
    });
}

const pent_contact* pent_contacts(pent_simulation* simulation, int64_t* count) {
    return with<const pent_contact*>(
        simulation, nullptr, [&](auto& held, Opened& opened) -> const pent_contact* {
            require(count, "count");
            opened.contacts.assign(1, {});  // so that none are an array, too
            for (const auto& contact : held.contacts()) {
                opened.contacts.insert(opened.contacts.end() - 1, c_contact(contact));
            }
            *count = static_cast<int64_t>(opened.contacts.size()) - 1;
            return opened.contacts.data();
        });
}

const pent_energy* pent_energies(pent_simulation* simulation, int64_t* count) {
    return with<const pent_energy*>(
        simulation, nullptr, [&](auto& held, Opened& opened) -> const pent_energy* {
            require(count, "count");
            const simulator::Energies energies = held.energies();
            opened.energy_names = {"kinetic"};
            for (const auto& term : energies.terms) {
                opened.energy_names.push_back(term.name);
            }
            opened.energies = {{opened.energy_names[0].c_str(), energies.kinetic, 1}};
            for (const auto& term : energies.terms) {
                opened.energies.push_back({opened.energy_names[opened.energies.size()].c_str(),
                                           term.energy, term.is_stored ? 1 : 0});
            }
            *count = static_cast<int64_t>(opened.energies.size());
            return opened.energies.data();
        });
}
