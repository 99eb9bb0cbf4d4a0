#include "lattice_tree.h"

#include "lattice_keys.h"

#include <pent/error.h>
#include <pent/formatted.h>
#include <pent/mesher/halve_simplex.h>
#include <pent/parallel.h>

#include <algorithm>
#include <cmath>
#include <span>
#include <vector>

namespace pent::mesher {

namespace {

constexpr std::uint32_t kTask = 256;  // cells or points
constexpr double kRounding = 1e-9;

// In spacings: more than the rounding of bounds and values, less than anything that shows.
constexpr double kSlack = 1e-6;

// How many of the points evaluated last value_near() is given, to tell the side of the next one.
constexpr std::size_t kRemembered = 32;

// In longest edges: of points further than this from the surface values need not be exact.
constexpr double kEnough = 2;

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
    thin_parts_ = find_thin_parts(solid);
    leave_out_what_is_outside();
}

Eigen::Vector4d LatticeTree::place(std::uint32_t point) const {
    return lattice_.point(low_ + point_of(keys_[point]));
}

void LatticeTree::number_points(const std::vector<std::bitset<kPlaces>>& middles) {
    const auto corner_key = [&](const Cell& cell, unsigned step) {
        return key_of(point_of(cell.key) + (1 << cell.size) * unit_steps(step));
    };
    const auto middle_key = [&](const Cell& cell, unsigned place) {
        return key_of(point_of(cell.key) + (1 << (cell.size - 1)) * digits(place));
    };
    // Each task removes its own duplicates first, as a point is a corner of 16 cells.
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

// Evaluates the function at the points of cells that are not wholly inside. If it changes by no
// more than the distance (is 1-Lipschitz), a point that is farther from the surface than any of its
// edges is long is not evaluated: it gets a lower bound of the magnitude, with the sign, which
// follows from the value at the point evaluated last.
void LatticeTree::sample(const Solid& solid) {
    values_.assign(keys_.size(), -1);
    sizes_.assign(keys_.size(), kKeyBits);
    std::vector<std::uint8_t> is_asked(keys_.size(), 0);
    const auto note = [&](std::uint32_t point, std::uint8_t size, bool is_inside) {
        sizes_[point] = std::min(sizes_[point], size);
        is_asked[point] |= is_inside ? 0 : 1;
    };
    for (std::uint32_t i = 0; i < cell_count(); ++i) {
        for (const std::uint32_t point : corners_[i]) {
            note(point, cells_[i].size, cells_[i].is_inside);
        }
        if (halved_[i] != kNone) {
            // A middle is a corner of a cell half as large, whether or not that one is kept.
            for (const std::uint32_t point : places_[halved_[i]]) {
                if (point != kNone) {
                    note(point, static_cast<std::uint8_t>(cells_[i].size - 1), cells_[i].is_inside);
                }
            }
        }
    }
    const double longest_edge = (1 + kRounding) * std::ldexp(lattice_.longest_edge(), largest_);
    const bool is_lipschitz = solid.is_lipschitz();
    parallel_for((point_count() + kTask - 1) / kTask, 1U, [&](std::uint32_t task) {
        std::vector<Sample> asked;
        for (std::uint32_t point = task * kTask;
             point < std::min((task + 1) * kTask, point_count()); ++point) {
            if (is_asked[point] == 0) {
                continue;
            }
            const Eigen::Vector4d here = place(point);
            const double left =
                asked.empty() ? 0
                              : std::abs(asked.back().value) - (here - asked.back().place).norm();
            if (is_lipschitz && left > longest_edge) {
                values_[point] = std::copysign(left, asked.back().value);
                continue;
            }
            const std::size_t first = asked.size() - std::min(asked.size(), kRemembered);
            values_[point] =
                solid.value_near(here, kEnough * longest_edge, std::span(asked).subspan(first));
            asked.push_back({here, values_[point]});
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
    // What is beyond the bounds would be cut off where the cells end.
    const double slack = kSlack * lattice_.spacing;
    const auto is_beyond = [&](const Eigen::Vector4d& p) {
        return (p - solid.bounds().low).minCoeff() < -slack
               || (solid.bounds().high - p).minCoeff() < -slack;
    };
    for (std::uint32_t point = 0; point < point_count(); ++point) {
        if (values_[point] < -slack && is_beyond(place(point))) {
            const Eigen::Vector4d p = place(point);
            throw Error(
                formatted("the shape reaches beyond its bounds, at (%g, %g, %g, %g): images that "
                          "are near their levels far away are blended there; expected less of "
                          "\"smooth\"",
                          p[0], p[1], p[2], p[3]));
        }
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
