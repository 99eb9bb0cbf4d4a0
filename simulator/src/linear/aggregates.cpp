#include "linear/aggregates.h"

#include "linear/links.h"

#include <pent/dimensions.h>

#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

namespace pent::simulator {

namespace {

constexpr double kDofs = 29;     // of an aggregate
constexpr double kChildren = 6;  // aggregates of an aggregate of aggregates
constexpr int kRounds = 8;       // of moving borders
// Length of aggregates along columns, which a smoother solves for as a whole, over width across.
constexpr double kSlenderness = 1.9;
// A relative difference that is none: rounding, which instruction sets and compilers do each in
// their own way, does not decide.
constexpr double kTie = 1e-9;
constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();

// How high the layer of a dof is: how far it is from the nearest dof of its column, in units of its
// distance from the nearest beside it; 1 where there is none of either, or none apart.
template <int Dim>
std::vector<double> layer_heights(const Links& links,
                                  const std::vector<std::uint32_t>& column_start,
                                  const Positions<Dim>& rest) {
    std::vector<double> heights(links.size(), 1.0);
    for (std::size_t column = 0; column + 1 < column_start.size(); ++column) {
        const std::uint32_t begin = column_start[column];
        const std::uint32_t end = column_start[column + 1];
        for (std::uint32_t dof = begin; dof < end; ++dof) {
            double within = std::numeric_limits<double>::infinity();
            double beside = std::numeric_limits<double>::infinity();
            links.for_each(dof, [&](std::uint32_t other) {
                double& nearest = other >= begin && other < end ? within : beside;
                nearest = std::min(nearest, (rest.col(other) - rest.col(dof)).norm());
            });
            if (within > 0 && beside > 0 && std::isfinite(within) && std::isfinite(beside)) {
                heights[dof] = within / beside;
            }
        }
    }
    return heights;
}

// What aggregates grow from.
template <int Dim>
struct Nodes {
    Links links;
    Positions<Dim> places;
    std::vector<double> weights;  // what each counts for the size of an aggregate
    std::vector<double> dofs;     // in each
};

// Nodes that are parts of others, without weights.
template <int Dim>
Nodes<Dim> nodes_of(const Aggregates& parts, const Nodes<Dim>& children) {
    const auto count = parts.members.size();
    Nodes<Dim> nodes{link_parts(children.links, parts.of_child, count),
                     Positions<Dim>::Zero(Dim, parts.count()), std::vector<double>(count, 1.0),
                     std::vector<double>(count, 0.0)};
    for (std::size_t a = 0; a < count; ++a) {
        auto place = nodes.places.col(static_cast<Eigen::Index>(a));
        for (const std::uint32_t child : parts.members[a]) {
            place += children.dofs[child] * children.places.col(child);
            nodes.dofs[a] += children.dofs[child];
        }
        place /= nodes.dofs[a];
    }
    return nodes;
}

// What the dofs of columns count for the size of an aggregate. Thin layers are coupled too strongly
// to be told apart, so that less of them is as much; but a whole column counts no less than the
// side of an aggregate of cubes, which it takes the place of.
template <int Dim>
std::vector<double> weights_of(const std::vector<double>& heights,
                               const std::vector<std::uint32_t>& column_start) {
    std::vector<double> weights;
    for (std::size_t column = 0; column + 1 < column_start.size(); ++column) {
        const std::uint32_t begin = column_start[column];
        const std::uint32_t end = column_start[column + 1];
        const double least = std::min(1.0, std::pow(kDofs, 1.0 / Dim) / (end - begin));
        for (std::uint32_t dof = begin; dof < end; ++dof) {
            weights.push_back(std::clamp(heights[dof], least, 1.0));
        }
    }
    return weights;
}

double sum_of(const std::vector<double>& values, std::uint32_t begin, std::uint32_t end) {
    return std::accumulate(values.begin() + begin, values.begin() + end, 0.0);
}

// Into how many parts to cut each column, so that aggregates of such parts are kSlenderness times
// as long as wide.
template <int Dim>
std::vector<double> parts_of_columns(const std::vector<double>& heights,
                                     const std::vector<double>& weights,
                                     const std::vector<std::uint32_t>& column_start) {
    std::vector<double> parts;
    for (std::size_t column = 0; column + 1 < column_start.size(); ++column) {
        const std::uint32_t begin = column_start[column];
        const std::uint32_t end = column_start[column + 1];
        const double most = std::max(1.0, static_cast<double>(end) - begin);
        const double height = sum_of(heights, begin, end);
        const double weight = sum_of(weights, begin, end);
        const double width = std::pow(kDofs * height / (kSlenderness * weight), 1.0 / Dim);
        parts.push_back(weight > 0 ? std::clamp(height / (kSlenderness * width), 1.0, most) : 1);
    }
    return parts;
}

// Which of `count` parts of a column, which are equally high, each of its dofs is in.
std::vector<std::uint32_t> cut_column(const std::vector<double>& heights,
                                      std::uint32_t begin,
                                      std::uint32_t end,
                                      std::uint32_t count) {
    const double whole = sum_of(heights, begin, end);
    std::vector<std::uint32_t> parts;
    double below = 0;
    for (std::uint32_t dof = begin; dof < end; ++dof) {
        const double middle = (below + heights[dof] / 2) / whole;
        below += heights[dof];
        parts.push_back(
            std::min(static_cast<std::uint32_t>((1 + kTie) * count * middle), count - 1));
    }
    return parts;
}

template <int Dim>
class Growth {
public:
    Growth(const Nodes<Dim>& nodes, double size)
        : nodes_(&nodes), size_(size), owner_(nodes.links.size(), kNone), seen_(owner_) {}

