#include "contact_energy.h"

#include "chunks.h"
#include "filter.h"
#include "pair_spectra.h"
#include "spanned_volume.h"

#include <pent/contact/contact_finder.h>
#include <pent/dimensions.h>

#include <algorithm>
#include <cmath>

namespace pent::contact {

namespace {

// Contacts are evaluated in chunks of this many, and energies summed up by chunk.
constexpr std::size_t kChunk = 1024;
constexpr std::size_t kHessianChunk = 64;

// Gradients are summed up in at most so many parts, of at least so many contacts each, which are
// then added in their order.
constexpr std::size_t kMaxParts = 16;
constexpr std::size_t kMinPart = 8192;

template <int Dim>
double volume_squared(const Contact<Dim>& contact, const Stencil<Dim>& points) {
    return spanned_volume_squared<Dim>(points, contact.first_count);
}

template <int Dim>
SignedDistance<Dim> surface_at(const ContactScene<Dim>& scene,
                               const Contact<Dim>& contact,
                               const PositionsView<Dim>& positions) {
    return signed_distance<Dim>(scene.obstacles[contact.second.index].shape,
                                positions.col(contact.vertices[0]));
}

// Energies of some contacts, and what their mollifiers add.
template <int Dim>
struct Sums {
    double bodies = 0;
    double obstacles = 0;
    std::vector<MollifierGradient<Dim>> mollified;
};

template <int Dim>
void add_gradient(const Contacts<Dim>& contacts,
                  std::size_t begin,
                  std::size_t end,
                  Positions<Dim>& gradient) {
    auto extra = std::lower_bound(contacts.mollified.begin(), contacts.mollified.end(), begin,
                                  [](const MollifierGradient<Dim>& part, std::size_t contact) {
                                      return part.contact < contact;
                                  });
    for (std::size_t k = begin; k < end; ++k) {
        const Contact<Dim>& contact = contacts.list[k];
        const Vector<Dim> by_point = contact.slope * contact.direction;
        for (int i = 0; i < contact.count; ++i) {
            gradient.col(contact.vertices[i]) += contact.weights[i] * by_point;
        }
        if (extra != contacts.mollified.end() && extra->contact == k) {
            for (int i = 0; i < contact.count; ++i) {
                gradient.col(contact.vertices[i]) += extra->vector.template segment<Dim>(Dim * i);
            }
            ++extra;
        }
    }
}

}  // namespace

template <int Dim>
DistanceEnergy energy_of(const ContactScene<Dim>& scene,
                         const Contact<Dim>& contact,
                         double stiffness) {
    const ContactOptions& options = scene.options;
    if (options.model == ContactModel::Barrier) {
        return {DistanceLaw::Barrier, options.distance, contact.multiplicity * stiffness,
                options.separation};
    }
    if (contact.second.is_obstacle()) {
        const ContactObstacle<Dim>& obstacle = scene.obstacles[contact.second.index];
        return {DistanceLaw::Penalty, obstacle.distance, obstacle.stiffness};
    }
    return {contact.is_fading ? DistanceLaw::FadingPenalty : DistanceLaw::Penalty, options.distance,
            stiffness};
}

template <int Dim>
Stencil<Dim> corners_of(const Contact<Dim>& contact, const PositionsView<Dim>& positions) {
    Stencil<Dim> points = Stencil<Dim>::Zero();
    for (int i = 0; i < contact.corner_count; ++i) {
        points.col(i) = positions.col(contact.vertices[i]);
    }
    return points;
}

template <int Dim>
bool evaluate(const DistanceEnergy& energy,
              const PositionsView<Dim>& positions,
              Contact<Dim>& contact) {
    contact.energy = contact.share * energy.value(contact.distance);
    contact.slope = contact.share * contact.gain * energy.slope(contact.distance);
    if (!contact.mollifier.is_on()) {
        return false;
    }
    const double c = volume_squared(contact, corners_of<Dim>(contact, positions));
    const double value = contact.mollifier.value(c);
    contact.energy *= value;
    contact.slope *= value;
    return contact.mollifier.slope(c) > 0;
}

template <int Dim>
StencilVector<Dim> mollifier_gradient(const DistanceEnergy& energy,
                                      const Contact<Dim>& contact,
                                      const PositionsView<Dim>& positions) {
    const Stencil<Dim> points = corners_of<Dim>(contact, positions);
    return contact.mollifier.slope(volume_squared(contact, points)) * energy.value(contact.distance)
           * spanned_volume_squared_gradient<Dim>(points, contact.first_count);
}

template <int Dim>
Block<Dim> held_hessian(const DistanceEnergy& energy, const Contact<Dim>& contact, Filter filter) {
    const double d = contact.distance;
    const double factor = contact.share * contact.gain * contact.gain;
    const double slope = factor * energy.slope(d);
    const double curvature = factor * energy.curvature(d);
    double sideways = d == 0 ? 0 : slope / d;
    if (filter != Filter::None) {
        const double most = std::abs(curvature);
        sideways = std::clamp(sideways, -most, most);
    }
    const double along = filtered(curvature, filter);
    sideways = filtered(sideways, filter);
    Block<Dim> hessian = (along - sideways) * contact.direction * contact.direction.transpose();
    hessian.diagonal().array() += sideways;
    return hessian;
}

template <int Dim>
Block<Dim> surface_hessian(const DistanceEnergy& energy,
                           const SignedDistance<Dim>& distance,
                           Filter filter) {
    const double slope = energy.slope(distance.value);
    return distance.combine(filtered(energy.curvature(distance.value), filter),
                            filtered(slope * distance.along_tangent, filter),
                            filtered(slope * distance.sideways, filter));
}

template <int Dim>
Contacts<Dim> evaluate_all(const ContactScene<Dim>& scene,
                           const PositionsView<Dim>& positions,
                           double stiffness,
                           Contacts<Dim> contacts) {
    std::vector<Sums<Dim>> parts((contacts.list.size() + kChunk - 1) / kChunk);
    for_each_chunk(
        contacts.list.size(), kChunk, [&](std::size_t chunk, std::size_t begin, std::size_t end) {
            Sums<Dim>& sums = parts[chunk];
            for (std::size_t k = begin; k < end; ++k) {
                Contact<Dim>& contact = contacts.list[k];
                const DistanceEnergy energy = energy_of<Dim>(scene, contact, stiffness);
                if (evaluate<Dim>(energy, positions, contact)) {
                    sums.mollified.push_back({static_cast<std::uint32_t>(k),
                                              mollifier_gradient<Dim>(energy, contact, positions)});
                }
                (contact.second.is_obstacle() ? sums.obstacles : sums.bodies) += contact.energy;
            }
        });
    for (const Sums<Dim>& sums : parts) {
        contacts.body_energy += sums.bodies;
        contacts.obstacle_energy += sums.obstacles;
        contacts.mollified.insert(contacts.mollified.end(), sums.mollified.begin(),
                                  sums.mollified.end());
    }
    return contacts;
}

template <int Dim>
StencilHessians<Dim> hessians_of(const ContactScene<Dim>& scene,
                                 const Contacts<Dim>& contacts,
                                 const PositionsView<Dim>& positions,
                                 double stiffness,
                                 Filter filter,
                                 StencilHessians<Dim> memory) {
    const bool do_weights_move = scene.options.model == ContactModel::Barrier;
    const std::size_t pairs = do_weights_move ? contacts.pair_count : 0;
    StencilHessians<Dim> hessians = std::move(memory);
    hessians.spectral.resize(pairs);
    hessians.weighted.resize(contacts.list.size() - pairs);
    std::size_t numbers = 0;
    for (std::size_t k = 0; k < pairs; ++k) {
        const Contact<Dim>& contact = contacts.list[k];
        hessians.spectral[k] = {contact.vertices, contact.count, 0, numbers};
        numbers += PairSpectra<Dim>::most_numbers(contact, filter);
    }
    if (hessians.numbers.size() < numbers) {
        hessians.numbers.resize(numbers);
    }
    for_each_chunk(pairs, kHessianChunk,
                   [&](std::size_t /*chunk*/, std::size_t begin, std::size_t end) {
                       PairSpectra<Dim> spectra(filter, hessians.numbers.data());
                       for (std::size_t k = begin; k < end; ++k) {
                           const Contact<Dim>& contact = contacts.list[k];
                           spectra.add(energy_of<Dim>(scene, contact, stiffness), contact,
                                       positions, hessians.spectral[k]);
                       }
                       spectra.finish();
                   });
    for_each_chunk(
        hessians.weighted.size(), kHessianChunk,
        [&](std::size_t /*chunk*/, std::size_t begin, std::size_t end) {
            for (std::size_t k = begin; k < end; ++k) {
                const Contact<Dim>& contact = contacts.list[pairs + k];
                const DistanceEnergy energy = energy_of<Dim>(scene, contact, stiffness);
                const Block<Dim> block =
                    contact.kind == ContactKind::Surface
                        ? surface_hessian<Dim>(energy, surface_at<Dim>(scene, contact, positions),
                                               filter)
                        : held_hessian<Dim>(energy, contact, filter);
                hessians.weighted[k] = {contact.vertices, contact.count, contact.weights, block};
            }
        });
    return hessians;
}

template <int Dim>
void add_gradient(const Contacts<Dim>& contacts, Positions<Dim>& gradient) {
    const std::size_t count = contacts.list.size();
    const std::size_t size = std::max(kMinPart, (count + kMaxParts - 1) / kMaxParts);
    if (count <= size) {
        add_gradient<Dim>(contacts, 0, count, gradient);
        return;
    }
    std::vector<Positions<Dim>> parts((count + size - 1) / size);
    for_each_chunk(count, size, [&](std::size_t part, std::size_t begin, std::size_t end) {
        parts[part].setZero(Dim, gradient.cols());
        add_gradient<Dim>(contacts, begin, end, parts[part]);
    });
    for_each_chunk(static_cast<std::size_t>(gradient.cols()), kMinPart,
                   [&](std::size_t /*chunk*/, std::size_t begin, std::size_t end) {
                       for (const Positions<Dim>& part : parts) {
                           const auto first = static_cast<Eigen::Index>(begin);
                           const auto columns = static_cast<Eigen::Index>(end - begin);
                           gradient.middleCols(first, columns) += part.middleCols(first, columns);
                       }
                   });
}

#define PENT_INSTANTIATE(Dim)                                                                  \
    template DistanceEnergy energy_of(const ContactScene<Dim>&, const Contact<Dim>&, double);  \
    template Stencil<Dim> corners_of(const Contact<Dim>&, const PositionsView<Dim>&);          \
    template bool evaluate(const DistanceEnergy&, const PositionsView<Dim>&, Contact<Dim>&);   \
    template StencilVector<Dim> mollifier_gradient(const DistanceEnergy&, const Contact<Dim>&, \
                                                   const PositionsView<Dim>&);                 \
    template Block<Dim> held_hessian(const DistanceEnergy&, const Contact<Dim>&, Filter);      \
    template Block<Dim> surface_hessian(const DistanceEnergy&, const SignedDistance<Dim>&,     \
                                        Filter);                                               \
    template Contacts<Dim> evaluate_all(const ContactScene<Dim>&, const PositionsView<Dim>&,   \
                                        double, Contacts<Dim>);                                \
    template StencilHessians<Dim> hessians_of(const ContactScene<Dim>&, const Contacts<Dim>&,  \
                                              const PositionsView<Dim>&, double, Filter,       \
                                              StencilHessians<Dim>);                           \
    template void add_gradient(const Contacts<Dim>&, Positions<Dim>&);
PENT_FOR_EACH_DIMENSION(PENT_INSTANTIATE)
#undef PENT_INSTANTIATE

}  // namespace pent::contact
