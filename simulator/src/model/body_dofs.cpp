#include "model/body_dofs.h"

#include <pent/dimensions.h>

#include <algorithm>
#include <utility>

namespace pent::simulator {

namespace {

// One entry a vertex: whether it is held, or of a body that is not in.
template <int Dim>
std::vector<bool> fixed_vertices(const Bodies<Dim>& bodies,
                                 const HeldVertices<Dim>& held,
                                 const std::vector<bool>& is_in) {
    std::vector<bool> is_fixed = held.now();
    for (std::size_t body = 0; body < is_in.size(); ++body) {
        if (!is_in[body]) {
            std::fill(is_fixed.begin() + bodies.first_vertex[body],
                      is_fixed.begin() + bodies.first_vertex[body + 1], true);
        }
    }
    return is_fixed;
}

// One entry a vertex: whether rows of this rank may have a column of it.
template <int Dim>
std::vector<bool> coupled_vertices(const Bodies<Dim>& bodies) {
    std::vector<bool> is_coupled(static_cast<std::size_t>(bodies.vertex_count()),
                                 bodies.may_couple_anything);
    for (const std::uint32_t vertex : bodies.cells().reshaped()) {
        is_coupled[vertex] = true;
    }
    return is_coupled;
}

}  // namespace

template <int Dim>
DofMap number_dofs(const Bodies<Dim>& bodies,
                   const HeldVertices<Dim>& held,
                   const std::vector<bool>& is_in) {
    const std::vector<bool> is_fixed = fixed_vertices(bodies, held, is_in);
    if (!bodies.sharing.is_shared()) {
        return number_dofs<Dim>(bodies.cells(), is_fixed, number_columns(bodies.meshes));
    }
    const std::vector<bool> is_coupled = coupled_vertices(bodies);
    std::vector<bool> is_own(is_fixed.size());
    std::vector<bool> has_no_row = is_fixed;
    std::vector<std::uint32_t> others;
    for (std::uint32_t vertex = 0; vertex < is_fixed.size(); ++vertex) {
        is_own[vertex] = bodies.sharing.owns(vertex);
        has_no_row[vertex] = is_fixed[vertex] || !is_own[vertex];
        if (!is_fixed[vertex] && !is_own[vertex] && is_coupled[vertex]) {
            others.push_back(vertex);
        }
    }
    const DofMap own = number_dofs<Dim>(bodies.cells(), has_no_row, number_columns(bodies.meshes));
    std::vector<std::uint32_t> vertex_of_dof = own.vertices();
    vertex_of_dof.insert(vertex_of_dof.end(), others.begin(), others.end());
    return {is_fixed.size(), std::move(vertex_of_dof), own.column_start(), std::move(is_own)};
}

template <int Dim>
DofMap number_dofs_alike(const Bodies<Dim>& bodies,
                         const HeldVertices<Dim>& held,
                         const std::vector<bool>& is_in) {
    if (!bodies.sharing.is_shared()) {
        return number_dofs(bodies, held, is_in);
    }
    const std::vector<bool> is_fixed = fixed_vertices(bodies, held, is_in);
    std::vector<std::uint32_t> free;
    for (std::uint32_t vertex = 0; vertex < is_fixed.size(); ++vertex) {
        if (!is_fixed[vertex]) {
            free.push_back(vertex);
        }
    }
    const auto count = static_cast<std::uint32_t>(free.size());
    return {is_fixed.size(), std::move(free), {0, count}};
}

#define PENT_INSTANTIATE(Dim)                                                            \
    template DofMap number_dofs<Dim>(const Bodies<Dim>&, const HeldVertices<Dim>&,       \
                                     const std::vector<bool>&);                          \
    template DofMap number_dofs_alike<Dim>(const Bodies<Dim>&, const HeldVertices<Dim>&, \
                                           const std::vector<bool>&);
PENT_FOR_EACH_DIMENSION(PENT_INSTANTIATE)
#undef PENT_INSTANTIATE

}  // namespace pent::simulator