    // From seeds on, each beside what is there.
    Aggregates run() {
        for (std::uint32_t node = 0; node < owner_.size(); ++node) {
            if (owner_[node] == kNone) {
                seeds_ = {node};
                for (std::size_t next = 0; next < seeds_.size(); ++next) {
                    if (owner_[seeds_[next]] == kNone) {
                        grow(seeds_[next]);
                    }
                }
            }
        }
        join_small_ones();
        for (int round = 0; round < kRounds && move_borders(); ++round) {
        }
        return finish();
    }

    // From pieces on, each node in one of so many.
    Aggregates mend(std::vector<std::uint32_t> piece_of, std::size_t count) {
        owner_ = std::move(piece_of);
        members_.resize(count);
        return finish();
    }

private:
    // Of pieces that hang together, none of them small.
    Aggregates finish() {
        split();
        join_small_ones();
        return collect();
    }

    // The nodes beside it that nobody has become seeds of the next.
    void grow(std::uint32_t seed) {
        const auto piece = static_cast<std::uint32_t>(weights_.size());
        weights_.push_back(0);
        members_.emplace_back();
        Eigen::Matrix<double, Dim, 1> sum = Eigen::Matrix<double, Dim, 1>::Zero();
        std::vector<std::uint32_t> border = {seed};
        seen_[seed] = piece;
        while (!border.empty() && weights_[piece] < (1 - kTie) * size_) {
            const std::uint32_t node = nearest_of(border, sum, piece);
            border.erase(std::find(border.begin(), border.end(), node));
            owner_[node] = piece;
            members_[piece].push_back(node);
            weights_[piece] += nodes_->weights[node];
            sum += nodes_->places.col(node);
            nodes_->links.for_each(node, [&](std::uint32_t other) {
                if (owner_[other] == kNone && seen_[other] != piece) {
                    seen_[other] = piece;
                    border.push_back(other);
                }
            });
        }
        seeds_.insert(seeds_.end(), border.begin(), border.end());
    }

    // Of those that are equally near, as in grids, the first.
    [[nodiscard]] std::uint32_t nearest_of(const std::vector<std::uint32_t>& nodes,
                                           const Eigen::Matrix<double, Dim, 1>& sum,
                                           std::uint32_t piece) const {
        std::vector<double> distances;
        distances.reserve(nodes.size());
        for (const std::uint32_t node : nodes) {
            distances.push_back(distance(node, sum, piece));
        }
        const double least = *std::min_element(distances.begin(), distances.end());
        std::uint32_t first = kNone;
        for (std::size_t i = 0; i < nodes.size(); ++i) {
            if (distances[i] <= (1 + kTie) * least) {
                first = std::min(first, nodes[i]);
            }
        }
        return first;
    }

    [[nodiscard]] double distance(std::uint32_t node,
                                  const Eigen::Matrix<double, Dim, 1>& sum,
                                  std::uint32_t piece) const {
        const auto count = static_cast<double>(members_[piece].size());
        return count == 0 ? 0 : (nodes_->places.col(node) - sum / count).squaredNorm();
    }

