#include <pent/mesher/halve_simplex.h>

#include <Eigen/Core>
#include <Eigen/LU>

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <cstdlib>
#include <map>
#include <set>

namespace pent::mesher {

namespace {

constexpr int kMaxCorners = 5;

// Corners and middles of a simplex, by their barycentric coordinates times two: whole numbers.
struct Points {
    int corners = 0;
    std::vector<HalvedCorner> names;  // corners first, then edges by number
    std::vector<int> heights;

    // Of a face of a simplex of the lattice that has these of its corners, numbered along its path.
    Points(const std::vector<int>& levels, int dim) : corners(static_cast<int>(levels.size())) {
        for (int i = 0; i < corners; ++i) {
            names.push_back({static_cast<std::uint8_t>(i), static_cast<std::uint8_t>(i)});
            heights.push_back(0);
        }
        // Heights may be changed by what is linear between corners. Less that, the squared distance
        // of a middle is minus that of half its edge: a step along k axes has k (n + 1 - k), in
        // units of the lattice.
        for (int i = 0; i < corners; ++i) {
            for (int j = i + 1; j < corners; ++j) {
                const int steps = levels[j] - levels[i];
                names.push_back({static_cast<std::uint8_t>(i), static_cast<std::uint8_t>(j)});
                heights.push_back(-steps * (dim + 1 - steps));
            }
        }
    }

    [[nodiscard]] int size() const { return static_cast<int>(names.size()); }

