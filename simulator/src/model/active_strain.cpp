#include "model/active_strain.h"

#include "model/distance_field.h"
#include "model/keyframes.h"
#include "model/part_bodies.h"
#include "model/part_selection.h"

#include <pent/dimensions.h>
#include <pent/error.h>
#include <pent/simulator/placed_mesh.h>

#include <Eigen/LU>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace pent::simulator {

namespace {

constexpr std::int32_t kNoShape = -1;

// The part of a pulse in which it rises, and the same in which it falls.
constexpr double kFlank = 0.2;

// The gradient of a distance has length 1, but at its sources, where it has no direction: shorter
// ones count as zero.
constexpr double kNoDirection = 1e-6;

double smooth(double s) {
    const double t = std::clamp(s, 0.0, 1.0);
    return t * t * (3 - 2 * t);
}

// The elements of a body that this rank has, as a mesh: its cells in the order of Bodies, or its
// quadratic cells as if their edges were straight.
template <int Dim>
struct BodyElements {
    SimplexMesh<Dim> mesh;
    std::vector<std::uint32_t> numbers;  // the cell of the body's mesh that stands for each
};

template <int Dim>
BodyElements<Dim> elements_of(const Bodies<Dim>& bodies, std::size_t body) {
    const SimplexMesh<Dim>& mesh = bodies.meshes[body];
    const auto range = bodies.elements_of(body);
    const auto cells = bodies.cells_of(body);
    const bool is_quadratic = bodies.quadratic.nodes.cols() > 0;
    BodyElements<Dim> elements;
    elements.mesh.positions = mesh.positions;
    elements.mesh.layers = mesh.layers;
    elements.mesh.cells =
        is_quadratic ? Simplices<Dim + 1>(
            bodies.quadratic.nodes.template topRows<Dim + 1>().middleCols(range.begin, range.size))
                     : Simplices<Dim + 1>(bodies.cells().middleCols(range.begin, range.size));
    elements.mesh.cells.array() -= static_cast<std::uint32_t>(bodies.first_vertex[body]);
    // A cell stands for itself, for a quadratic one its first child. Parts of meshes have labels in
    // the order of Bodies, whole meshes in their own.
    elements.numbers.resize(static_cast<std::size_t>(range.size));
    std::vector<std::uint32_t> labeled(elements.numbers.size());
    for (Eigen::Index i = cells.begin + cells.size; i-- > cells.begin;) {
        const Eigen::Index element =
            is_quadratic ? bodies.quadratic.parents[static_cast<std::size_t>(i)] : i;
        const auto place = static_cast<std::size_t>(element - range.begin);
        elements.numbers[place] = bodies.mesh_cell(body, i);
        labeled[place] = is_of_parts(bodies) ? static_cast<std::uint32_t>(i - cells.begin)
                                             : elements.numbers[place];
    }
    for (const std::uint32_t cell : labeled) {
        if (!mesh.regions.empty()) {
            elements.mesh.regions.push_back(mesh.regions[cell]);
        }
    }
    if (mesh.fibers.cols() > 0) {
        elements.mesh.fibers = mesh.fibers(Eigen::all, labeled);
    }
    return elements;
}

// The distance of every vertex of elements from what away_from selects.
template <int Dim>
Eigen::VectorXd distances(const Activation& activation,
                          const Bodies<Dim>& bodies,
                          std::size_t body,
                          const SimplexMesh<Dim>& elements) {
    const std::string where = place_and_name(activation);
    const Sharing& sharing = bodies.sharing;
    const auto vertices = bodies.vertices(body);
    std::vector<std::uint32_t> owners;
    for (Eigen::Index i = 0; sharing.is_shared() && i < vertices.size; ++i) {
        owners.push_back(sharing.owner(static_cast<std::uint32_t>(vertices.begin + i)));
    }
    const Eigen::VectorXd all = distance_within<Dim>(
        {elements, owners, sharing.is_shared() ? &sharing.ranks() : nullptr},
        select_vertices(bodies, body, activation.away_from, where + " (away_from)"));
    double first_without = std::numeric_limits<double>::infinity();
    for (const std::uint32_t vertex : elements.cells.reshaped()) {
        if (!std::isfinite(all[vertex])) {
            first_without = std::min<double>(first_without, vertex);
        }
    }
    const std::vector<double> of_ranks = sharing.list(first_without);
    first_without = *std::min_element(of_ranks.begin(), of_ranks.end());
    if (std::isfinite(first_without)) {
        throw Error(where + ": no way within the body leads from \"away_from\" to vertex "
                    + std::to_string(static_cast<std::uint32_t>(first_without))
                    + "; select a vertex of each of its parts");
    }
    return all;
}

template <int Dim>
Vector<Dim> unit(const Vector<Dim>& vector) {
    const double length = vector.norm();
    return length > kNoDirection ? Vector<Dim>(vector / length) : Vector<Dim>::Zero();
}

// Between 0 and 1.
double periodic_signal(const Activation& activation, double time, double delay) {
    if (activation.signal == Signal::Constant) {
        return 1;
    }
    const double periods = activation.frequency * time + activation.phase - delay;
    const double phase = periods - std::floor(periods);
    if (activation.signal == Signal::Sine) {
        return 0.5 * (1 + std::sin(2 * std::numbers::pi * phase));
    }
    const double part = phase / activation.duty;
    return smooth(part / kFlank) * smooth((1 - part) / kFlank);
}

}  // namespace