    // Every node goes to the nearest of the aggregates that it or its neighbors are in: borders
    // become planes halfway between middles, as Lloyd's method makes them. Returns whether any
    // went.
    bool move_borders() {
        Positions<Dim> middles = Positions<Dim>::Zero(Dim, count());
        std::vector<double> dofs(members_.size(), 0.0);
        for (std::uint32_t node = 0; node < owner_.size(); ++node) {
            middles.col(owner_[node]) += nodes_->dofs[node] * nodes_->places.col(node);
            dofs[owner_[node]] += nodes_->dofs[node];
        }
        const std::vector<std::uint32_t> before = owner_;
        for (std::uint32_t node = 0; node < owner_.size(); ++node) {
            const auto distance_to = [&](std::uint32_t piece) {
                return (nodes_->places.col(node) - middles.col(piece) / dofs[piece]).squaredNorm();
            };
            double nearest = distance_to(before[node]);
            nodes_->links.for_each(node, [&](std::uint32_t other) {
                if (before[other] == owner_[node]) {
                    return;
                }
                const double distance = distance_to(before[other]);
                if (distance < (1 - kTie) * nearest) {
                    nearest = distance;
                    owner_[node] = before[other];
                }
            });
        }
        list_members();
        return owner_ != before;
    }

    // Each part of an aggregate that hangs together becomes one.
    void split() {
        std::vector<std::uint32_t> parts(owner_.size(), kNone);
        std::uint32_t count = 0;
        for (std::uint32_t root = 0; root < owner_.size(); ++root) {
            if (parts[root] != kNone) {
                continue;
            }
            parts[root] = count;
            std::vector<std::uint32_t> reached = {root};
            for (std::size_t next = 0; next < reached.size(); ++next) {
                nodes_->links.for_each(reached[next], [&](std::uint32_t other) {
                    if (parts[other] == kNone && owner_[other] == owner_[root]) {
                        parts[other] = count;
                        reached.push_back(other);
                    }
                });
            }
            ++count;
        }
        owner_ = std::move(parts);
        members_.resize(count);
        list_members();
    }

    void list_members() {
        for (std::vector<std::uint32_t>& members : members_) {
            members.clear();
        }
        weights_.assign(members_.size(), 0.0);
        for (std::uint32_t node = 0; node < owner_.size(); ++node) {
            members_[owner_[node]].push_back(node);
            weights_[owner_[node]] += nodes_->weights[node];
        }
    }

    void join_small_ones() {
        for (std::uint32_t piece = 0; piece < weights_.size(); ++piece) {
            if (3 * weights_[piece] < (1 - kTie) * size_) {
                join_neighbor(piece);
            }
        }
    }

    // What was left over between others joins the one it has most links with.
    void join_neighbor(std::uint32_t piece) {
        std::vector<std::uint32_t> others;
        for (const std::uint32_t node : members_[piece]) {
            nodes_->links.for_each(node, [&](std::uint32_t other) {
                if (owner_[other] != piece) {
                    others.push_back(owner_[other]);
                }
            });
        }
        std::sort(others.begin(), others.end());
        std::uint32_t best = kNone;
        std::ptrdiff_t most = 0;
        for (auto first = others.begin(); first != others.end();) {
            const auto last = std::upper_bound(first, others.end(), *first);
            if (last - first > most) {
                most = last - first;
                best = *first;
            }
            first = last;
        }
        if (best == kNone) {
            return;
        }
        for (const std::uint32_t node : members_[piece]) {
            owner_[node] = best;
            members_[best].push_back(node);
        }
        weights_[best] += weights_[piece];
        members_[piece].clear();
        weights_[piece] = 0;
    }

    // By color: those that share no link follow one another.
    Aggregates collect() {
        const std::vector<std::uint32_t> colors =
            color_nodes(link_parts(nodes_->links, owner_, members_.size()));
        std::vector<std::uint32_t> order;
        for (std::uint32_t piece = 0; piece < members_.size(); ++piece) {
            if (!members_[piece].empty()) {
                order.push_back(piece);
            }
        }
        std::stable_sort(order.begin(), order.end(),
                         [&](std::uint32_t a, std::uint32_t b) { return colors[a] < colors[b]; });
        Aggregates aggregates;
        aggregates.of_child.resize(owner_.size());
        for (const std::uint32_t piece : order) {
            std::vector<std::uint32_t>& members = members_[piece];
            std::sort(members.begin(), members.end());
            for (const std::uint32_t node : members) {
                aggregates.of_child[node] = static_cast<std::uint32_t>(aggregates.members.size());
            }
            aggregates.members.push_back(std::move(members));
        }
        return aggregates;
    }

