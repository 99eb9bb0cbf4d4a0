#include "potentials/pressure_loads.h"

#include "model/keyframes.h"
#include "model/part_bodies.h"
#include "model/part_selection.h"

#include <pent/dimensions.h>
#include <pent/error.h>
#include <pent/simulator/placed_mesh.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <utility>

namespace pent::simulator {

namespace {

template <int Dim>
using Vector = Eigen::Matrix<double, Dim, 1>;
template <int Dim>
using Square = Eigen::Matrix<double, Dim, Dim>;
template <int Dim>
using Corners = Eigen::Matrix<double, Dim, Dim>;  // a column each

// The matrix G with u . G v = det[u, v, others]: antisymmetric.
Square<3> dual(const Eigen::Matrix<double, 3, 1>& others) {
    Square<3> G;
    G << 0, others[2], -others[1], -others[2], 0, others[0], others[1], -others[0], 0;
    return G;
}
Square<4> dual(const Eigen::Matrix<double, 4, 2>& others) {
    const auto minor = [&](int i, int j) {
        return others(i, 0) * others(j, 1) - others(j, 0) * others(i, 1);
    };
    Square<4> G = Square<4>::Zero();
    G(0, 1) = minor(2, 3);
    G(0, 2) = minor(3, 1);
    G(0, 3) = minor(1, 2);
    G(1, 2) = minor(0, 3);
    G(1, 3) = minor(2, 0);
    G(2, 3) = minor(0, 1);
    return G - G.transpose().eval();
}

// The outward normal of a facet, as long as its area, and its derivative by each corner.
template <int Dim>
struct Normal {
    Vector<Dim> value;
    std::array<Square<Dim>, Dim> slopes;