double signal_at(const Activation& activation, double time, double delay) {
    return factor_at(activation.keyframes, time) * periodic_signal(activation, time, delay);
}

template <int Dim>
Matrix<Dim> active_deformation(const Activation& activation,
                               double signal,
                               const Vector<Dim>& direction) {
    const double stretch = 1 + signal * (activation.stretch - 1);
    if (activation.fibers == Fibers::None) {
        return stretch * Matrix<Dim>::Identity();
    }
    if (direction.isZero(0)) {
        return Matrix<Dim>::Identity();
    }
    const double across = activation.preserves_volume ? std::pow(stretch, -1.0 / (Dim - 1)) : 1.0;
    return across * Matrix<Dim>::Identity()
           + (stretch - across) * direction * direction.transpose();
}

template <int Dim>
ActiveStrain<Dim>::ActiveStrain(const Workers& workers,
                                const Scene& scene,
                                const Bodies<Dim>& bodies)
    : sharing_(&bodies.sharing) {
    for (const Activation& activation : scene.activations) {
        muscles_.push_back({activation, index_of(scene, activation.body)});
        append_fibers(muscles_.size() - 1, bodies);
    }
    if (muscles_.empty()) {
        return;
    }
    std::stable_sort(fibers_.begin(), fibers_.end(),
                     [](const Fiber& a, const Fiber& b) { return a.element < b.element; });
    shape_of_.assign(static_cast<std::size_t>(bodies.element_count()), kNoShape);
    for (std::size_t i = 0; i < fibers_.size(); ++i) {
        if (i == 0 || fibers_[i].element != fibers_[i - 1].element) {
            shape_of_[fibers_[i].element] = static_cast<std::int32_t>(first_fiber_.size());
            first_fiber_.push_back(i);
        }
    }
    shapes_.resize(first_fiber_.size());
    first_fiber_.push_back(fibers_.size());
    parent_of_ = bodies.quadratic.parents;
    static_cast<void>(set_time(workers, 0));
}

template <int Dim>
void ActiveStrain<Dim>::append_fibers(std::size_t muscle, const Bodies<Dim>& bodies) {
    const Activation& activation = muscles_[muscle].activation;
    const std::size_t body = muscles_[muscle].body;
    const auto first = bodies.elements_of(body).begin;
    const BodyElements<Dim> here = elements_of(bodies, body);
    const SimplexMesh<Dim>& elements = here.mesh;
    const std::string where = place_and_name(activation);
    const std::vector<bool> is_in =
        select_cells(elements, here.numbers, activation.select, where,
                     sharing_->is_shared() ? &sharing_->ranks() : nullptr);
    if (activation.fibers == Fibers::Mesh && !sharing_->any(elements.fibers.cols() > 0)) {
        throw Error(where + ": fibers = \"mesh\", but the mesh has none; expected the properties"
                            " fiber_x, fiber_y .. of its cells (docs/pent-format.md)");
    }
    const bool has_distance = activation.fibers == Fibers::Distance;
    const Eigen::VectorXd distance =
        has_distance ? distances(activation, bodies, body, elements) : Eigen::VectorXd();
    for (Eigen::Index i = 0; i < elements.cell_count(); ++i) {
        if (!is_in[static_cast<std::size_t>(i)]) {
            continue;
        }
        Fiber fiber{.element = static_cast<std::uint32_t>(first + i),
                    .muscle = static_cast<std::uint32_t>(muscle)};
        if (activation.fibers == Fibers::Constant) {
            fiber.direction = activation.direction;
        } else if (activation.fibers == Fibers::Mesh) {
            fiber.direction = unit<Dim>(elements.fibers.col(i));
        } else if (has_distance) {
            fiber.direction = unit<Dim>(gradient_in_cell(elements, i, distance));
        }
        for (const std::uint32_t corner : elements.cells.col(i)) {
            if (activation.wave.size() > 0) {
                fiber.delay += activation.wave.dot(elements.positions.col(corner)) / (Dim + 1);
            }
            if (has_distance) {
                fiber.delay += activation.distance_wave * distance[corner] / (Dim + 1);
            }
        }
        fibers_.push_back(fiber);
    }
}