    [[nodiscard]] Eigen::Index count() const { return static_cast<Eigen::Index>(members_.size()); }

    const Nodes<Dim>* nodes_;
    double size_;
    std::vector<std::uint32_t> owner_;  // of each node
    std::vector<std::uint32_t> seen_;   // the last whose border a node was in
    std::vector<std::uint32_t> seeds_;
    std::vector<std::vector<std::uint32_t>> members_;
    std::vector<double> weights_;  // of the aggregates
};

Aggregates whole_columns(const std::vector<std::uint32_t>& column_start) {
    Aggregates columns;
    for (std::size_t column = 0; column + 1 < column_start.size(); ++column) {
        std::vector<std::uint32_t> dofs(column_start[column + 1] - column_start[column]);
        std::iota(dofs.begin(), dofs.end(), column_start[column]);
        columns.of_child.insert(columns.of_child.end(), dofs.size(),
                                static_cast<std::uint32_t>(column));
        columns.members.push_back(std::move(dofs));
    }
    return columns;
}

// Clusters of whole columns, which are then cut across: rigid pieces lock least where they meet in
// planes.
//
// @param dofs  Without weights, which they get.
template <int Dim>
Aggregates aggregate_columns(const std::vector<std::uint32_t>& column_start, Nodes<Dim>& dofs) {
    const std::vector<double> heights = layer_heights<Dim>(dofs.links, column_start, dofs.places);
    dofs.weights = weights_of<Dim>(heights, column_start);
    const std::vector<double> parts = parts_of_columns<Dim>(heights, dofs.weights, column_start);
    Nodes<Dim> columns = nodes_of(whole_columns(column_start), dofs);
    for (std::size_t column = 0; column < parts.size(); ++column) {
        columns.weights[column] =
            sum_of(dofs.weights, column_start[column], column_start[column + 1]) / parts[column];
    }
    std::vector<std::uint32_t> piece_of(dofs.links.size());
    std::uint32_t pieces = 0;
    for (const std::vector<std::uint32_t>& cluster : Growth<Dim>(columns, kDofs).run().members) {
        double sum = 0;
        for (const std::uint32_t column : cluster) {
            sum += parts[column];
        }
        const auto count = static_cast<std::uint32_t>(
            std::lround((1 + kTie) * sum / static_cast<double>(cluster.size())));
        for (const std::uint32_t column : cluster) {
            std::uint32_t dof = column_start[column];
            for (const std::uint32_t part :
                 cut_column(heights, dof, column_start[column + 1], count)) {
                piece_of[dof++] = pieces + part;
            }
        }
        pieces += count;
    }
    return Growth<Dim>(dofs, kDofs).mend(std::move(piece_of), pieces);
}

}  // namespace

template <int Dim>
std::vector<Aggregates> make_hierarchy(const BlockPattern& pattern,
                                       const std::vector<std::uint32_t>& column_start,
                                       const Positions<Dim>& rest,
                                       const Sharing* sharing) {
    const auto count_all = [&](const Aggregates& level) {
        const std::int64_t own = level.count();
        return sharing != nullptr ? sharing->sum(own) : own;
    };
    const auto dofs = static_cast<Eigen::Index>(pattern.rows());
    Nodes<Dim> nodes{link_dofs(pattern),
                     rest.leftCols(dofs),
                     {},
                     std::vector<double>(static_cast<std::size_t>(dofs), 1.0)};
    std::vector<Aggregates> levels = {aggregate_columns(column_start, nodes)};
    for (std::int64_t count = count_all(levels.back()); count > kCoarsestAggregates;) {
        nodes = nodes_of(levels.back(), nodes);
        Aggregates next = Growth<Dim>(nodes, kChildren).run();
        const std::int64_t fewer = count_all(next);
        if (fewer == count) {
            break;
        }
        levels.push_back(std::move(next));
        count = fewer;
    }
    return levels;
}

#define PENT_INSTANTIATE(Dim)                                                               \
    template std::vector<Aggregates> make_hierarchy<Dim>(const BlockPattern&,               \
                                                         const std::vector<std::uint32_t>&, \
                                                         const Positions<Dim>&, const Sharing*);
PENT_FOR_EACH_DIMENSION(PENT_INSTANTIATE)
#undef PENT_INSTANTIATE

}  // namespace pent::simulator