    [[nodiscard]] unsigned kept(unsigned halved) const {
        return ((1U << corners) - 1) | halved << corners;
    }
};

using Rows = std::vector<std::array<int, kMaxCorners>>;

std::array<int, kMaxCorners> coordinates(const HalvedCorner& name) {
    std::array<int, kMaxCorners> row{};
    ++row[name.first];
    ++row[name.second];
    return row;
}

// By expansion along the first row, as dimensions are few; `used` has the columns taken before.
int determinant(const Rows& rows, std::size_t row, unsigned used) {
    if (row == rows.size()) {
        return 1;
    }
    int sum = 0;
    int sign = 1;
    for (std::size_t column = 0; column < rows.size(); ++column) {
        if ((used >> column & 1U) != 0) {
            continue;
        }
        if (rows[row][column] != 0) {
            sum += sign * rows[row][column] * determinant(rows, row + 1, used | 1U << column);
        }
        sign = -sign;
    }
    return sum;
}

int determinant(const Rows& rows) {
    return determinant(rows, 0, 0);
}

// A simplex on points of a halved one, and the points below the hyperplane through it.
struct Candidate {
    std::vector<int> points;
    unsigned own = 0;
    unsigned below = 0;
    int volume = 0;  // signed; 2^corners for the simplex itself
};

// Whether a point lies below the hyperplane over a simplex, where the middle of edge e is lower
// by an amount that is infinitely small, and infinitely larger than that of edge e + 1.
bool is_below(const Points& all, const Candidate& simplex, int point) {
    std::vector<int> parts;  // of the corners of the simplex in the point, times its volume
    int gap = all.heights[point] * simplex.volume;
    for (std::size_t i = 0; i < simplex.points.size(); ++i) {
        Rows rows;
        for (std::size_t j = 0; j < simplex.points.size(); ++j) {
            rows.push_back(coordinates(all.names[i == j ? point : simplex.points[j]]));
        }
        parts.push_back(determinant(rows));
        gap -= parts.back() * all.heights[simplex.points[i]];
    }
    for (int edge = all.corners; gap == 0 && edge < all.size(); ++edge) {
        gap = edge == point ? -simplex.volume : 0;
        for (std::size_t i = 0; i < simplex.points.size(); ++i) {
            gap += simplex.points[i] == edge ? parts[i] : 0;
        }
    }
    assert(gap != 0);
    return (gap < 0) == (simplex.volume > 0);
}

// All simplices on the points that are not flat, in the order of their points.
std::vector<Candidate> candidates(const Points& all) {
    std::vector<Candidate> found;
    for (unsigned own = 0; own < 1U << all.size(); ++own) {
        Candidate simplex;
        Rows rows;
        for (int point = 0; point < all.size(); ++point) {
            if ((own >> point & 1U) != 0) {
                simplex.points.push_back(point);
                rows.push_back(coordinates(all.names[point]));
            }
        }
        if (static_cast<int>(rows.size()) != all.corners) {
            continue;
        }
        simplex.own = own;
        simplex.volume = determinant(rows);
        for (int point = 0; simplex.volume != 0 && point < all.size(); ++point) {
            if ((own >> point & 1U) == 0 && is_below(all, simplex, point)) {
                simplex.below |= 1U << point;
            }
        }
        if (simplex.volume != 0) {
            found.push_back(std::move(simplex));
        }
    }
    return found;
}

std::vector<HalvedPiece> lower_hull(const Points& all,
                                    const std::vector<Candidate>& simplices,
                                    unsigned halved) {
    const unsigned kept = all.kept(halved);
    std::vector<HalvedPiece> pieces;
    for (const Candidate& simplex : simplices) {
        if ((simplex.own & ~kept) != 0 || (simplex.below & kept) != 0) {
            continue;
        }
        HalvedPiece piece;
        for (const int point : simplex.points) {
            piece.push_back(all.names[point]);
        }
        if (simplex.volume < 0) {
            std::swap(piece[0], piece[1]);
        }
        pieces.push_back(std::move(piece));
    }
    return pieces;
}

int volume_of(const HalvedPiece& piece) {
    Rows rows;
    for (const HalvedCorner& corner : piece) {
        rows.push_back(coordinates(corner));
    }
    return determinant(rows);
}

// 1 for a regular simplex, 0 for a flat one, see docs/mesher.md.
double mean_ratio_of(const HalvedPiece& piece) {
    const auto dim = static_cast<int>(piece.size()) - 1;
    const double lean = (1 - 1 / std::sqrt(dim + 1.0)) / dim;
    Eigen::MatrixXd places(dim, dim + 1);
    for (int i = 0; i <= dim; ++i) {
        for (int axis = 0; axis < dim; ++axis) {
            places(axis, i) =
                (piece[i].first > axis ? 1.0 : 0.0) + (piece[i].second > axis ? 1.0 : 0.0);
        }
        places.col(i).array() -= lean * places.col(i).sum();
    }
    double squares = 0;
    for (int i = 0; i <= dim; ++i) {
        for (int j = 0; j < i; ++j) {
            squares += (places.col(i) - places.col(j)).squaredNorm();
        }
    }
    const Eigen::MatrixXd edges = places.rightCols(dim).colwise() - places.col(0);
    // A regular simplex with edges of length 1 has a parallelepiped of sqrt((n + 1) / 2^n).
    const double regular = std::sqrt((dim + 1) / std::pow(2.0, dim));
    const double pairs = dim * (dim + 1) / 2.0;
    return std::pow(std::abs(edges.determinant()) / regular, 2.0 / dim) * pairs / squares;
}

// A facet of a piece by its corners in their order, and the side it is seen from.
struct SeenFacet {
    std::vector<HalvedCorner> corners;
    int sign = 0;
};

SeenFacet facet_without(const HalvedPiece& piece, std::size_t left_out) {
    SeenFacet facet{{}, left_out % 2 == 0 ? 1 : -1};
    for (std::size_t i = 0; i < piece.size(); ++i) {
        if (i != left_out) {
            facet.corners.push_back(piece[i]);
        }
    }
    for (std::size_t i = 1; i < facet.corners.size(); ++i) {
        for (std::size_t j = i; j > 0 && facet.corners[j] < facet.corners[j - 1]; --j) {
            std::swap(facet.corners[j], facet.corners[j - 1]);
            facet.sign = -facet.sign;
        }
    }
    return facet;
}

bool lies_on_side(const std::vector<HalvedCorner>& facet, int opposite) {
    return std::none_of(facet.begin(), facet.end(), [&](const HalvedCorner& corner) {
        return corner.first == opposite || corner.second == opposite;
    });
}

bool do_fill(const std::vector<HalvedPiece>& pieces, int corners) {
    std::map<std::vector<HalvedCorner>, std::vector<int>> signs;
    int volume = 0;
    for (const HalvedPiece& piece : pieces) {
        volume += volume_of(piece);
        for (std::size_t i = 0; i < piece.size(); ++i) {
            const SeenFacet facet = facet_without(piece, i);
            signs[facet.corners].push_back(facet.sign);
        }
    }
    for (const auto& [facet, seen] : signs) {
        bool on_side = false;
        for (int i = 0; i < corners; ++i) {
            on_side = on_side || lies_on_side(facet, i);
        }
        if (!(on_side ? seen.size() == 1 : seen.size() == 2 && seen[0] != seen[1])) {
            return false;
        }
    }
    return volume == 1 << corners;
}

using Facets = std::set<std::vector<HalvedCorner>>;

Facets facets_on_side(const std::vector<HalvedPiece>& pieces, int opposite) {
    Facets facets;
    for (const HalvedPiece& piece : pieces) {
        for (std::size_t i = 0; i < piece.size(); ++i) {
            SeenFacet facet = facet_without(piece, i);
            if (lies_on_side(facet.corners, opposite)) {
                facets.insert(std::move(facet.corners));
            }
        }
    }
    return facets;
}

// The corners of a side named as in the whole, and the edges cut of it.
unsigned halved_of_side(int corners, int opposite, unsigned halved) {
    unsigned own = 0;
    for (int i = 0; i < corners - 1; ++i) {
        for (int j = i + 1; j < corners - 1; ++j) {
            const unsigned edge =
                edge_number(corners, i + (i < opposite ? 0 : 1), j + (j < opposite ? 0 : 1));
            own |= (halved >> edge & 1U) << edge_number(corners - 1, i, j);
        }
    }
    return own;
}

Facets pieces_of_side(const Points& side,
                      const std::vector<Candidate>& simplices,
                      int opposite,
                      unsigned halved) {
    const auto name = [&](std::uint8_t corner) {
        return static_cast<std::uint8_t>(corner + (corner < opposite ? 0 : 1));
    };
    Facets facets;
    for (const HalvedPiece& piece :
         lower_hull(side, simplices, halved_of_side(side.corners + 1, opposite, halved))) {
        std::vector<HalvedCorner> facet;
        for (const HalvedCorner& corner : piece) {
            facet.push_back({name(corner.first), name(corner.second)});
        }
        std::sort(facet.begin(), facet.end());
        facets.insert(std::move(facet));
    }
    return facets;
}

std::vector<int> levels_without(int dim, int left_out) {
    std::vector<int> levels;
    for (int level = 0; level <= dim; ++level) {
        if (level != left_out) {
            levels.push_back(level);
        }
    }
    return levels;
}

}  // namespace

unsigned edge_number(int corners, int from, int to) {
    assert(0 <= from && from < to && to < corners);
    return static_cast<unsigned>(from * (2 * corners - from - 1) / 2 + to - from - 1);
}

std::vector<std::vector<HalvedPiece>> halved_simplices(int dim) {
    const Points all(levels_without(dim, -1), dim);
    const std::vector<Candidate> simplices = candidates(all);
    std::vector<std::vector<HalvedPiece>> patterns;
    for (unsigned halved = 0; halved < 1U << (all.size() - all.corners); ++halved) {
        patterns.push_back(lower_hull(all, simplices, halved));
    }
    return patterns;
}

bool HalvingProof::holds() const {
    return patterns > 0 && positive == pieces && filled == patterns && agreeing == sides;
}

HalvingProof prove_halving(int dim) {
    assert(dim >= 2 && dim < kMaxCorners);
    HalvingProof proof;
    proof.dim = dim;
    const int corners = dim + 1;
    std::vector<Points> sides;
    std::vector<std::vector<Candidate>> of_sides;
    for (int opposite = 0; opposite < corners; ++opposite) {
        sides.emplace_back(levels_without(dim, opposite), dim);
        of_sides.push_back(candidates(sides.back()));
    }
    const std::vector<std::vector<HalvedPiece>> patterns = halved_simplices(dim);
    for (unsigned halved = 0; halved < patterns.size(); ++halved) {
        const std::vector<HalvedPiece>& pieces = patterns[halved];
        ++proof.patterns;
        for (const HalvedPiece& piece : pieces) {
            ++proof.pieces;
            proof.positive += volume_of(piece) > 0 ? 1 : 0;
            proof.least_mean_ratio = std::min(proof.least_mean_ratio, mean_ratio_of(piece));
        }
        proof.filled += do_fill(pieces, corners) ? 1 : 0;
        for (int opposite = 0; opposite < corners; ++opposite) {
            ++proof.sides;
            const bool agrees =
                facets_on_side(pieces, opposite)
                == pieces_of_side(sides[opposite], of_sides[opposite], opposite, halved);
            proof.agreeing += agrees ? 1 : 0;
        }
    }
    return proof;
}

}  // namespace pent::mesher
