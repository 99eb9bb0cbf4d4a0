#pragma once

#include <pent/contact/contact.h>
#include <pent/contact/surface.h>

#include <optional>

namespace pent::contact {

/// The setting in which pairs of two bodies (or of one) are judged under the penalty model.
template <int Dim>
struct PairSetting {
    const PositionsView<Dim>& positions;
    const Positions<Dim>& rest;     ///< Read for pairs within a body.
    const Positions<Dim>& normals;  ///< Unit outward normals at boundary vertices; read for local
                                    ///< contacts.
    double distance = 0;            ///< Of contact, m.
    Collider first;
    Collider second;
};

/// Contact of a vertex with another body at its nearest facet; none if it is outside and too far.
template <int Dim>
[[nodiscard]] std::optional<Contact<Dim>> solid_contact(const PairSetting<Dim>& setting,
                                                        std::uint32_t vertex,
                                                        const Simplices<Dim>& facets,
                                                        std::uint32_t facet,
                                                        bool is_inside);

/// Contact of two simplices, whether they are crossed being told by the normals beside them.
template <int Dim, int K, int L>
[[nodiscard]] std::optional<Contact<Dim>> local_contact(const PairSetting<Dim>& setting,
                                                        const Simplices<K>& first,
                                                        std::uint32_t i,
                                                        const Simplices<L>& second,
                                                        std::uint32_t j);

}  // namespace pent::contact
