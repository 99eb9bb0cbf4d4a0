#include "contact_table.h"

#include <pent/contact/contacts.h>
#include <pent/real_text.h>

namespace pent::simulator {

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
        text += contact.kind == contact::ContactKind::PointFacet ? "point-facet," : "mixed,";
        text += bodies[static_cast<std::size_t>(contact.first_body)] + ","
                + bodies[static_cast<std::size_t>(contact.second_body)];
        add(text, contact.distance);
        add_vector<Dim>(text, -contact.response.gradient);
        for (int i = 0; i <= Dim; ++i) {
            const int body = body_of(simulation, contact.vertices[static_cast<std::size_t>(i)]);
            text += ","
                    + std::to_string(contact.vertices[static_cast<std::size_t>(i)]
                                     - simulation.first_vertex(body));
        }
        for (int i = 0; i <= Dim; ++i) {
            add(text, contact.weights[i]);
        }
        text += '\n';
    }
    for (const contact::ObstacleContact<Dim>& contact : simulation.obstacle_contacts()) {
        const int body = body_of(simulation, contact.vertex);
        text += "obstacle," + bodies[static_cast<std::size_t>(body)] + ","
                + std::to_string(contact.obstacle);
        add(text, contact.distance);
        add_vector<Dim>(text, -contact.response.gradient);
        text += "," + std::to_string(contact.vertex - simulation.first_vertex(body))
                + std::string(Dim, ',') + ",1" + std::string(Dim, ',') + "\n";
    }
    return text;
}

template std::string contact_table<3>(const Simulation<3>&, const std::vector<std::string>&);
template std::string contact_table<4>(const Simulation<4>&, const std::vector<std::string>&);

}  // namespace pent::simulator