template <int Dim>
double ActiveStrain<Dim>::signal(const Fiber& fiber, double time) const {
    return signal_at(muscles_[fiber.muscle].activation, time, fiber.delay);
}

template <int Dim>
typename ActiveStrain<Dim>::Shape ActiveStrain<Dim>::shape_at(std::size_t shape,
                                                              double time) const {
    Matrix<Dim> all = Matrix<Dim>::Identity();
    for (std::size_t i = first_fiber_[shape]; i < first_fiber_[shape + 1]; ++i) {
        const Fiber& fiber = fibers_[i];
        all = (active_deformation<Dim>(muscles_[fiber.muscle].activation, signal(fiber, time),
                                       fiber.direction)
               * all)
                  .eval();
    }
    return {all.inverse(), all.determinant()};
}

template <int Dim>
bool ActiveStrain<Dim>::set_time(const Workers& workers, double time) {
    if (time == time_) {
        return false;
    }
    time_ = time;
    constexpr std::size_t kChunk = 1024;
    const std::int64_t changed =
        workers.sum(static_cast<int>((shapes_.size() + kChunk - 1) / kChunk), [&](int chunk) {
            const std::size_t begin = static_cast<std::size_t>(chunk) * kChunk;
            std::int64_t others = 0;
            for (std::size_t i = begin; i < std::min(begin + kChunk, shapes_.size()); ++i) {
                const Shape shape = shape_at(i, time);
                others += shape == shapes_[i] ? 0 : 1;
                shapes_[i] = shape;
            }
            return others;
        });
    return sharing_->any(changed > 0);
}

template <int Dim>
const typename ActiveStrain<Dim>::Shape* ActiveStrain<Dim>::of_element(Eigen::Index element) const {
    if (shape_of_.empty()) {
        return nullptr;
    }
    const std::int32_t shape = shape_of_[static_cast<std::size_t>(element)];
    return shape == kNoShape ? nullptr : &shapes_[static_cast<std::size_t>(shape)];
}

template <int Dim>
const typename ActiveStrain<Dim>::Shape* ActiveStrain<Dim>::of_cell(Eigen::Index cell) const {
    return of_element(parent_of_.empty() ? cell : parent_of_[static_cast<std::size_t>(cell)]);
}

template <int Dim>
std::vector<std::size_t> ActiveStrain<Dim>::changing_bodies(double from, double to) const {
    if (muscles_.empty()) {
        return {};
    }
    std::vector<double> changing(muscles_.size(), 0);
    for (const Fiber& fiber : fibers_) {
        double& is_changing = changing[fiber.muscle];
        is_changing = is_changing > 0 || signal(fiber, from) != signal(fiber, to) ? 1 : 0;
    }
    sharing_->sum(changing);
    std::vector<std::size_t> bodies;
    for (std::size_t muscle = 0; muscle < muscles_.size(); ++muscle) {
        if (changing[muscle] > 0) {
            bodies.push_back(muscles_[muscle].body);
        }
    }
    return bodies;
}

#define PENT_INSTANTIATE(Dim)         \
    template class ActiveStrain<Dim>; \
    template Matrix<Dim> active_deformation<Dim>(const Activation&, double, const Vector<Dim>&);
PENT_FOR_EACH_DIMENSION(PENT_INSTANTIATE)
#undef PENT_INSTANTIATE

}  // namespace pent::simulator
