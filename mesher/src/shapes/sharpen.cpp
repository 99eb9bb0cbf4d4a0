#include "surface_mesh.h"
#include "surface_search.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <limits>
#include <set>

namespace pent::mesher {

namespace {

// A point lies on a piece whose function there is within this of zero, in parts of the cells'
// scale: as near as nearest_common_zero() comes. A hundred times as much, or a thousandth of it,
// changes only a few cells.
constexpr double kOnPiece = 1e-6;

// Pieces that meet at less than this angle (its cosine, 14 degrees) are one smooth surface: an edge
// across such a ridge is off it by a sixteenth of its length at the most, 1/2 tan(7 degrees).
constexpr double kSmoothCosine = 0.97;

// How many pieces are tried together for one place. Four fix a point; pieces that turn out to cut
// off what was found are added to them. Six meet at a corner of the 24-cell. In rotated polytopes a
// few percent more edges stay across ridges with fewer, and a few percent less with more.
constexpr int kMaxPieces = 6;

// What a pass mends may make a neighbor cross a ridge, or cross it again: shapes take up to seven
// passes, of which those after the third mend next to nothing.
constexpr int kMaxPasses = 20;

std::vector<int> common(const std::vector<int>& a, const std::vector<int>& b) {
    std::vector<int> both;
    std::set_intersection(a.begin(), a.end(), b.begin(), b.end(), std::back_inserter(both));
    return both;
}

bool includes(const std::vector<int>& all, const std::vector<int>& some) {
    return std::includes(all.begin(), all.end(), some.begin(), some.end());
}

// A place where pieces meet, and all that meet there.
struct Ridge {
    Eigen::Vector4d place;
    std::vector<int> pieces;
};

using Simplex = std::vector<std::uint32_t>;

class Sharpener {
public:
    Sharpener(SurfaceMesh& surface, double least_quality)
        : surface_(surface), least_quality_(least_quality) {}

    std::int64_t run() {
        bool has_mended = true;
        std::set<Simplex> crossing;
        for (std::uint32_t cell = 0; cell < surface_.mesh.cell_count(); ++cell) {
            for (const std::uint32_t left_out : surface_.mesh.cell(cell)) {
                collect(cell, left_out, crossing);
            }
        }
        for (int pass = 0; pass < kMaxPasses && has_mended; ++pass) {
            has_mended = false;
            std::set<Simplex> left;
            std::set<std::uint32_t> touched;
            for (const Simplex& simplex : crossing) {
                if (!crosses(simplex)) {
                    continue;  // something before has mended it
                }
                if (const auto vertex = mend(simplex)) {
                    touched.insert(*vertex);
                    has_mended = true;
                } else {
                    left.insert(simplex);
                }
            }
            for (const std::uint32_t vertex : touched) {
                collect_around(vertex, left);
            }
            crossing = std::move(left);
        }
        return static_cast<std::int64_t>(crossing.size());
    }

private:
    [[nodiscard]] std::vector<int> common_pieces(const Simplex& simplex) const {
        std::vector<int> pieces = surface_.pieces[simplex[0]];
        for (const std::uint32_t vertex : simplex) {
            pieces = common(pieces, surface_.pieces[vertex]);
        }
        return pieces;
    }

    [[nodiscard]] bool crosses(const Simplex& simplex) const {
        return common_pieces(simplex).empty() && !surface_.mesh.star(simplex).empty();
    }

    // Adds the faces of a facet of a cell that cross a ridge though their own faces do not, if it
    // is one of the boundary.
    void collect(std::uint32_t cell, std::uint32_t left_out, std::set<Simplex>& crossing) const {
        std::array<std::uint32_t, 4> facet{};
        const auto& corners = surface_.mesh.cell(cell);
        std::remove_copy(corners.begin(), corners.end(), facet.begin(), left_out);
        std::sort(facet.begin(), facet.end());
        const bool is_inside = std::any_of(facet.begin(), facet.end(), [&](std::uint32_t corner) {
            return surface_.pieces[corner].empty();
        });
        if (is_inside || !common_pieces({facet.begin(), facet.end()}).empty()
            || surface_.mesh.star(facet).size() > 1) {
            return;
        }
        for (unsigned subset = 1; subset < 16; ++subset) {
            Simplex simplex;
            for (int i = 0; i < 4; ++i) {
                if ((subset >> i & 1U) != 0) {
                    simplex.push_back(facet[i]);
                }
            }
            if (common_pieces(simplex).empty() && faces_agree(simplex)) {
                crossing.insert(std::move(simplex));
            }
        }
    }

