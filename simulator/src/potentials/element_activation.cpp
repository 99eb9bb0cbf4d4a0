// Elements with the rest shapes that activations give them: a part of Elements.

#include "model/active_strain.h"
#include "potentials/elements.h"

#include <pent/dimensions.h>

#include <algorithm>

namespace pent::simulator {

// Keeps the rest shapes of the last chunk, if any of its elements will be activated.
template <int Dim>
void Elements<Dim>::keep_passive(std::span<const Eigen::Index> chosen,
                                 const ActiveStrain<Dim>* strain) {
    const auto is_active = [&](Eigen::Index element) {
        return strain->of_element(element) != nullptr;
    };
    if (strain == nullptr || std::none_of(chosen.begin(), chosen.end(), is_active)) {
        return;
    }
    passive_.push_back(
        {.chunk = chunks_.size() - 1,
         .elements = {chosen.begin(), chosen.end()},
         .rest = {rest_.begin() + static_cast<std::ptrdiff_t>(chunks_.back().first_rest),
                  rest_.end()}});
}

template <int Dim>
void Elements<Dim>::activate(const Workers& workers, const ActiveStrain<Dim>& strain) {
    workers.for_each(static_cast<int>(passive_.size()),
                     [&](int i) { activate(passive_[static_cast<std::size_t>(i)], strain); });
}

// F is X G^T, the columns of G being the gradients of the shape functions of corners at rest. So Fe
// = F Fa^-1 is that of the gradients Fa^-T G, and volumes are multiplied by det Fa.
template <int Dim>
void Elements<Dim>::activate(const Passive& passive, const ActiveStrain<Dim>& strain) {
    const Chunk& chunk = chunks_[passive.chunk];
    const std::size_t rows = rest_rows(chunk);
    // Behind the gradients at a point of a quadratic element stands its share of the volume.
    const std::size_t per_point =
        std::size_t{Dim} * Dim + (chunk.kind == ElementKind::Quadratic ? 1 : 0);
    for (std::size_t lane = 0; lane < passive.elements.size(); ++lane) {
        const auto* shape = strain.of_element(passive.elements[lane]);
        if (shape == nullptr) {
            continue;
        }
        const std::size_t first = lane / kGroup * kGroup * rows + lane % kGroup;
        const auto at = [&](std::size_t row) { return first + row * kGroup; };
        for (std::size_t point = 0; point + per_point < rows; point += per_point) {
            for (std::size_t corner = 0; corner < Dim; ++corner) {
                Vector<Dim> gradient;
                const std::size_t row = point + corner * Dim;
                for (std::size_t j = 0; j < Dim; ++j) {
                    gradient[static_cast<Eigen::Index>(j)] = passive.rest[at(row + j)];
                }
                gradient = (shape->inverse.transpose() * gradient).eval();
                for (std::size_t j = 0; j < Dim; ++j) {
                    rest_[chunk.first_rest + at(row + j)] = gradient[static_cast<Eigen::Index>(j)];
                }
            }
        }
        rest_[chunk.first_rest + at(rows - 1)] = passive.rest[at(rows - 1)] * shape->growth;
    }
}

#define PENT_INSTANTIATE(Dim)                                                \
    template void Elements<Dim>::keep_passive(std::span<const Eigen::Index>, \
                                              const ActiveStrain<Dim>*);     \
    template void Elements<Dim>::activate(const Workers&, const ActiveStrain<Dim>&);
PENT_FOR_EACH_DIMENSION(PENT_INSTANTIATE)
#undef PENT_INSTANTIATE

}  // namespace pent::simulator
