#include "step/balance.h"

#include <pent/dimensions.h>

namespace pent::simulator {

namespace {

template <int Dim>
std::vector<double> to_list(const Vector<Dim>& vector) {
    return {vector.begin(), vector.end()};
}

// Components of the bivector a - a^T, one for each plane.
template <int Dim>
std::vector<double> plane_components(const Matrix<Dim>& a) {
    std::vector<double> components;
    for (int i = 0; i < Dim; ++i) {
        for (int j = i + 1; j < Dim; ++j) {
            components.push_back(a(i, j) - a(j, i));
        }
    }
    return components;
}

}  // namespace

template <int Dim>
std::vector<double> momentum(const Eigen::VectorXd& masses, const Positions<Dim>& velocities) {
    return to_list<Dim>(velocities * masses);
}

template <int Dim>
std::vector<double> angular_momentum(const Eigen::VectorXd& masses,
                                     const Positions<Dim>& positions,
                                     const Positions<Dim>& velocities) {
    const Matrix<Dim> sum = positions * masses.asDiagonal() * velocities.transpose();
    return plane_components<Dim>(sum);
}

template <int Dim>
Positions<Dim> reactions(const HeldVertices<Dim>& held, const Positions<Dim>& forces) {
    Positions<Dim> all = Positions<Dim>::Zero(Dim, forces.cols());
    for (Eigen::Index vertex = 0; vertex < forces.cols(); ++vertex) {
        if (held.is_held(static_cast<std::uint32_t>(vertex))) {
            all.col(vertex) = -forces.col(vertex);
        }
    }
    return all;
}

template <int Dim>
std::vector<ConstraintSummary> constraint_summaries(const HeldVertices<Dim>& held,
                                                    const Positions<Dim>& positions,
                                                    const Positions<Dim>& forces) {
    std::vector<ConstraintSummary> all;
    for (const DirichletSet<Dim>& set : held.sets()) {
        ConstraintSummary& summary = all.emplace_back();
        Vector<Dim> center = Vector<Dim>::Zero();
        for (const std::uint32_t vertex : set.vertices) {
            center += positions.col(vertex);
        }
        center /= static_cast<double>(set.vertices.size());
        Vector<Dim> force = Vector<Dim>::Zero();
        Matrix<Dim> moment = Matrix<Dim>::Zero();
        if (held.is_held(set)) {
            summary.held = static_cast<std::int64_t>(set.vertices.size());
            for (const std::uint32_t vertex : set.vertices) {
                force -= forces.col(vertex);
                moment -= (positions.col(vertex) - center) * forces.col(vertex).transpose();
            }
        }
        summary.center = to_list<Dim>(center);
        summary.force = to_list<Dim>(force);
        summary.moment = plane_components<Dim>(moment);
    }
    return all;
}

#define PENT_INSTANTIATE(Dim)                                                                  \
    template std::vector<double> momentum<Dim>(const Eigen::VectorXd&, const Positions<Dim>&); \
    template std::vector<double> angular_momentum<Dim>(                                        \
        const Eigen::VectorXd&, const Positions<Dim>&, const Positions<Dim>&);                 \
    template Positions<Dim> reactions<Dim>(const HeldVertices<Dim>&, const Positions<Dim>&);   \
    template std::vector<ConstraintSummary> constraint_summaries<Dim>(                         \
        const HeldVertices<Dim>&, const Positions<Dim>&, const Positions<Dim>&);
PENT_FOR_EACH_DIMENSION(PENT_INSTANTIATE)
#undef PENT_INSTANTIATE

}  // namespace pent::simulator