    void collect_around(std::uint32_t vertex, std::set<Simplex>& crossing) const {
        for (const std::uint32_t cell : surface_.mesh.star(vertex)) {
            for (const std::uint32_t left_out : surface_.mesh.cell(cell)) {
                if (left_out != vertex) {
                    collect(cell, left_out, crossing);
                }
            }
        }
    }

    [[nodiscard]] bool faces_agree(const Simplex& simplex) const {
        for (std::size_t left_out = 0; simplex.size() > 2 && left_out < simplex.size();
             ++left_out) {
            Simplex face = simplex;
            face.erase(face.begin() + static_cast<std::ptrdiff_t>(left_out));
            if (common_pieces(face).empty()) {
                return false;
            }
        }
        return true;
    }

    // The largest of the sizes of the cells at its corners.
    [[nodiscard]] std::uint8_t largest(const Simplex& simplex) const {
        std::uint8_t size = 0;
        for (const std::uint32_t vertex : simplex) {
            size = std::max(size, surface_.sizes[vertex]);
        }
        return size;
    }

    // Where all of some pieces meet near a place. If that is off the surface, as another piece cuts
    // it off there, the search goes on with that one among them.
    [[nodiscard]] std::optional<Ridge> find_ridge(std::vector<int> pieces,
                                                  const Eigen::Vector4d& near,
                                                  double scale) const {
        const double on = kOnPiece * surface_.scale;
        while (static_cast<int>(pieces.size()) <= kMaxPieces) {
            const auto place = nearest_common_zero(*surface_.solid, pieces, near, scale);
            if (!place) {
                return std::nullopt;
            }
            std::vector<int> there = surface_.solid->pieces_near(*place, on);
            if (surface_.solid->is_near_surface(*place, on)) {
                return Ridge{*place, std::move(there)};
            }
            const auto in_the_way = std::find_if(there.begin(), there.end(), [&](int piece) {
                return !std::binary_search(pieces.begin(), pieces.end(), piece);
            });
            if (in_the_way == there.end()) {
                return std::nullopt;
            }
            pieces.insert(std::upper_bound(pieces.begin(), pieces.end(), *in_the_way), *in_the_way);
        }
        return std::nullopt;
    }

    [[nodiscard]] bool is_sharp(const Ridge& ridge) const {
        std::vector<Eigen::Vector4d> normals;
        for (const int piece : ridge.pieces) {
            normals.push_back(piece_normal(*surface_.solid, piece, ridge.place, surface_.scale));
        }
        return std::any_of(normals.begin(), normals.end(), [&](const Eigen::Vector4d& normal) {
            return normal.dot(normals.front()) < kSmoothCosine;
        });
    }

    // The ridge that a simplex crosses: where a piece of each of its faces meet, so that a vertex
    // there has a piece in common with each of them.
    [[nodiscard]] std::optional<Ridge> ridge_across(const Simplex& simplex) const {
        Eigen::Vector4d middle = Eigen::Vector4d::Zero();
        std::vector<int> pieces;
        for (const std::uint32_t vertex : simplex) {
            middle += surface_.mesh.place(vertex) / static_cast<double>(simplex.size());
            Simplex face;
            std::remove_copy(simplex.begin(), simplex.end(), std::back_inserter(face), vertex);
            const std::vector<int> of_face = common_pieces(face);
            if (common(pieces, of_face).empty()) {
                pieces.push_back(of_face.front());
                std::sort(pieces.begin(), pieces.end());
            }
        }
        const std::optional<Ridge> ridge =
            find_ridge(pieces, middle, std::ldexp(surface_.scale, largest(simplex)));
        return ridge && is_sharp(*ridge) ? ridge : std::nullopt;
    }

