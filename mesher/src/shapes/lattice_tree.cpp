#include "lattice_tree.h"

#include <pent/error.h>
#include <pent/formatted.h>
#include <pent/mesher/halve_simplex.h>
#include <pent/parallel.h>

#include <algorithm>
#include <cmath>

namespace pent::mesher {

namespace {

constexpr int kBits = 16;                                // of a coordinate
constexpr double kFarthestPoint = 1e9;                   // coordinates are ints
constexpr std::size_t kMaxCells = std::size_t{1} << 26;  // 1.6e9 simplices
constexpr double kRounding = 1e-9;

// Cells of this size and larger are asked whether the body may be there; what is smaller is not
// worth it.
constexpr int kSmallestAsked = 2;

constexpr std::uint32_t kTask = 256;  // cells or points

// Each bit of a coordinate four places from the next, and back.
std::uint64_t spread(std::uint64_t z) {
    z = (z | z << 24) & 0x000000ff000000ffULL;
    z = (z | z << 12) & 0x000f000f000f000fULL;
    z = (z | z << 6) & 0x0303030303030303ULL;
    return (z | z << 3) & 0x1111111111111111ULL;
}

int gathered(std::uint64_t z) {
    z &= 0x1111111111111111ULL;
    z = (z | z >> 3) & 0x0303030303030303ULL;
    z = (z | z >> 6) & 0x000f000f000f000fULL;
    z = (z | z >> 12) & 0x000000ff000000ffULL;
    return static_cast<int>((z | z >> 24) & 0xffffULL);
}

// Bits of four coordinates in turn. Where all coordinates grow, so does the key.
std::uint64_t key_of(const Eigen::Vector4i& z) {
    std::uint64_t key = 0;
    for (int axis = 0; axis < 4; ++axis) {
        key |= spread(static_cast<std::uint64_t>(z[axis])) << (3 - axis);
    }
    return key;
}

Eigen::Vector4i point_of(std::uint64_t key) {
    return {gathered(key >> 3), gathered(key >> 2), gathered(key >> 1), gathered(key)};
}

bool is_in_range(const Eigen::Vector4i& z) {
    return z.minCoeff() >= 0 && z.maxCoeff() < 1 << kBits;
}

// Digits of base 3.
Eigen::Vector4i digits(unsigned place) {
    const auto p = static_cast<int>(place);
    return {p % 3, p / 3 % 3, p / 9 % 3, p / 27};
}

unsigned place_of(const Eigen::Vector4i& digits) {
    return static_cast<unsigned>(digits[0] + 3 * digits[1] + 9 * digits[2] + 27 * digits[3]);
}

Eigen::Vector4i unit_steps(unsigned axes) {
    return {static_cast<int>(axes & 1U), static_cast<int>(axes >> 1 & 1U),
            static_cast<int>(axes >> 2 & 1U), static_cast<int>(axes >> 3 & 1U)};
}

// The middles that a cell has in common with each of its neighbors: edges of either that lie in
// both.
std::array<std::bitset<81>, 81> shared_middles() {
    std::array<std::bitset<81>, 81> shared;
    for (unsigned neighbor = 0; neighbor < 81; ++neighbor) {
        const Eigen::Vector4i side = digits(neighbor).array() - 1;
        for (unsigned place = 0; place < 81; ++place) {
            const Eigen::Vector4i at = digits(place);
            bool is_shared = (at.array() == 1).any();
            for (int axis = 0; axis < 4; ++axis) {
                is_shared = is_shared && (side[axis] == 0 || at[axis] == 1 + side[axis]);
            }
            shared[neighbor][place] = is_shared;
        }
    }
    return shared;
}

}  // namespace

const std::array<LatticePath, 24>& lattice_paths() {
    static const std::array<LatticePath, 24> all = [] {
        std::array<LatticePath, 24> paths;
        std::array<int, 4> axes = {0, 1, 2, 3};
        for (LatticePath& path : paths) {
            for (int i = 0; i < 4; ++i) {
                path.steps[i + 1] = path.steps[i] | 1U << axes[i];
                for (int j = i + 1; j < 4; ++j) {
                    path.is_odd = path.is_odd != (axes[i] > axes[j]);
                }
            }
            std::next_permutation(axes.begin(), axes.end());
        }
        return paths;
    }();
    return all;
}

struct LatticeTree::Node {
    Eigen::Vector4i corner;  // in spacings from low_
    int size = 0;
    bool is_inside = false;
};

// For each path the place of a corner or middle, and the pieces of every set of middles.
struct LatticeTree::PatternTable {
    using Piece = std::array<std::uint8_t, 5>;  // numbers of corners, then of edges + 5
    std::array<std::array<unsigned, 15>, 24> places{};
    std::vector<std::vector<Piece>> pieces;

