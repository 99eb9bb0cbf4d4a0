#include "valley.h"

#include <pent/dimensions.h>

#include <Eigen/LU>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>

namespace pent::contact {

namespace {

// Shares are exchanged until no exchange would lower d at a rate above this part of it, which is
// above rounding, or so many times.
constexpr double kBalanced = 1e-12;
constexpr int kMaxExchanges = 1000;

// At which distance a contact as strong as the nearest one would have the energy of this one, m:
// its gain is the root of what is left of it.
template <int Dim>
double felt_distance(const Contact<Dim>& contact, double eps) {
    return contact.distance + (1 - contact.gain) * (eps - contact.distance);
}

// The mean distance and direction by the shares, and d from them.
template <int Dim>
struct Mean {
    double distance = 0;                          // m
    Vector<Dim> direction = Vector<Dim>::Zero();  // u
    double kappa = 0;
    double spread = 0;  // 1 - |u|^2
    double growth = 1;  // of d by m
    double eps = 0;

    Mean() = default;
    Mean(std::span<const Contact<Dim>> each, double distance_of_contact)
        : eps(distance_of_contact) {
        for (const Contact<Dim>& contact : each) {
            distance += contact.share * felt_distance(contact, eps);
            direction += contact.share * contact.direction;
        }
        kappa = distance * (1 - distance / eps);
        spread = 1 - direction.squaredNorm();
        growth = 1 - spread * (1 - 2 * distance / eps) / 2;
    }

    // How d changes with the share of a contact.
    [[nodiscard]] double rate(const Contact<Dim>& contact) const {
        return growth * felt_distance(contact, eps) + kappa * direction.dot(contact.direction);
    }
};

// Moves share to the contact with the least rate, from that by which d gains most. Returns whether
// there was something to gain.
template <int Dim>
bool exchange(const Mean<Dim>& mean, std::span<Contact<Dim>> each) {
    const auto to = std::min_element(
        each.begin(), each.end(),
        [&](const Contact<Dim>& a, const Contact<Dim>& b) { return mean.rate(a) < mean.rate(b); });
    Contact<Dim>* from = nullptr;
    double moved = 0;
    double most = 0;
    for (Contact<Dim>& contact : each) {
        const double fall = mean.rate(contact) - mean.rate(*to);
        if (contact.share > 0 && fall > kBalanced * mean.distance) {
            const double bend = mean.kappa * (to->direction - contact.direction).squaredNorm();
            const double part = std::min(contact.share, fall / bend);
            const double gain = part * (fall - part * bend / 2);
            if (gain > most) {
                most = gain;
                moved = part;
                from = &contact;
            }
        }
    }
    if (from == nullptr) {
        return false;
    }
    from->share -= moved;  // exactly 0 where all of it goes
    to->share += moved;
    return true;
}

// Makes a contact give its part of the gradient of d: the directions of distances turn as vertices
// move, which changes d as well. Where the nearest point of the facet is on its border, in the
// interior of a face, the direction turns about that face.
template <int Dim>
void take_part(const Mean<Dim>& mean, const PositionsView<Dim>& positions, Contact<Dim>& contact) {
    const Vector<Dim> alpha = -contact.weights.template tail<Dim>();
    Eigen::Index base = 0;
    alpha.maxCoeff(&base);
    Block<Dim> edges = Block<Dim>::Zero();  // of the face
    Vector<Dim> missing = Vector<Dim>::Ones();
    for (Eigen::Index i = 0; i < Dim; ++i) {
        if (alpha[i] > 0 && i != base) {
            edges.col(i) =
                positions.col(contact.vertices[1 + i]) - positions.col(contact.vertices[1 + base]);
            missing[i] = 0;
        }
    }
    Block<Dim> gram = edges.transpose() * edges;
    gram.diagonal() += missing;
    const Vector<Dim> along = gram.inverse() * (edges.transpose() * mean.direction);
    const Vector<Dim>& own = contact.direction;
    const Vector<Dim> across = mean.direction - mean.direction.dot(own) * own - edges * along;
    const Vector<Dim> change =
        mean.growth * contact.gain * own + mean.kappa / contact.distance * across;
    if (!along.allFinite()) {
        return;  // it has collapsed
    }
    contact.gain = change.norm();
    contact.direction = change / contact.gain;
    const Vector<Dim> shift = mean.kappa / contact.gain * along;
    contact.weights.template tail<Dim>() -= shift;
    contact.weights[1 + base] += shift.sum();
}

}  // namespace

template <int Dim>
void share_contacts(std::vector<Contact<Dim>>& contacts,
                    std::size_t first,
                    double eps,
                    const PositionsView<Dim>& positions) {
    const std::span<Contact<Dim>> each(contacts.data() + first, contacts.size() - first);
    const double strength = each[0].share;
    for (Contact<Dim>& contact : each) {
        contact.gain = std::min(1.0, std::sqrt(contact.share / strength));
        contact.share = 0;
    }
    each[0].share = 1;
    Mean<Dim> mean;
    int exchanges = -1;
    do {
        mean = Mean<Dim>(each, eps);
        ++exchanges;
    } while (exchanges < kMaxExchanges && exchange<Dim>(mean, each));
    std::size_t kept = first;
    for (Contact<Dim>& contact : each) {
        if (contact.share > 0) {
            if (exchanges > 0) {
                take_part<Dim>(mean, positions, contact);
                contact.distance = mean.distance - mean.kappa * mean.spread / 2;
            }
            contact.share *= strength;
            contacts[kept++] = contact;
        }
    }
    while (contacts.size() > kept) {
        contacts.pop_back();
    }
}

#define PENT_INSTANTIATE(Dim)                                                     \
    template void share_contacts(std::vector<Contact<Dim>>&, std::size_t, double, \
                                 const PositionsView<Dim>&);
PENT_FOR_EACH_DIMENSION(PENT_INSTANTIATE)
#undef PENT_INSTANTIATE

}  // namespace pent::contact