    // The vertex that moved to the ridge, or is new there; nothing if either leaves cells too flat.
    std::optional<std::uint32_t> mend(const Simplex& simplex) {
        const SurfaceMesh::Attempt* before = last_attempt(simplex);
        if (before != nullptr && before->best <= least_quality_) {
            return std::nullopt;
        }
        const std::optional<Ridge> across = ridge_across(simplex);
        double best = 0;
        std::optional<std::uint32_t> moving;
        Ridge target;
        for (const std::uint32_t vertex : across ? simplex : Simplex()) {
            const auto ridge =
                find_ridge(across->pieces, surface_.mesh.place(vertex), surface_.scale_at(vertex));
            if (ridge && includes(ridge->pieces, surface_.pieces[vertex])) {
                const double quality = surface_.mesh.quality_if_moved(vertex, ridge->place).least;
                if (quality > best) {
                    best = quality;
                    moving = vertex;
                    target = *ridge;
                }
            }
        }
        const double if_split =
            across ? surface_.mesh.quality_if_split(simplex, across->place) : best;
        if (std::max(best, if_split) <= least_quality_) {
            note_attempt(simplex, std::max(best, if_split));
            return std::nullopt;
        }
        if (if_split > best) {
            moving = surface_.mesh.split(simplex, across->place);
            surface_.pieces.push_back(across->pieces);
            surface_.sizes.push_back(largest(simplex));
        } else {
            surface_.mesh.move(*moving, target.place);
            surface_.pieces[*moving] = target.pieces;
        }
        return moving;
    }

    // What mending came to, if nothing around the simplex has changed since.
    [[nodiscard]] const SurfaceMesh::Attempt* last_attempt(const Simplex& simplex) const {
        const auto found = surface_.attempts.find(simplex);
        return found != surface_.attempts.end() && found->second.changes == changes(simplex)
                   ? &found->second
                   : nullptr;
    }

    void note_attempt(const Simplex& simplex, double best) {
        surface_.attempts.insert_or_assign(simplex, SurfaceMesh::Attempt{changes(simplex), best});
    }

    [[nodiscard]] std::vector<std::uint32_t> changes(const Simplex& simplex) const {
        std::vector<std::uint32_t> changes;
        for (const std::uint32_t vertex : simplex) {
            changes.push_back(surface_.mesh.change(vertex));
        }
        return changes;
    }

    SurfaceMesh& surface_;
    double least_quality_;
};

}  // namespace

SurfaceMesh on_surface(const Solid& solid, double scale, StuffedMesh stuffed) {
    SurfaceMesh surface{
        &solid, scale, StarMesh(std::move(stuffed.mesh)), {}, std::move(stuffed.sizes)};
    surface.pieces.resize(stuffed.is_on_surface.size());
    for (std::uint32_t vertex = 0; vertex < stuffed.is_on_surface.size(); ++vertex) {
        if (stuffed.is_on_surface[vertex]) {
            surface.pieces[vertex] =
                solid.pieces_near(surface.mesh.place(vertex), kOnPiece * scale);
        }
    }
    return surface;
}

std::optional<Eigen::Vector4d> slide(const SurfaceMesh& surface,
                                     std::uint32_t vertex,
                                     const Eigen::Vector4d& place) {
    if (surface.pieces[vertex].empty()) {
        return place;
    }
    const auto there = nearest_common_zero(*surface.solid, surface.pieces[vertex], place,
                                           surface.scale_at(vertex));
    // The foot on a piece of a boundary of tetrahedra is a point of one of them.
    const bool is_foot = surface.pieces[vertex].size() == 1 && surface.solid->is_boundary();
    return there && (is_foot || surface.solid->is_near_surface(*there, kOnPiece * surface.scale))
               ? there
               : std::nullopt;
}

std::int64_t sharpen(SurfaceMesh& surface, double least_quality) {
    return Sharpener(surface, least_quality).run();
}

}  // namespace pent::mesher