    PatternTable() {
        for (unsigned p = 0; p < lattice_paths().size(); ++p) {
            const auto& steps = lattice_paths()[p].steps;
            for (int i = 0; i < 5; ++i) {
                for (int j = i; j < 5; ++j) {
                    const unsigned number =
                        i == j ? static_cast<unsigned>(i) : 5 + edge_number(5, i, j);
                    places[p][number] = place_of(unit_steps(steps[i]) + unit_steps(steps[j]));
                }
            }
        }
        for (const std::vector<HalvedPiece>& pattern : halved_simplices(4)) {
            std::vector<Piece>& list = pieces.emplace_back();
            for (const HalvedPiece& corners : pattern) {
                Piece& piece = list.emplace_back();
                std::transform(
                    corners.begin(), corners.end(), piece.begin(), [](const HalvedCorner& c) {
                        return c.first == c.second ? c.first
                                                   : static_cast<std::uint8_t>(
                                                       5 + edge_number(5, c.first, c.second));
                    });
            }
        }
    }
};

const LatticeTree::PatternTable& LatticeTree::patterns() {
    static const PatternTable table;
    return table;
}

LatticeTree::LatticeTree(const Solid& solid, const Lattice& smallest, const SizeField& sizes)
    : lattice_(smallest) {
    set_range(solid, sizes);
    choose_cells(solid, sizes);
    std::vector<std::bitset<kPlaces>> middles;
    halved_.assign(cell_count(), kNone);
    for (std::uint32_t cell = 0; cell < cell_count(); ++cell) {
        const std::bitset<kPlaces> own = middles_of(cells_[cell]);
        if (own.any()) {
            halved_[cell] = static_cast<std::uint32_t>(middles.size());
            middles.push_back(own);
        }
    }
    split_.clear();
    number_points(middles);
    sample(solid);
    leave_out_what_is_outside();
}

Eigen::Vector4d LatticeTree::place(std::uint32_t point) const {
    return lattice_.point(low_ + point_of(keys_[point]));
}

// The largest cells that have the box of the body.
void LatticeTree::set_range(const Solid& solid, const SizeField& sizes) {
    const Box4& box = solid.bounds();
    const Eigen::Vector4d middle = lattice_.coordinates((box.low + box.high) / 2);
    // The farthest of the corners along each axis of the lattice: all coordinates grow with all
    // of a point.
    const Eigen::Vector4d reach = lattice_.coordinates((box.high - box.low) / 2);
    const double shortest = lattice_.mean_edge();
    const double radius = (box.high - box.low).norm() / 2;
    const double longest =
        sizes.is_uniform()
            ? shortest
            : std::min(
                sizes.longest,
                shortest + sizes.growth * (sizes.distance((box.low + box.high) / 2) + radius));
    largest_ = std::clamp(static_cast<int>(std::floor(std::log2(longest / shortest) + kRounding)),
                          0, kBits - 3);
    top_ = std::max(largest_, kSmallestAsked);
    while (top_ < kBits - 2 && 2 * reach.maxCoeff() > 4 * std::ldexp(1.0, top_)) {
        ++top_;
    }
    const double side = std::ldexp(1.0, top_);
    const Eigen::Vector4d first = ((middle - reach).array() / side - kRounding).floor();
    const Eigen::Vector4d last = ((middle + reach).array() / side + kRounding).floor();
    const Eigen::Vector4d count = (last - first).array() + 1;
    if (!(side * count.maxCoeff() < std::ldexp(1.0, kBits)
          && side * first.cwiseAbs().maxCoeff() < kFarthestPoint)) {
        const Eigen::Vector4d size = box.high - box.low;
        throw Error(
            formatted("edges of %g m are too short for a body within %g x %g x %g x %g m^4 around "
                      "(%g, %g, %g, %g); expected longer ones",
                      lattice_.mean_edge(), size[0], size[1], size[2], size[3],
                      (box.low[0] + box.high[0]) / 2, (box.low[1] + box.high[1]) / 2,
                      (box.low[2] + box.high[2]) / 2, (box.low[3] + box.high[3]) / 2));
    }
    low_ = (side * first).cast<int>();
    count_ = count.cast<int>();
}

// Calls leaf(node) for cells that are not split, in the order of their keys, and split(node,
// center, radius) for those that could be.
template <typename Split, typename Leaf>
void LatticeTree::descend(const Solid& solid,
                          const Node& node,
                          const Split& split,
                          const Leaf& leaf) const {
    const double side = std::ldexp(1.0, node.size);
    const Eigen::Vector4d center =
        lattice_.place((low_ + node.corner).cast<double>().array() + side / 2);
    // From the middle to the farthest corners, which are those with two coordinates of either sign.
    const double radius = (1 + kRounding) * side * lattice_.spacing;
    bool is_inside = node.is_inside;
    if (!is_inside && node.size >= kSmallestAsked) {
        const Box4& box = solid.bounds();
        if (((center.array() + radius) < box.low.array()).any()
            || ((center.array() - radius) > box.high.array()).any()) {
            return;
        }
        const ValueRange range = solid.values_within(center, radius);
        if (range.low > 0) {
            return;
        }
        is_inside = range.high < 0;
    }
    if (node.size == 0 || !split(node, center, radius)) {
        leaf(Node{node.corner, node.size, is_inside});
        return;
    }
    for (unsigned child = 0; child < kCorners; ++child) {
        // The key has the first axis in the highest bit.
        const unsigned axes =
            (child & 1U) << 3 | (child & 2U) << 1 | (child & 4U) >> 1 | child >> 3;
        descend(solid,
                {node.corner + (1 << (node.size - 1)) * unit_steps(axes), node.size - 1, is_inside},
                split, leaf);
    }
}

template <typename Split, typename Leaf>
void LatticeTree::descend(const Solid& solid, const Split& split, const Leaf& leaf) const {
    Eigen::Vector4i z;
    for (z[0] = 0; z[0] < count_[0]; ++z[0]) {
        for (z[1] = 0; z[1] < count_[1]; ++z[1]) {
            for (z[2] = 0; z[2] < count_[2]; ++z[2]) {
                for (z[3] = 0; z[3] < count_[3]; ++z[3]) {
                    descend(solid, {(1 << top_) * z, top_, false}, split, leaf);
                }
            }
        }
    }
}

void LatticeTree::choose_cells(const Solid& solid, const SizeField& sizes) {
    const double shortest = lattice_.mean_edge();
    if (largest_ > 0) {
        split_.resize(static_cast<std::size_t>(largest_) + 1);
        descend(
            solid,
            [&](const Node& node, const Eigen::Vector4d& center, double radius) {
                const bool is_too_large =
                    std::ldexp(shortest, node.size)
                    > (1 + kRounding) * sizes.edge_within(shortest, center, radius);
                if (is_too_large && node.size <= largest_) {
                    split_[node.size].insert(key_of(node.corner));
                }
                return is_too_large || node.size > largest_;
            },
            [](const Node&) {});
        balance();
    }
    descend(
        solid,
        [&](const Node& node, const Eigen::Vector4d&, double) {
            return node.size > largest_ || split_[node.size].count(key_of(node.corner)) > 0;
        },
        [&](const Node& node) {
            if (cells_.size() >= kMaxCells) {
                throw Error(
                    formatted("edges of %g m give more than 1.6e9 pentachora; expected longer ones",
                              lattice_.mean_edge()));
            }
            cells_.push_back(
                {key_of(node.corner), static_cast<std::uint8_t>(node.size), node.is_inside});
        });
}

// All that touches a cell that is split is as small as it was, at most: the cells around have
// parents that are split.
void LatticeTree::balance() {
    for (int size = 1; size < largest_; ++size) {
        for (const std::uint64_t key : split_[size]) {
            const Eigen::Vector4i corner = point_of(key);
            for (unsigned neighbor = 0; neighbor < kPlaces; ++neighbor) {
                const Eigen::Vector4i there =
                    corner.array() + (1 << size) * (digits(neighbor).array() - 1);
                if (is_in_range(there)) {
                    const int parent = 2 << size;
                    split_[size + 1].insert(key_of(there / parent * parent));
                }
            }
        }
    }
}

// The middles of edges that lie in cells that are split; none in those of the smallest cells.
std::bitset<LatticeTree::kPlaces> LatticeTree::middles_of(const Cell& cell) const {
    static const std::array<std::bitset<81>, 81> shared = shared_middles();
    std::bitset<kPlaces> middles;
    if (cell.size == 0 || split_.empty()) {
        return middles;
    }
    const Eigen::Vector4i corner = point_of(cell.key);
    for (unsigned neighbor = 0; neighbor < kPlaces; ++neighbor) {
        const Eigen::Vector4i there =
            corner.array() + (1 << cell.size) * (digits(neighbor).array() - 1);
        if (is_in_range(there) && split_[cell.size].count(key_of(there)) > 0) {
            middles |= shared[neighbor];
        }
    }
    return middles;
}

void LatticeTree::number_points(const std::vector<std::bitset<kPlaces>>& middles) {
    const auto corner_key = [&](const Cell& cell, unsigned step) {
        return key_of(point_of(cell.key) + (1 << cell.size) * unit_steps(step));
    };
    const auto middle_key = [&](const Cell& cell, unsigned place) {
        return key_of(point_of(cell.key) + (1 << (cell.size - 1)) * digits(place));
    };
    // By tasks, sorted, before all are: a point is in 16 cells.
    const std::uint32_t tasks = (cell_count() + kTask - 1) / kTask;
    std::vector<std::vector<std::uint64_t>> found(tasks);
    parallel_for(tasks, 1U, [&](std::uint32_t task) {
        std::vector<std::uint64_t>& keys = found[task];
        for (std::uint32_t i = task * kTask; i < std::min((task + 1) * kTask, cell_count()); ++i) {
            for (unsigned step = 0; step < kCorners; ++step) {
                keys.push_back(corner_key(cells_[i], step));
            }
            for (unsigned place = 0; halved_[i] != kNone && place < kPlaces; ++place) {
                if (middles[halved_[i]][place]) {
                    keys.push_back(middle_key(cells_[i], place));
                }
            }
        }
        std::sort(keys.begin(), keys.end());
        keys.erase(std::unique(keys.begin(), keys.end()), keys.end());
    });
    for (std::vector<std::uint64_t>& keys : found) {
        keys_.insert(keys_.end(), keys.begin(), keys.end());
        keys = {};
    }
    std::sort(keys_.begin(), keys_.end());
    keys_.erase(std::unique(keys_.begin(), keys_.end()), keys_.end());
    keys_.shrink_to_fit();

    const auto number_of = [&](std::uint64_t key) {
        return static_cast<std::uint32_t>(std::lower_bound(keys_.begin(), keys_.end(), key)
                                          - keys_.begin());
    };
    corners_.resize(cells_.size());
    places_.resize(middles.size());
    parallel_for(cell_count(), kTask, [&](std::uint32_t i) {
        for (unsigned step = 0; step < kCorners; ++step) {
            corners_[i][step] = number_of(corner_key(cells_[i], step));
        }
        if (halved_[i] == kNone) {
            return;
        }
        Places& places = places_[halved_[i]];
        places.fill(kNone);
        for (unsigned place = 0; place < kPlaces; ++place) {
            if (middles[halved_[i]][place]) {
                places[place] = number_of(middle_key(cells_[i], place));
            }
        }
        for (unsigned step = 0; step < kCorners; ++step) {
            places[place_of(2 * unit_steps(step))] = corners_[i][step];
        }
    });
}

void LatticeTree::sample(const Solid& solid) {
    values_.assign(keys_.size(), 0);
    sizes_.assign(keys_.size(), kBits);
    const auto note = [&](std::uint32_t point, const Cell& cell) {
        sizes_[point] = std::min(sizes_[point], cell.size);
        values_[point] = cell.is_inside ? -1 : values_[point];
    };
    for (std::uint32_t i = 0; i < cell_count(); ++i) {
        for (const std::uint32_t point : corners_[i]) {
            note(point, cells_[i]);
        }
        if (halved_[i] != kNone) {
            // A middle is a corner of a cell half as large, whether or not that one is kept.
            const Cell smaller{0, static_cast<std::uint8_t>(cells_[i].size - 1),
                               cells_[i].is_inside};
            for (const std::uint32_t point : places_[halved_[i]]) {
                if (point != kNone) {
                    note(point, smaller);
                }
            }
        }
    }
    parallel_for(point_count(), kTask, [&](std::uint32_t point) {
        if (values_[point] == 0) {
            values_[point] = solid.value(place(point));
        }
    });
    const auto not_a_number = std::find_if(values_.begin(), values_.end(),
                                           [](double value) { return std::isnan(value); });
    if (not_a_number != values_.end()) {
        const Eigen::Vector4d p = place(static_cast<std::uint32_t>(not_a_number - values_.begin()));
        throw Error(
            formatted("the expression is not a number at (%g, %g, %g, %g); expected a function "
                      "that is one everywhere in and around its box",
                      p[0], p[1], p[2], p[3]));
    }
}

// Cells without a point inside have nothing of the body.
void LatticeTree::leave_out_what_is_outside() {
    const auto is_inside = [&](std::uint32_t point) {
        return point != kNone && values_[point] < 0;
    };
    std::uint32_t kept = 0;
    for (std::uint32_t i = 0; i < cell_count(); ++i) {
        bool has_inside = std::any_of(corners_[i].begin(), corners_[i].end(), is_inside);
        if (halved_[i] != kNone) {
            const Places& places = places_[halved_[i]];
            has_inside = has_inside || std::any_of(places.begin(), places.end(), is_inside);
        }
        if (has_inside) {
            cells_[kept] = cells_[i];
            corners_[kept] = corners_[i];
            halved_[kept] = halved_[i];
            ++kept;
        }
    }
    cells_.resize(kept);
    corners_.resize(kept);
    halved_.resize(kept);
}

void LatticeTree::visit_halved(const Places& places,
                               unsigned path,
                               std::vector<std::pair<Simplex, bool>>& simplices) const {
    const auto& own = patterns().places[path];
    unsigned halved = 0;
    for (unsigned edge = 0; edge < 10; ++edge) {
        halved |= places[own[5 + edge]] != kNone ? 1U << edge : 0U;
    }
    for (const PatternTable::Piece& piece : patterns().pieces[halved]) {
        Simplex simplex{};
        bool is_odd = lattice_paths()[path].is_odd;
        for (int i = 0; i < 5; ++i) {
            simplex[i] = places[own[piece[i]]];
            for (int j = i; j > 0 && simplex[j] < simplex[j - 1]; --j) {
                std::swap(simplex[j], simplex[j - 1]);
                is_odd = !is_odd;
            }
        }
        simplices.emplace_back(simplex, is_odd);
    }
}

}  // namespace pent::mesher
