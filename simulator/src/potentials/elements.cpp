#include "potentials/elements.h"

#include "model/active_strain.h"

#include <pent/dimensions.h>
#include <pent/error.h>
#include <pent/simulator/energy.h>

#include <Eigen/LU>

#include <algorithm>
#include <limits>
#include <utility>

namespace pent::simulator {

namespace {

constexpr int kChunkElements = 512;  // a multiple of kGroup
static_assert(kChunkElements % kGroup == 0);

// So that kTurnedBlock - block, which stands for the transpose of a block, fits its type.
constexpr std::int64_t kMaxBlocks = std::numeric_limits<std::int32_t>::max() - 2;

// The same of quadratic elements, each of which stands for as many cells as it has children.
constexpr int kChunkQuadratic = 4 * kGroup;

// Smoothing domains are sorted by their number of corners, for chunks of equal ones, but only
// within stretches of so many, which leaves neighbors close in memory.
constexpr std::size_t kNearElements = std::size_t{8} * kChunkElements;
static_assert(kNearElements % kChunkElements == 0);

// The part of lambda that acts at every quadrature point of a quadratic element by itself, alpha mu
// at most; the rest acts on the mean dilatation of the element, so that it does not lock. Without
// it elements are a fifth too soft in diagonal bending with one across; twice as much is too stiff
// by 5% along an axis. In 4D it is where unstructured meshes lock least, too.
template <int Dim>
double local_lambda(const Material& material) {
    constexpr double kAlpha = Dim == 3 ? 1 : 0.5;
    const auto [lambda, mu] = material.lame;
    // arap has no part of its energy that resists a change of volume
    return material.model == Model::Arap ? lambda : std::min(lambda, kAlpha * mu);
}

}  // namespace

void ElasticEnergy::add(const ElasticEnergy& other) {
    energy += other.energy;
    inverted += other.inverted;
    collapsed += other.collapsed;
    for (std::size_t range = 0; range < other.of_ranges.size(); ++range) {
        of_ranges[range] += other.of_ranges[range];
    }
}

template <int Dim>
Elements<Dim>::Elements(std::size_t ranges, const DofMap& dofs, const BlockPattern& pattern)
    : indices_(dofs.indices()), ranges_(ranges), dof_count_(dofs.count()) {
    if (pattern.blocks() > kMaxBlocks) {
        // GCOVR_EXCL_START: 137 GB of blocks
        throw Error("the mesh has " + std::to_string(pattern.blocks()) + " matrix blocks; at most "
                    + std::to_string(kMaxBlocks) + " can be simulated");
        // GCOVR_EXCL_STOP
    }
}

template <int Dim>
Elements<Dim>::Elements(const Positions<Dim>& rest,
                        const Simplices<Dim + 1>& cells,
                        const std::vector<CellRange>& ranges,
                        const DofMap& dofs,
                        const BlockPattern& pattern,
                        const ActiveStrain<Dim>* strain,
                        const Grips* grips)
    : Elements(ranges.size(), dofs, pattern) {
    const auto make = [&](std::size_t /*range*/, Eigen::Index cell, Element& element) {
        element.corners.assign(cells.col(cell).begin(), cells.col(cell).end());
        std::sort(
            element.corners.begin(), element.corners.end(),
            [&](std::uint32_t a, std::uint32_t b) { return dofs.index_of(a) < dofs.index_of(b); });
        Eigen::Matrix<double, Dim, Dim> Dm;
        for (int a = 0; a < Dim; ++a) {
            Dm.col(a) = rest.col(element.corners[static_cast<std::size_t>(a) + 1])
                        - rest.col(element.corners[0]);
        }
        const Eigen::Matrix<double, Dim, Dim> gradients = Dm.inverse().transpose();
        element.rest.assign(gradients.data(), gradients.data() + gradients.size());
        element.volume = cell_volume<Dim>(rest, cells, cell);
    };
    std::vector<OwnAndShared> chosen;
    for (const CellRange& range : ranges) {
        chosen.push_back(elastic_elements(
            range.begin, range.end, dofs, grips,
            [&](Eigen::Index cell) { return std::span(cells.col(cell).data(), Dim + 1); }));
    }
    const auto like_of = [&](std::size_t range, const auto& /*elements*/) {
        return Chunk{.corners = Dim + 1, .material = ranges[range].material};
    };
    append(plan(chosen, kChunkElements, like_of), make, dofs, pattern, strain);
    color(dofs.vertex_count());
}

template <int Dim>
Elements<Dim>::Elements(const std::vector<SmoothingDomains<Dim>>& domains,
                        const std::vector<CellRange>& ranges,
                        const DofMap& dofs,
                        const BlockPattern& pattern,
                        const Grips* grips)
    : Elements(ranges.size(), dofs, pattern) {
    const auto corner_count = [&](std::size_t range, Eigen::Index domain) {
        const auto d = static_cast<std::size_t>(domain);
        return static_cast<int>(domains[range].start[d + 1] - domains[range].start[d]);
    };
    const auto make = [&](std::size_t range, Eigen::Index domain, Element& element) {
        const SmoothingDomains<Dim>& of_range = domains[range];
        const Eigen::Index start = of_range.start[static_cast<std::size_t>(domain)];
        std::vector<std::pair<std::uint32_t, Eigen::Index>> keyed;
        for (Eigen::Index i = start; i < start + corner_count(range, domain); ++i) {
            const std::uint32_t corner = of_range.corners[static_cast<std::size_t>(i)];
            keyed.emplace_back(dofs.index_of(corner), i);
        }
        std::sort(keyed.begin(), keyed.end());
        element.corners.clear();
        element.rest.clear();
        for (const auto& [dof, i] : keyed) {
            if (!element.corners.empty()) {
                const auto gradient = of_range.gradients.col(i);
                element.rest.insert(element.rest.end(), gradient.begin(), gradient.end());
            }
            element.corners.push_back(of_range.corners[static_cast<std::size_t>(i)]);
        }
        element.volume = of_range.volumes[static_cast<std::size_t>(domain)];
    };
    std::vector<OwnAndShared> chosen;
    for (std::size_t range = 0; range < domains.size(); ++range) {
        const SmoothingDomains<Dim>& of_range = domains[range];
        chosen.push_back(
            elastic_elements(0, of_range.count(), dofs, grips, [&](Eigen::Index domain) {
                const auto first = of_range.start[static_cast<std::size_t>(domain)];
                return std::span(of_range.corners.data() + first,
                                 static_cast<std::size_t>(corner_count(range, domain)));
            }));
        sort_near(chosen.back(), kNearElements,
                  [&](Eigen::Index domain) { return corner_count(range, domain); });
    }
    const auto like_of = [&](std::size_t range, const auto& elements) {
        return Chunk{.kind = ElementKind::Smoothed,
                     .corners = corner_count(range, elements.back()),
                     .material = ranges[range].material};
    };
    append(plan(chosen, kChunkElements, like_of), make, dofs, pattern, nullptr);
    color(dofs.vertex_count());
}

template <int Dim>
Elements<Dim>::Elements(const Positions<Dim>& rest,
                        const QuadraticCells<Dim>& quadratic,
                        const DofMap& dofs,
                        const BlockPattern& pattern,
                        const ActiveStrain<Dim>* strain,
                        const Grips* grips)
    : Elements(quadratic.ranges.size(), dofs, pattern) {
    const QuadraticSimplices<Dim>& nodes = quadratic.nodes;
    const auto make = [&](std::size_t /*range*/, Eigen::Index simplex, Element& element) {
        element.corners.assign(nodes.col(simplex).begin(), nodes.col(simplex).end());
        const QuadraticRest<Dim> own =
            quadratic_rest<Dim>(places_of_nodes<Dim>(rest, nodes, simplex));
        element.rest.assign(own.rows.begin(), own.rows.end());
        element.volume = own.volume;
    };
    std::vector<OwnAndShared> chosen;
    for (const CellRange& range : quadratic.ranges) {
        chosen.push_back(
            elastic_elements(range.begin, range.end, dofs, grips, [&](Eigen::Index simplex) {
                return std::span(nodes.col(simplex).data(), kQuadraticNodes<Dim>);
            }));
    }
    const auto like_of = [&](std::size_t range, const auto& /*elements*/) {
        return Chunk{.kind = ElementKind::Quadratic,
                     .corners = kQuadraticNodes<Dim>,
                     .material = quadratic.ranges[range].material};
    };
    append(plan(chosen, kChunkQuadratic, like_of), make, dofs, pattern, strain);
    color(dofs.vertex_count());
}

template <int Dim>
std::size_t Elements<Dim>::rest_rows(const Chunk& chunk) {
    return chunk.kind == ElementKind::Quadratic
               ? kQuadraticRestRows<Dim>
               : static_cast<std::size_t>(chunk.corners - 1) * Dim + 1;
}

template <int Dim>
template <typename LikeOf>
std::vector<typename Elements<Dim>::Plan> Elements<Dim>::plan(
    const std::vector<OwnAndShared>& chosen, std::size_t size, const LikeOf& like_of) {
    std::vector<Plan> plans;
    for (std::size_t range = 0; range < chosen.size(); ++range) {
        for_each_chunk(chosen[range], size, [&](const auto& elements, bool counts) {
            Chunk like = like_of(range, elements);
            like.range = range;
            like.counts = counts;
            plans.push_back({like, elements});
        });
    }
    return plans;
}

template <int Dim>
void Elements<Dim>::reserve(const std::vector<Plan>& plans) {
    std::size_t rest = 0;
    std::size_t corners = 0;
    std::size_t blocks = 0;
    for (const Plan& plan : plans) {
        const std::size_t lanes = lanes_of(plan);
        rest += rest_rows(plan.like) * lanes;
        corners += static_cast<std::size_t>(plan.like.corners) * lanes;
        blocks += static_cast<std::size_t>(pairs_of(plan.like.corners)) * lanes;
    }
    rest_.reserve(rest);
    vertices_.reserve(corners);
    blocks_.reserve(blocks);
}

template <int Dim>
template <typename Make>
void Elements<Dim>::append(const std::vector<Plan>& plans,
                           const Make& make,
                           const DofMap& dofs,
                           const BlockPattern& pattern,
                           const ActiveStrain<Dim>* strain) {
    reserve(plans);
    for (const Plan& plan : plans) {
        append(plan, make, dofs, pattern);
        keep_passive(plan.elements, strain);
    }
}

template <int Dim>
template <typename Make>
void Elements<Dim>::append(const Plan& plan,
                           const Make& make,
                           const DofMap& dofs,
                           const BlockPattern& pattern) {
    const std::span<const Eigen::Index> chosen = plan.elements;
    const std::size_t lanes = lanes_of(plan);
    Chunk chunk = plan.like;
    const double scale = collapse_scale(chunk.material, Dim);
    chunk.elements = static_cast<int>(chosen.size());
    chunk.collapse_norm = Dim * scale * scale;
    chunk.first_rest = rest_.size();
    chunk.first_corner = vertices_.size();
    chunk.first_block = blocks_.size();
    const auto n = static_cast<std::size_t>(chunk.corners);
    rest_.resize(rest_.size() + rest_rows(chunk) * lanes);
    vertices_.resize(vertices_.size() + n * lanes);
    blocks_.resize(blocks_.size() + static_cast<std::size_t>(pairs_of(chunk.corners)) * lanes,
                   kNoBlock);
    Element element;
    for (std::size_t lane = 0; lane < lanes; ++lane) {
        if (lane < chosen.size()) {
            make(chunk.range, chosen[lane], element);
        } else {
            element.volume = 0;  // padding
        }
        set_lane(element, chunk, lane, dofs, pattern);
    }
    chunks_.push_back(chunk);
    count_ += chunk.counts ? chunk.elements : 0;
}

template <int Dim>
void Elements<Dim>::set_lane(const Element& element,
                             const Chunk& chunk,
                             std::size_t lane,
                             const DofMap& dofs,
                             const BlockPattern& pattern) {
    const auto n = static_cast<std::size_t>(chunk.corners);
    const std::size_t group = lane / kGroup * kGroup;
    // Entry `row` of the lane in an array that has so many rows a group.
    const auto at = [&](std::size_t begin, std::size_t rows, std::size_t row) {
        return begin + group * rows + row * kGroup + lane % kGroup;
    };
    const std::size_t rows = rest_rows(chunk);
    for (std::size_t row = 0; row + 1 < rows; ++row) {
        rest_[at(chunk.first_rest, rows, row)] = row < element.rest.size() ? element.rest[row] : 0;
    }
    rest_[at(chunk.first_rest, rows, rows - 1)] = element.volume;
    const std::size_t pairs = n * (n + 1) / 2;
    std::size_t pair = 0;
    for (std::size_t a = 0; a < n; ++a) {
        const std::uint32_t vertex = element.corners[a < element.corners.size() ? a : 0];
        const std::uint32_t row = dofs.index_of(vertex);
        vertices_[at(chunk.first_corner, n, a)] = vertex;
        for (std::size_t b = a; b < n; ++b, ++pair) {
            if (b >= element.corners.size()) {
                continue;
            }
            const std::uint32_t column = dofs.index_of(element.corners[b]);
            // Only pairs of dofs of which the lower one has a row here have a block.
            if (std::max(row, column) < dofs.count() && std::min(row, column) < dofs.row_count()) {
                const auto block = static_cast<std::int32_t>(
                    pattern.find(std::min(row, column), std::max(row, column)));
                blocks_[at(chunk.first_block, pairs, pair)] =
                    row <= column ? block : kTurnedBlock - block;
            }
        }
    }
}

template <int Dim>
void Elements<Dim>::color(std::size_t vertices) {
    coloring_ = color_chunks(static_cast<int>(chunks_.size()), static_cast<std::int64_t>(vertices),
                             [&](int chunk, const auto& touch) {
                                 const auto c = static_cast<std::size_t>(chunk);
                                 const std::size_t first = chunks_[c].first_corner;
                                 const std::size_t last = c + 1 < chunks_.size()
                                                              ? chunks_[c + 1].first_corner
                                                              : vertices_.size();
                                 for (std::size_t i = first; i < last; ++i) {
                                     touch(vertices_[i]);
                                 }
                             });
}

template <int Dim>
ElementRun Elements<Dim>::run(int chunk) const {
    const Chunk& c = chunks_[static_cast<std::size_t>(chunk)];
    Material material = c.material;
    if (c.kind == ElementKind::Quadratic) {
        material.lame.lambda = local_lambda<Dim>(c.material);
    }
    return {.kind = c.kind,
            .material = material,
            .mean_lambda = c.material.lame.lambda - material.lame.lambda,
            .collapse_norm = c.collapse_norm,
            .elements = c.elements,
            .corners = c.corners,
            .rest = rest_.data() + c.first_rest,
            .vertices = vertices_.data() + c.first_corner,
            .dofs = indices_.data(),
            .blocks = blocks_.data() + c.first_block,
            .dof_count = dof_count_};
}

template <int Dim>
ElasticEnergy Elements<Dim>::add_gradient(const Workers& workers,
                                          const Kernels<Dim>& kernels,
                                          const Positions<Dim>& positions,
                                          Positions<Dim>& gradient) const {
    std::vector<RunEnergy> parts(chunks_.size());
    for (const std::vector<int>& color : coloring_.colors) {
        workers.for_each(static_cast<int>(color.size()), [&](int i) {
            const int chunk = color[static_cast<std::size_t>(i)];
            parts[static_cast<std::size_t>(chunk)] =
                kernels.gradient(run(chunk), positions.data(), gradient.data());
        });
    }
    ElasticEnergy total;
    total.of_ranges.assign(ranges_, 0);
    for (std::size_t chunk = 0; chunk < parts.size(); ++chunk) {
        if (!chunks_[chunk].counts) {
            continue;
        }
        total.energy += parts[chunk].energy;
        total.inverted += parts[chunk].inverted;
        total.collapsed += parts[chunk].collapsed;
        total.of_ranges[chunks_[chunk].range] += parts[chunk].energy;
    }
    return total;
}

template <int Dim>
template <typename Scalar>
std::int64_t Elements<Dim>::add_hessian(const Workers& workers,
                                        const Kernels<Dim>& kernels,
                                        const Positions<Dim>& positions,
                                        const HessianTarget<Scalar>& target) const {
    std::int64_t filtered = 0;
    for (const std::vector<int>& color : coloring_.colors) {
        filtered += workers.sum(static_cast<int>(color.size()), [&](int i) {
            const int chunk = color[static_cast<std::size_t>(i)];
            const ElementRun elements = run(chunk);
            std::int64_t changed = 0;
            if constexpr (sizeof(Scalar) == sizeof(float)) {
                changed = kernels.hessian_float(elements, positions.data(), target);
            } else {
                changed = kernels.hessian_double(elements, positions.data(), target);
            }
            return chunks_[static_cast<std::size_t>(chunk)].counts ? changed : 0;
        });
    }
    return filtered;
}

template <int Dim>
std::int64_t Elements<Dim>::bytes() const {
    std::size_t passive = 0;
    for (const Passive& chunk : passive_) {
        passive +=
            chunk.rest.size() * sizeof(double) + chunk.elements.size() * sizeof(Eigen::Index);
    }
    return static_cast<std::int64_t>(passive + rest_.size() * sizeof(double)
                                     + (vertices_.size() + indices_.size() + blocks_.size())
                                           * sizeof(std::uint32_t));
}

#define PENT_INSTANTIATE(Dim) template class Elements<Dim>;
PENT_FOR_EACH_DIMENSION(PENT_INSTANTIATE)
#undef PENT_INSTANTIATE
#define PENT_INSTANTIATE(Dim, Scalar)                                                             \
    template std::int64_t Elements<Dim>::add_hessian<Scalar>(                                     \
        const Workers&, const Kernels<Dim>&, const Positions<Dim>&, const HessianTarget<Scalar>&) \
        const;
PENT_FOR_EACH_DIMENSION(PENT_INSTANTIATE, float)
PENT_FOR_EACH_DIMENSION(PENT_INSTANTIATE, double)
#undef PENT_INSTANTIATE

}  // namespace pent::simulator
