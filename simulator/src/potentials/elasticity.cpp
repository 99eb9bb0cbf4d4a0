#include "potentials/elasticity.h"

#include "model/body_dofs.h"

#include <pent/dimensions.h>

#include <algorithm>
#include <limits>
#include <span>
#include <utility>
#include <variant>

namespace pent::simulator {

namespace {

constexpr Eigen::Index kChunkCells = 1024;

bool may_turn(const Motion& motion) {
    return !motion.rotate.empty()
           || std::any_of(motion.keyframes.begin(), motion.keyframes.end(),
                          [](const MotionKeyframe& keyframe) {
                              return !keyframe.rotate.empty() || !keyframe.spin.empty();
                          });
}

}  // namespace

template <int Dim>
Elasticity<Dim>::Elasticity(const Workers& workers,
                            const Kernels<Dim>& kernels,
                            const Bodies<Dim>& bodies,
                            const HeldVertices<Dim>& held,
                            const Scene& scene)
    : workers_(&workers),
      kernels_(&kernels),
      bodies_(&bodies),
      kind_(scene.solver.elements),
      strain_(workers, scene, bodies) {
    take(lay_out(number_dofs(bodies, held, std::vector<bool>(bodies.count(), true))));
    lay_out_held(held);
}

template <int Dim>
void Elasticity<Dim>::take(ElementLayout<Dim> layout) {
    pattern_ = std::make_shared<const BlockPattern>(std::move(layout.pattern));
    elements_ = std::move(layout.elements);
    const Sharing& sharing = bodies_->sharing;
    size_ = {.elements = sharing.sum(elements_->count()),
             .blocks = sharing.sum(pattern_->blocks()),
             .bytes = sharing.sum(elements_->bytes())};
    ghost_count_ = static_cast<std::int64_t>(ghost_columns(*pattern_).size());
}

template <int Dim>
ElementLayout<Dim> Elasticity<Dim>::lay_out(const DofMap& dofs, const Grips* grips) const {
    const ActiveStrain<Dim>* strain = strain_.is_empty() ? nullptr : &strain_;
    ElementLayout<Dim> layout =
        kind_ == ElementKind::Quadratic
            ? lay_out_elements<Dim>(bodies_->rest(), bodies_->quadratic, dofs, strain, grips)
            : lay_out_elements<Dim>(bodies_->rest(), bodies_->cells(), bodies_->ranges, dofs, kind_,
                                    strain, grips);
    layout.elements.activate(*workers_, strain_);
    return layout;
}

// A constraint that moves its vertices as one rigid body strains nothing between them, with two
// exceptions: activations do, and so do turns in linear elasticity, whose energy is not invariant
// under rotations.
template <int Dim>
void Elasticity<Dim>::lay_out_held(const HeldVertices<Dim>& held) {
    std::vector<bool> strains;
    for (const DirichletSet<Dim>& set : held.sets()) {
        const bool is_linear = std::any_of(
            bodies_->ranges.begin(), bodies_->ranges.end(), [&](const CellRange& range) {
                return range.body == set.body && range.material.model == Model::Linear;
            });
        const bool turns = std::any_of(set.path.begin(), set.path.end(), may_turn);
        strains.push_back(!strain_.is_empty() || (is_linear && turns));
    }
    Grips grips = held.grips();
    std::replace_if(
        grips.begin(), grips.end(),
        [&](std::int32_t grip) { return grip >= 0 && strains[static_cast<std::size_t>(grip)]; },
        kOtherGrip);
    if (grips == held_.grips) {
        return;
    }
    held_ = {};
    held_.grips = std::move(grips);
    bool is_here = false;  // a cell of such elements
    for (const auto cell : bodies_->cells().colwise()) {
        is_here = is_here || is_held_and_strained(std::span(cell.data(), Dim + 1), held_.grips);
    }
    if (bodies_->sharing.any(is_here)) {
        const std::vector<bool> none(bodies_->count(), false);
        held_.elements = lay_out(number_dofs(*bodies_, held, none), &held_.grips).elements;
        held_.bytes = bodies_->sharing.sum(held_.elements->bytes());
    }
}

template <int Dim>
void Elasticity<Dim>::set_dofs(const DofMap& dofs,
                               const HeldVertices<Dim>& held,
                               const std::vector<bool>& asleep,
                               const Positions<Dim>& positions) {
    frozen_gradient_.resize(Dim, 0);
    frozen_ = {};
    if (std::find(asleep.begin(), asleep.end(), true) != asleep.end()) {
        elements_ = lay_out(number_dofs(*bodies_, held, asleep)).elements;
        frozen_gradient_.setZero(Dim, positions.cols());
        frozen_ = elements_->add_gradient(*workers_, *kernels_, positions, frozen_gradient_);
    }
    take(lay_out(dofs));
    lay_out_held(held);
}

// Elements that other ranks have as well count once; gradients are those of the ranks that own the
// vertices.
template <int Dim>
ElasticEnergy Elasticity<Dim>::add_shared(ElasticEnergy energy,
                                          Positions<Dim>& own,
                                          Positions<Dim>& gradient) const {
    bodies_->sharing.gather(own);
    gradient += own;
    std::vector<double> sums = energy.of_ranges;
    sums.push_back(energy.energy);
    sums.push_back(static_cast<double>(energy.inverted));
    sums.push_back(static_cast<double>(energy.collapsed));
    bodies_->sharing.sum(sums);
    const std::size_t ranges = energy.of_ranges.size();
    energy.energy = sums[ranges];
    energy.inverted = static_cast<std::int64_t>(sums[ranges + 1]);
    energy.collapsed = static_cast<std::int64_t>(sums[ranges + 2]);
    sums.resize(ranges);
    energy.of_ranges = std::move(sums);
    return energy;
}

template <int Dim>
double Elasticity<Dim>::evaluate(const Positions<Dim>& x, Positions<Dim>& gradient) {
    if (bodies_->sharing.is_shared()) {
        Positions<Dim> own = Positions<Dim>::Zero(Dim, x.cols());
        ElasticEnergy energy = elements_->add_gradient(*workers_, *kernels_, x, own);
        energy.add(frozen_);
        if (frozen_gradient_.cols() > 0) {
            own += frozen_gradient_;
        }
        energy_ = add_shared(std::move(energy), own, gradient);
        return energy_.energy;
    }
    energy_ = elements_->add_gradient(*workers_, *kernels_, x, gradient);
    energy_.add(frozen_);
    if (frozen_gradient_.cols() > 0) {
        gradient += frozen_gradient_;
    }
    return energy_.energy;
}

template <int Dim>
void Elasticity<Dim>::evaluate_held(const Positions<Dim>& x) {
    if (!held_.elements) {
        return;
    }
    held_.gradient.setZero(Dim, x.cols());
    held_.energy = held_.elements->add_gradient(*workers_, *kernels_, x, held_.gradient);
    if (bodies_->sharing.is_shared()) {
        Positions<Dim> own = std::move(held_.gradient);
        held_.gradient.setZero(Dim, x.cols());
        held_.energy = add_shared(std::move(held_.energy), own, held_.gradient);
    }
}

template <int Dim>
std::vector<double> Elasticity<Dim>::energy_of_ranges() const {
    std::vector<double> all = energy_.of_ranges;
    for (std::size_t range = 0; range < held_.energy.of_ranges.size(); ++range) {
        all[range] += held_.energy.of_ranges[range];
    }
    return all;
}

template <int Dim>
void Elasticity<Dim>::add_hessian(const Positions<Dim>& x,
                                  double weight,
                                  Filter filter,
                                  NewtonSystem<Dim>& system) {
    std::visit(
        [&](auto& matrix) {
            auto target = target_in(matrix, weight * hessian_factor_, filter);
            target.prescribed_displacement = system.prescribed_displacement().data();
            target.right = system.right().data();
            filtered_ = elements_->add_hessian(*workers_, *kernels_, x, target);
        },
        system.matrix());
}

template <int Dim>
void Elasticity<Dim>::add_tangent(const Positions<Dim>& x,
                                  Filter filter,
                                  const Positions<Dim>& displacement,
                                  BlockMatrix<Dim, double>& matrix,
                                  BlockVector<Dim>& right) const {
    auto target = target_in(matrix, 1, filter);
    target.prescribed_displacement = displacement.data();
    target.right = right.data();
    elements_->add_hessian(*workers_, *kernels_, x, target);
}

template <int Dim>
void Elasticity<Dim>::activate() {
    elements_->activate(*workers_, strain_);
    if (held_.elements) {
        held_.elements->activate(*workers_, strain_);
    }
}

template <int Dim>
bool Elasticity<Dim>::set_time(const TimeSpan& step) {
    step_ = step;
    if (strain_.is_empty() || !strain_.set_time(*workers_, step.end)) {
        return false;
    }
    activate();
    return true;
}

template <int Dim>
void Elasticity<Dim>::add_couplings(Couplings& couplings) const {
    const std::vector<std::size_t> bodies = strain_.changing_bodies(step_.begin, step_.end);
    couplings.driven.insert(couplings.driven.end(), bodies.begin(), bodies.end());
}

template <int Dim>
double Elasticity<Dim>::energy_at(const Positions<Dim>& x, double time) {
    if (strain_.set_time(*workers_, time)) {
        activate();
    }
    Positions<Dim> gradient = Positions<Dim>::Zero(Dim, x.cols());
    double energy = elements_->add_gradient(*workers_, *kernels_, x, gradient).energy;
    if (held_.elements) {
        energy += held_.elements->add_gradient(*workers_, *kernels_, x, gradient).energy;
    }
    return bodies_->sharing.sum(energy);
}

template <int Dim>
double Elasticity<Dim>::activation_work(const Positions<Dim>& from,
                                        const Positions<Dim>& to,
                                        const TimeSpan& step) {
    if (strain_.changing_bodies(step.begin, step.end).empty()) {
        return 0;
    }
    const double before = energy_at(from, step.begin) + energy_at(to, step.begin);
    const double after = energy_at(from, step.end) + energy_at(to, step.end);
    return 0.5 * (after - before);
}

template <int Dim>
double Elasticity<Dim>::rounding() const {
    return bodies_->large_energy * std::numeric_limits<double>::epsilon();
}

// Counts cells: smoothed and quadratic elements need not be inverted where one of their cells is.
template <int Dim>
std::int64_t Elasticity<Dim>::inverted_cells(const Positions<Dim>& x) const {
    if (kind_ == ElementKind::Linear) {
        return energy_.inverted + held_.energy.inverted;
    }
    const Simplices<Dim + 1>& cells = bodies_->cells();
    const Sharing& sharing = bodies_->sharing;
    const auto chunks = static_cast<int>((cells.cols() + kChunkCells - 1) / kChunkCells);
    return sharing.sum(workers_->sum(chunks, [&](int chunk) {
        const Eigen::Index begin = chunk * kChunkCells;
        const Eigen::Index end = std::min(begin + kChunkCells, cells.cols());
        std::int64_t inverted = 0;
        for (Eigen::Index cell = begin; cell < end; ++cell) {
            const bool counts = sharing.owns(cells(0, cell));
            inverted += !counts || cell_volume<Dim>(x, cells, cell) > 0 ? 0 : 1;
        }
        return inverted;
    }));
}

#define PENT_INSTANTIATE(Dim) template class Elasticity<Dim>;
PENT_FOR_EACH_DIMENSION(PENT_INSTANTIATE)
#undef PENT_INSTANTIATE

}  // namespace pent::simulator