    explicit Normal(const Corners<Dim>& corners) {
        constexpr double kSimplices = Dim == 3 ? 2 : 6;  // of the facet in its parallelepiped
        slopes[0].setZero();
        for (int b = 1; b < Dim; ++b) {
            Eigen::Matrix<double, Dim, Dim - 2> others;
            for (int c = 1, column = 0; c < Dim; ++c) {
                if (c != b) {
                    others.col(column++) = corners.col(c) - corners.col(0);
                }
            }
            slopes[b] = (b % 2 == 1 ? 1 : -1) / kSimplices * dual(others);
            slopes[0] -= slopes[b];
        }
        value = slopes[1] * (corners.col(1) - corners.col(0));
    }
};

template <int Dim>
Corners<Dim> corners_of(const Eigen::Matrix<std::uint32_t, Dim, 1>& facet,
                        const Positions<Dim>& x,
                        const Vector<Dim>& apex) {
    Corners<Dim> corners;
    for (int a = 0; a < Dim; ++a) {
        corners.col(a) = facet[a] == kNoVertex ? apex : Vector<Dim>(x.col(facet[a]));
    }
    return corners;
}

// Walls that close a surface: one for each ridge of its rim, with the apex first. The rim is the
// boundary of the surface as a chain: each ridge as often as facets have it in one orientation more
// often than in the other.
template <int Dim>
std::vector<Eigen::Matrix<std::uint32_t, Dim, 1>> walls_of(const Simplices<Dim>& facets) {
    using Ridge = std::array<std::uint32_t, Dim - 1>;
    std::map<Ridge, int> turns;
    for (const auto& facet : facets.colwise()) {
        for (int without = 0; without < Dim; ++without) {
            Ridge ridge;
            for (int a = 0, k = 0; a < Dim; ++a) {
                if (a != without) {
                    ridge[static_cast<std::size_t>(k++)] = facet[a];
                }
            }
            int sign = without % 2 == 0 ? 1 : -1;
            for (std::size_t i = 0; i < ridge.size(); ++i) {  // sorting a few: count exchanges
                for (std::size_t j = i + 1; j < ridge.size(); ++j) {
                    if (ridge[j] < ridge[i]) {
                        std::swap(ridge[i], ridge[j]);
                        sign = -sign;
                    }
                }
            }
            turns[ridge] += sign;
        }
    }
    std::vector<Eigen::Matrix<std::uint32_t, Dim, 1>> walls;
    for (const auto& [ridge, count] : turns) {
        Eigen::Matrix<std::uint32_t, Dim, 1> wall;
        wall[0] = kNoVertex;
        std::copy(ridge.begin(), ridge.end(), wall.data() + 1);
        if (count > 0) {  // a wall goes against its ridge
            std::swap(wall[1], wall[2]);
        }
        walls.insert(walls.end(), static_cast<std::size_t>(std::abs(count)), wall);
    }
    return walls;
}

// The facets of a body's boundary that have every corner selected, by vertices of all bodies
// counted through.
template <int Dim>
Simplices<Dim> select_facets(const Load& load, const Bodies<Dim>& bodies, std::size_t body) {
    const SimplexMesh<Dim>& mesh = bodies.meshes[body];
    std::vector<bool> is_selected(static_cast<std::size_t>(mesh.vertex_count()), false);
    for (const std::uint32_t vertex :
         select_vertices(bodies, body, load.select, place_and_name(load))) {
        is_selected[vertex] = true;
    }
    const Simplices<Dim> boundary = boundary_of(bodies, body);
    std::vector<Eigen::Index> chosen;
    for (Eigen::Index i = 0; i < boundary.cols(); ++i) {
        const auto facet = boundary.col(i);
        if (std::all_of(facet.begin(), facet.end(),
                        [&](std::uint32_t vertex) { return is_selected[vertex]; })) {
            chosen.push_back(i);
        }
    }
    if (chosen.empty()) {
        throw Error(place_and_name(load)
                    + " has a pressure, but no facet of the boundary with all of its "
                    + std::to_string(Dim) + " vertices selected; select more of the boundary");
    }
    Simplices<Dim> facets = boundary(Eigen::all, chosen);
    facets.array() += static_cast<std::uint32_t>(bodies.first_vertex[body]);
    return facets;
}

// Whether vertices are held where they are for good.
template <int Dim>
bool is_still(const std::vector<std::uint32_t>& vertices, const HeldVertices<Dim>& held) {
    std::vector<bool> is_fixed = held.always();
    for (const DirichletSet<Dim>& set : held.sets()) {
        for (const std::uint32_t vertex : set.vertices) {
            is_fixed[vertex] = is_fixed[vertex] && set.motions.empty();
        }
    }
    return std::all_of(vertices.begin(), vertices.end(),
                       [&](std::uint32_t vertex) { return is_fixed[vertex]; });
}

}  // namespace

template <int Dim>
PressureLoads<Dim>::PressureLoads(const Workers& workers,
                                  const Scene& scene,
                                  const Bodies<Dim>& bodies,
                                  const HeldVertices<Dim>& held)
    : workers_(&workers) {
    for (const Load& load : scene.loads) {
        if (load.pressure != 0) {
            pressed_.push_back(make_pressed(load, scene, bodies, held));
            hold_walls(pressed_.back(), bodies.rest());
        }
    }
}

template <int Dim>
typename PressureLoads<Dim>::PressedSurface PressureLoads<Dim>::make_pressed(
    const Load& load,
    const Scene& scene,
    const Bodies<Dim>& bodies,
    const HeldVertices<Dim>& held) {
    PressedSurface pressed;
    pressed.body = index_of(scene, load.body);
    pressed.pressure = load.pressure;
    pressed.keyframes = load.keyframes;
    pressed.facets = select_facets<Dim>(load, bodies, pressed.body);
    const Eigen::Index surface = pressed.facets.cols();
    const auto walls = walls_of<Dim>(pressed.facets);
    pressed.walls = static_cast<Eigen::Index>(walls.size());
    pressed.facets.conservativeResize(Dim, surface + pressed.walls);
    for (std::size_t i = 0; i < walls.size(); ++i) {
        pressed.facets.col(surface + static_cast<Eigen::Index>(i)) = walls[i];
        pressed.rim.insert(pressed.rim.end(), walls[i].begin() + 1, walls[i].end());
    }
    std::sort(pressed.rim.begin(), pressed.rim.end());
    pressed.rim.erase(std::unique(pressed.rim.begin(), pressed.rim.end()), pressed.rim.end());
    pressed.is_stored = is_still<Dim>(pressed.rim, held);
    return pressed;
}

// Takes the apex, and the walls' part of the gradient that is taken off, from positions x.
template <int Dim>
void PressureLoads<Dim>::hold_walls(PressedSurface& pressed, const Positions<Dim>& x) {
    if (pressed.rim.empty()) {
        pressed.apex = x.col(pressed.facets(0, 0));  // any point will do: a near one rounds least
        return;
    }
    pressed.start = x(Eigen::all, pressed.rim);
    pressed.apex = pressed.start.rowwise().mean();
    pressed.taken.setZero(Dim, pressed.start.cols());
    for (const auto& wall : pressed.facets.rightCols(pressed.walls).colwise()) {
        const Normal<Dim> normal(corners_of<Dim>(wall, x, pressed.apex));
        for (int a = 1; a < Dim; ++a) {
            const auto place = std::lower_bound(pressed.rim.begin(), pressed.rim.end(), wall[a]);
            pressed.taken.col(place - pressed.rim.begin()) += normal.value / Dim;
        }
    }
}

template <int Dim>
bool PressureLoads<Dim>::set_time(const TimeSpan& step) {
    bool has_changed = false;
    for (PressedSurface& pressed : pressed_) {
        const double factor = factor_at(pressed.keyframes, step.end);
        pressed.is_changing = factor != factor_at(pressed.keyframes, step.begin);
        has_changed = has_changed || factor != pressed.factor;
        pressed.factor = factor;
    }
    return has_changed;
}

template <int Dim>
void PressureLoads<Dim>::add_couplings(Couplings& couplings) const {
    for (const PressedSurface& pressed : pressed_) {
        if (pressed.is_changing) {
            couplings.driven.push_back(pressed.body);
        }
    }
}

template <int Dim>
bool PressureLoads<Dim>::begin_step(const StepStart<Dim>& start) {
    for (PressedSurface& pressed : pressed_) {
        hold_walls(pressed, start.positions);
    }
    return true;
}

template <int Dim>
double PressureLoads<Dim>::evaluate(const Positions<Dim>& x, Positions<Dim>& gradient) {
    stored_ = 0;
    lagged_ = 0;
    rounding_ = 0;
    std::vector<Point> normals;
    for (const PressedSurface& pressed : pressed_) {
        const double pressure = pressed.factor * pressed.pressure;
        normals.resize(static_cast<std::size_t>(pressed.facets.cols()));
        constexpr Eigen::Index kChunk = 256;
        const Eigen::Index count = pressed.facets.cols();
        workers_->for_each((count + kChunk - 1) / kChunk, [&](Eigen::Index chunk) {
            for (Eigen::Index i = chunk * kChunk; i < std::min((chunk + 1) * kChunk, count); ++i) {
                normals[static_cast<std::size_t>(i)] =
                    Normal<Dim>(corners_of<Dim>(pressed.facets.col(i), x, pressed.apex)).value;
            }
        });
        double energy = 0;
        double size = 0;
        for (Eigen::Index i = 0; i < count; ++i) {
            const auto facet = pressed.facets.col(i);
            const Point& normal = normals[static_cast<std::size_t>(i)];
            for (int a = 0; a < Dim; ++a) {
                if (facet[a] != kNoVertex) {
                    gradient.col(facet[a]) += pressure / Dim * normal;
                }
            }
            if (facet[0] != kNoVertex) {  // walls span no volume with the apex, which is theirs
                const double cone = pressure / Dim * normal.dot(x.col(facet[0]) - pressed.apex);
                energy += cone;
                size += std::abs(cone);
            }
        }
        for (std::size_t i = 0; i < pressed.rim.size(); ++i) {
            const auto column = static_cast<Eigen::Index>(i);
            const Point taken = pressure * pressed.taken.col(column);
            gradient.col(pressed.rim[i]) -= taken;
            energy -= taken.dot(x.col(pressed.rim[i]) - pressed.start.col(column));
        }
        (pressed.is_stored ? stored_ : lagged_) += energy;
        rounding_ += size * std::numeric_limits<double>::epsilon();
    }
    return stored_ + lagged_;
}

// The second derivative of pressure times volume: a facet's part of it is p / (2 Dim) times slope_b
// + slope_a^T for its corners a and b, with as many eigenvalues below 0 as above. Only in the sum
// over all facets do rigid motions of the body cost nothing. Filtered facet by facet, the Hessian
// would hold the body back, and a single linear solve would not let it fall: so with a filter it is
// left out.
template <int Dim>
void PressureLoads<Dim>::add_hessian(const Positions<Dim>& x,
                                     double weight,
                                     Filter filter,
                                     NewtonSystem<Dim>& system) {
    if (filter != Filter::None) {
        return;
    }
    constexpr Eigen::Index kSide = Dim * Dim;
    Eigen::Index total = 0;
    for (const PressedSurface& pressed : pressed_) {
        total += pressed.facets.cols();
    }
    hessians_.resize(static_cast<std::size_t>(total * kSide * kSide));
    system.reserve_stencils(static_cast<std::size_t>(total));
    double* next = hessians_.data();
    for (const PressedSurface& pressed : pressed_) {
        double* const first = next;
        workers_->for_each(pressed.facets.cols(), [&](Eigen::Index i) {
            const Normal<Dim> normal(corners_of<Dim>(pressed.facets.col(i), x, pressed.apex));
            Eigen::Map<Eigen::Matrix<double, kSide, kSide>> matrix(first + i * kSide * kSide);
            for (int a = 0; a < Dim; ++a) {
                for (int b = 0; b < Dim; ++b) {
                    matrix.template block<Dim, Dim>(Dim * a, Dim * b) =
                        normal.slopes[b] + normal.slopes[a].transpose();
                }
            }
        });
        next += pressed.facets.cols() * kSide * kSide;
        for (Eigen::Index i = 0; i < pressed.facets.cols(); ++i) {
            // A wall has entries for all corners but the apex, which comes first.
            const int skipped = pressed.facets(0, i) == kNoVertex ? 1 : 0;
            system.add_stencil({.vertices = &pressed.facets(skipped, i),
                                .numbers = first + i * kSide * kSide + skipped * Dim * (kSide + 1),
                                .count = Dim - skipped,
                                .stride = static_cast<std::int32_t>(kSide),
                                .scale = weight * pressed.factor * pressed.pressure / (2 * Dim)});
        }
    }
}

template <int Dim>
std::vector<TermEnergy> PressureLoads<Dim>::energies() const {
    std::vector<TermEnergy> parts;
    const auto has = [&](bool is_stored) {
        return std::any_of(pressed_.begin(), pressed_.end(), [&](const PressedSurface& pressed) {
            return pressed.is_stored == is_stored;
        });
    };
    if (has(true)) {
        parts.push_back({"pressure", stored_});
    }
    if (has(false)) {
        parts.push_back({.name = "open_pressure", .energy = lagged_, .is_stored = false});
    }
    return parts;
}

#define PENT_INSTANTIATE(Dim) template class PressureLoads<Dim>;
PENT_FOR_EACH_DIMENSION(PENT_INSTANTIATE)
#undef PENT_INSTANTIATE

}  // namespace pent::simulator
