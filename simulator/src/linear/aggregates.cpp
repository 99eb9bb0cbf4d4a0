#include "linear/aggregates.h"

#include "linear/aggregate_growth.h"
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
constexpr double kChildren = 6;  // of an aggregate of aggregates
// Length of aggregates along columns over width across. The smoother solves whole columns, so that
// aggregates need to resolve less along them.
constexpr double kSlenderness = 1.9;

// Height of the layer of each dof: its distance from the nearest dof linked to it within its column
// over that from the nearest one in another; 1 where either is missing or zero.
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

// The graph of parts of a graph; weights are 1.
template <int Dim>
AggregateNodes<Dim> nodes_of(const Aggregates& parts, const AggregateNodes<Dim>& children) {
    const auto count = static_cast<std::size_t>(parts.count());
    AggregateNodes<Dim> nodes{link_parts(children.links, parts.of_child(), count),
                              Positions<Dim>::Zero(Dim, parts.count()),
                              std::vector<double>(count, 1.0), std::vector<double>(count, 0.0)};
    for (std::size_t a = 0; a < count; ++a) {
        auto place = nodes.places.col(static_cast<Eigen::Index>(a));
        for (const std::uint32_t child : parts.members(a)) {
            place += children.dofs[child] * children.places.col(child);
            nodes.dofs[a] += children.dofs[child];
        }
        place /= nodes.dofs[a];
    }
    return nodes;
}

// What each dof counts toward the size of an aggregate. Thin layers are coupled too strongly to be
// told apart, so that a dof in one counts less, in proportion to its height; but a whole column
// counts no less than the side of a cube of kDofs dofs, the place of which it takes.
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

// Into how many parts (not a whole number) to cut each column, so that aggregates of kDofs made of
// such parts are kSlenderness times as long as wide.
template <int Dim>
std::vector<double> parts_of_columns(const std::vector<double>& heights,
                                     const std::vector<double>& weights,
                                     const std::vector<std::uint32_t>& column_start) {
    std::vector<double> parts;
    for (std::size_t column = 0; column + 1 < column_start.size(); ++column) {
        const std::uint32_t begin = column_start[column];
        const std::uint32_t end = column_start[column + 1];
        const double most = static_cast<double>(end) - begin;
        const double height = sum_of(heights, begin, end);
        const double weight = sum_of(weights, begin, end);
        const double width = std::pow(kDofs * height / (kSlenderness * weight), 1.0 / Dim);
        parts.push_back(std::clamp(height / (kSlenderness * width), 1.0, most));
    }
    return parts;
}

// Cuts a column into `count` parts of equal height; returns the part of each of its dofs.
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

Aggregates whole_columns(const std::vector<std::uint32_t>& column_start) {
    std::vector<std::uint32_t> column_of;
    for (std::size_t column = 0; column + 1 < column_start.size(); ++column) {
        column_of.resize(column_start[column + 1], static_cast<std::uint32_t>(column));
    }
    return {std::move(column_of), column_start.size() - 1};
}

// Clusters whole columns, then cuts each cluster across, all its columns into equally many parts:
// rigid pieces lock least where they meet in planes.
//
// @param dofs  Their weights are set here.
template <int Dim>
Aggregates aggregate_columns(const std::vector<std::uint32_t>& column_start,
                             AggregateNodes<Dim>& dofs) {
    const std::vector<double> heights = layer_heights<Dim>(dofs.links, column_start, dofs.places);
    dofs.weights = weights_of<Dim>(heights, column_start);
    const std::vector<double> parts = parts_of_columns<Dim>(heights, dofs.weights, column_start);
    AggregateNodes<Dim> columns = nodes_of(whole_columns(column_start), dofs);
    for (std::size_t column = 0; column < parts.size(); ++column) {
        columns.weights[column] =
            sum_of(dofs.weights, column_start[column], column_start[column + 1]) / parts[column];
    }
    std::vector<std::uint32_t> piece_of(dofs.links.size());
    std::uint32_t pieces = 0;
    const Aggregates clusters = grow_aggregates(columns, kDofs);
    for (std::size_t c = 0; c < static_cast<std::size_t>(clusters.count()); ++c) {
        const std::span<const std::uint32_t> cluster = clusters.members(c);
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
    return mend_aggregates(dofs, kDofs, std::move(piece_of));
}

}  // namespace

Aggregates::Aggregates(std::vector<std::uint32_t> of_child, std::size_t count)
    : of_child_(std::move(of_child)), members_(of_child_.size()), members_of_(count) {
    for (const std::uint32_t aggregate : of_child_) {
        if (members_of_[aggregate].count++ == 0) {
            order_.push_back(aggregate);
        }
    }
    std::uint32_t first = 0;
    for (const std::uint32_t aggregate : order_) {
        Range& range = members_of_[aggregate];
        range.first = first;
        first += range.count;
        range.count = 0;
    }
    for (std::uint32_t child = 0; child < of_child_.size(); ++child) {
        Range& range = members_of_[of_child_[child]];
        members_[range.first + range.count++] = child;
    }
}

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
    AggregateNodes<Dim> nodes{link_dofs(pattern),
                              rest.leftCols(dofs),
                              {},
                              std::vector<double>(static_cast<std::size_t>(dofs), 1.0)};
    std::vector<Aggregates> levels = {aggregate_columns(column_start, nodes)};
    for (std::int64_t count = count_all(levels.back()); count > kCoarsestAggregates;) {
        nodes = nodes_of(levels.back(), nodes);
        Aggregates next = grow_aggregates(nodes, kChildren);
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
