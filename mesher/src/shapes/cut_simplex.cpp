#include <pent/mesher/cut_simplex.h>

#include <algorithm>
#include <cassert>
#include <map>
#include <numeric>
#include <set>

namespace pent::mesher {

namespace {

// All monotone paths through a grid from its first to its last place, as lists of (row, column).
using Path = std::vector<std::pair<int, int>>;

void extend_paths(int rows, int columns, Path& path, std::vector<Path>& paths) {
    const auto [row, column] = path.back();
    if (row + 1 == rows && column + 1 == columns) {
        paths.push_back(path);
        return;
    }
    if (row + 1 < rows) {
        path.emplace_back(row + 1, column);
        extend_paths(rows, columns, path, paths);
        path.pop_back();
    }
    if (column + 1 < columns) {
        path.emplace_back(row, column + 1);
        extend_paths(rows, columns, path, paths);
        path.pop_back();
    }
}

std::vector<Path> staircases(int rows, int columns) {
    std::vector<Path> paths;
    Path path = {{0, 0}};
    extend_paths(rows, columns, path, paths);
    return paths;
}

std::vector<std::uint8_t> corners_on(const std::vector<Side>& sides, Side side) {
    std::vector<std::uint8_t> corners;
    for (std::size_t i = 0; i < sides.size(); ++i) {
        if (sides[i] == side) {
            corners.push_back(static_cast<std::uint8_t>(i));
        }
    }
    return corners;
}

// The volume of a piece over that of the simplex is a determinant with, for every corner, one row
// of barycentric coordinates: the entry of a corner of the simplex is 1, the two of a cut are the
// parts of its edge. Its terms, one for each way to take an entry of every row from different
// columns:
struct Expansion {
    int terms = 0;
    int sign = 0;  // of the last term; all entries are positive
};

void expand(const CutPiece& piece, std::vector<int>& columns, Expansion& expansion) {
    const std::size_t row = columns.size();
    if (row == piece.size()) {
        int inversions = 0;
        for (std::size_t i = 0; i < row; ++i) {
            for (std::size_t j = i + 1; j < row; ++j) {
                inversions += columns[i] > columns[j] ? 1 : 0;
            }
        }
        ++expansion.terms;
        expansion.sign = inversions % 2 == 0 ? 1 : -1;
        return;
    }
    for (const int column : std::set<int>{piece[row].inside, piece[row].outside}) {
        if (std::find(columns.begin(), columns.end(), column) == columns.end()) {
            columns.push_back(column);
            expand(piece, columns, expansion);
            columns.pop_back();
        }
    }
}

Expansion expand(const CutPiece& piece) {
    std::vector<int> columns;
    Expansion expansion;
    expand(piece, columns, expansion);
    return expansion;
}

bool is_cut(const CutCorner& corner) {
    return corner.inside != corner.outside;
}

// 2^dim times the volume of a positive piece over that of the simplex, if all cuts are in the
// middle.
std::int64_t scaled_volume(const CutPiece& piece) {
    const auto cuts = std::count_if(piece.begin(), piece.end(), is_cut);
    return std::int64_t{1} << (static_cast<std::int64_t>(piece.size()) - 1 - cuts);
}

// The same of the whole part inside: where the barycentric coordinates of the corners inside have a
// larger sum than those outside. Corners on the surface do not matter. Uniform barycentric
// coordinates are exponential variables over their sum; that k of k + m of these have the larger
// sum is as probable as that fewer than k of k + m - 1 coins show heads.
std::int64_t scaled_volume_inside(int dim, int inside, int outside) {
    const int coins = inside + outside - 1;
    std::int64_t sum = 0;
    std::int64_t binomial = 1;
    for (int heads = 0; heads < inside; ++heads) {
        sum += binomial;
        binomial = binomial * (coins - heads) / (heads + 1);
    }
    return sum << (dim - coins);
}

// A facet of a piece by its corners in their order, and the side it is seen from.
using Facet = std::vector<std::pair<int, int>>;

struct SeenFacet {
    Facet corners;
    int sign = 0;
};

SeenFacet facet_without(const CutPiece& piece, std::size_t left_out) {
    SeenFacet facet{{}, left_out % 2 == 0 ? 1 : -1};
    for (std::size_t i = 0; i < piece.size(); ++i) {
        if (i != left_out) {
            facet.corners.emplace_back(piece[i].inside, piece[i].outside);
        }
    }
    // Sorted by exchanges, each of which turns the facet over.
    for (std::size_t i = 1; i < facet.corners.size(); ++i) {
        for (std::size_t j = i; j > 0 && facet.corners[j] < facet.corners[j - 1]; --j) {
            std::swap(facet.corners[j], facet.corners[j - 1]);
            facet.sign = -facet.sign;
        }
    }
    return facet;
}

bool lies_on_side(const Facet& facet, int opposite) {
    return std::none_of(facet.begin(), facet.end(), [&](const auto& corner) {
        return corner.first == opposite || corner.second == opposite;
    });
}

bool lies_on_boundary(const Facet& facet, const std::vector<Side>& sides) {
    const bool on_surface = std::none_of(facet.begin(), facet.end(), [&](const auto& corner) {
        return corner.first == corner.second && sides[corner.first] == Side::Inside;
    });
    bool on_side = false;
    for (std::size_t i = 0; i < sides.size(); ++i) {
        on_side = on_side || lies_on_side(facet, static_cast<int>(i));
    }
    return on_surface || on_side;
}

bool do_fill(const std::vector<CutPiece>& pieces, const std::vector<Side>& sides) {
    std::map<Facet, std::vector<int>> signs;
    std::int64_t volume = 0;
    for (const CutPiece& piece : pieces) {
        volume += scaled_volume(piece);
        for (std::size_t i = 0; i < piece.size(); ++i) {
            const SeenFacet facet = facet_without(piece, i);
            signs[facet.corners].push_back(facet.sign);
        }
    }
    for (const auto& [facet, seen] : signs) {
        const bool is_matched = lies_on_boundary(facet, sides)
                                    ? seen.size() == 1
                                    : seen.size() == 2 && seen[0] != seen[1];
        if (!is_matched) {
            return false;
        }
    }
    const auto inside = static_cast<int>(std::count(sides.begin(), sides.end(), Side::Inside));
    const auto outside = static_cast<int>(std::count(sides.begin(), sides.end(), Side::Outside));
    return volume == scaled_volume_inside(static_cast<int>(sides.size()) - 1, inside, outside);
}

// The facets of the pieces on the side opposite to a corner.
std::set<Facet> facets_on_side(const std::vector<CutPiece>& pieces, int opposite) {
    std::set<Facet> facets;
    for (const CutPiece& piece : pieces) {
        for (std::size_t i = 0; i < piece.size(); ++i) {
            const Facet facet = facet_without(piece, i).corners;
            if (lies_on_side(facet, opposite)) {
                facets.insert(facet);
            }
        }
    }
    return facets;
}

// The pieces of that side as a simplex of its own, with the corners named as in the whole.
std::set<Facet> pieces_of_side(std::vector<Side> sides, int opposite) {
    sides.erase(sides.begin() + opposite);
    const auto name = [&](std::uint8_t corner) { return corner < opposite ? corner : corner + 1; };
    std::set<Facet> facets;
    for (const CutPiece& piece : cut_simplex(sides)) {
        Facet facet;
        for (const CutCorner& corner : piece) {
            facet.emplace_back(name(corner.inside), name(corner.outside));
        }
        std::sort(facet.begin(), facet.end());
        facets.insert(facet);
    }
    return facets;
}

void count_pattern(const std::vector<Side>& sides, StuffingProof& proof) {
    const std::vector<CutPiece> pieces = cut_simplex(sides);
    ++proof.patterns;
    for (const CutPiece& piece : pieces) {
        const Expansion expansion = expand(piece);
        ++proof.pieces;
        proof.positive += expansion.terms == 1 && expansion.sign == 1 ? 1 : 0;
    }
    proof.filled += do_fill(pieces, sides) ? 1 : 0;
    for (int opposite = 0; opposite <= proof.dim; ++opposite) {
        const std::set<Facet> own = pieces_of_side(sides, opposite);
        if (!own.empty()) {
            ++proof.sides;
            proof.agreeing += facets_on_side(pieces, opposite) == own ? 1 : 0;
        }
    }
}

}  // namespace

std::vector<CutPiece> cut_simplex(const std::vector<Side>& sides) {
    const std::vector<std::uint8_t> inside = corners_on(sides, Side::Inside);
    const std::vector<std::uint8_t> outside = corners_on(sides, Side::Outside);
    std::vector<CutPiece> pieces;
    if (inside.empty()) {
        return pieces;
    }
    for (const Path& path :
         staircases(static_cast<int>(inside.size()), static_cast<int>(outside.size()) + 1)) {
        CutPiece piece;
        for (const auto& [row, column] : path) {
            piece.push_back({inside[row], column == 0 ? inside[row] : outside[column - 1]});
        }
        for (const std::uint8_t corner : corners_on(sides, Side::On)) {
            piece.push_back({corner, corner});
        }
        if (expand(piece).sign < 0) {
            std::swap(piece[0], piece[1]);
        }
        pieces.push_back(std::move(piece));
    }
    return pieces;
}

bool StuffingProof::holds() const {
    return patterns > 0 && positive == pieces && filled == patterns && agreeing == sides;
}

StuffingProof prove_stuffing(int dim) {
    assert(dim >= 1 && dim <= 5);
    StuffingProof proof;
    proof.dim = dim;
    std::vector<Side> sides(dim + 1, Side::Inside);
    int patterns = 3;
    for (int i = 0; i < dim; ++i) {
        patterns *= 3;
    }
    for (int pattern = 0; pattern < patterns; ++pattern) {
        int code = pattern;
        for (Side& side : sides) {
            side = static_cast<Side>(code % 3 - 1);
            code /= 3;
        }
        if (std::find(sides.begin(), sides.end(), Side::Inside) != sides.end()) {
            count_pattern(sides, proof);
        }
    }
    return proof;
}

}  // namespace pent::mesher
