#include "run/contact_table.h"

#include <pent/contact/contact.h>
#include <pent/real_text.h>

namespace pent::runs {

namespace {

void add(std::string& text, double value) {
    char digits[32];
    const auto [end, error] = real_to_chars(digits, digits + sizeof digits, value);
    text.append(1, ',').append(digits, end);
}

void add_names(std::string& text, char letter, int count) {
    for (int i = 0; i < count; ++i) {
        text += std::string(",") + letter + std::to_string(i);
    }
}

template <int Dim>
void add_vector(std::string& text, const contact::Vector<Dim>& vector) {
    for (int axis = 0; axis < Dim; ++axis) {
        add(text, vector[axis]);
    }
}

// Which body a vertex counted through all bodies belongs to.
template <int Dim>
int body_of(const Simulation<Dim>& simulation, std::uint32_t vertex) {
    int body = 0;
    while (body + 1 < simulation.body_count() && simulation.first_vertex(body + 1) <= vertex) {
        ++body;
    }
    return body;
}

template <int Dim>
const char* kind_of(const contact::Contact<Dim>& contact) {
    if (contact.second.is_obstacle()) {
        return "obstacle,";
    }
    return contact.kind == contact::ContactKind::PointFacet ? "point-facet," : "mixed,";
}

}  // namespace

template <int Dim>
std::string contact_table(const Simulation<Dim>& simulation,
                          const std::vector<std::string>& bodies) {
    std::string text = "kind,first,second,distance";
    for (int axis = 0; axis < Dim; ++axis) {
        text += std::string(",f") + "xyzw"[axis];
    }
    add_names(text, 'v', Dim + 1);
    add_names(text, 'w', Dim + 1);
    text += '\n';
    for (const contact::Contact<Dim>& contact : simulation.contacts()) {
        text += kind_of(contact);
        text += bodies[contact.first.index] + ',';
        text += contact.second.is_obstacle() ? std::to_string(contact.second.index)
                                             : bodies[contact.second.index];
        add(text, contact.distance);
        add_vector<Dim>(text, -contact.slope * contact.direction);
        for (int i = 0; i <= Dim; ++i) {
            text += ',';
            if (i < contact.count) {
                const std::uint32_t vertex = contact.vertices[static_cast<std::size_t>(i)];
                text +=
                    std::to_string(vertex - simulation.first_vertex(body_of(simulation, vertex)));
            }
        }
        for (int i = 0; i <= Dim; ++i) {
            if (i < contact.count) {
                add(text, contact.weights[i]);
            } else {
                text += ',';
            }
        }
        text += '\n';
    }
    return text;
}

template std::string contact_table<3>(const Simulation<3>&, const std::vector<std::string>&);
template std::string contact_table<4>(const Simulation<4>&, const std::vector<std::string>&);

}  // namespace pent::runs
