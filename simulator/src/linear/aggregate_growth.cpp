#include "linear/aggregate_growth.h"

#include <pent/dimensions.h>

#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace pent::simulator {

namespace {

constexpr int kRounds = 8;  // of moving borders
constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();

template <int Dim>
class Growth {
public:
    Growth(const AggregateNodes<Dim>& nodes, double size)
        : nodes_(&nodes), size_(size), owner_(nodes.links.size(), kNone), seen_(owner_) {}

    // The queue of seeds grows while it is worked off; each component of the graph begins one.
    Aggregates run() {
        for (std::uint32_t node = 0; node < owner_.size(); ++node) {
            if (owner_[node] == kNone) {
                seeds_ = {node};
                // It grows in the loop. NOLINTNEXTLINE(modernize-loop-convert)
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

    // Starts from pieces, which every node is in one of.
    Aggregates mend(std::vector<std::uint32_t> piece_of) {
        owner_ = std::move(piece_of);
        return finish();
    }

private:
    // Makes pieces connected, and none of them small.
    Aggregates finish() {
        split();
        join_small_ones();
        return collect();
    }

    // Grows one aggregate; the free nodes beside it become seeds.
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

    // The node nearest to the centroid; of those that are equally near, as in grids, the first.
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

    // One round of Lloyd's method on a graph: every node goes to the aggregate with the nearest
    // centroid among its own and those of its neighbors, so that borders become planes halfway
    // between centroids. Returns whether any node went elsewhere.
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

    // Each connected component of an aggregate becomes an aggregate.
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

    // Merges an aggregate into the one with which it has the most links.
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

    // Numbers what is not empty by color: aggregates that share no link follow one another.
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
        std::vector<std::uint32_t> number_of(members_.size());
        for (std::uint32_t number = 0; number < order.size(); ++number) {
            number_of[order[number]] = number;
        }
        for (std::uint32_t& owner : owner_) {
            owner = number_of[owner];
        }
        return {std::move(owner_), order.size()};
    }

    [[nodiscard]] Eigen::Index count() const { return static_cast<Eigen::Index>(members_.size()); }

    const AggregateNodes<Dim>* nodes_;
    double size_;
    std::vector<std::uint32_t> owner_;  // of each node
    std::vector<std::uint32_t> seen_;   // the last aggregate that had a node in its border
    std::vector<std::uint32_t> seeds_;
    std::vector<std::vector<std::uint32_t>> members_;
    std::vector<double> weights_;  // of the aggregates
};

}  // namespace

template <int Dim>
Aggregates grow_aggregates(const AggregateNodes<Dim>& nodes, double size) {
    return Growth<Dim>(nodes, size).run();
}

template <int Dim>
Aggregates mend_aggregates(const AggregateNodes<Dim>& nodes,
                           double size,
                           std::vector<std::uint32_t> piece_of) {
    return Growth<Dim>(nodes, size).mend(std::move(piece_of));
}

#define PENT_INSTANTIATE(Dim)                                                     \
    template Aggregates grow_aggregates<Dim>(const AggregateNodes<Dim>&, double); \
    template Aggregates mend_aggregates<Dim>(const AggregateNodes<Dim>&, double,  \
                                             std::vector<std::uint32_t>);
PENT_FOR_EACH_DIMENSION(PENT_INSTANTIATE)
#undef PENT_INSTANTIATE

}  // namespace pent::simulator
