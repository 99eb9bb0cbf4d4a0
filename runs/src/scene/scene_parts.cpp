#include "scene/scene_parts.h"

#include "scene/scene_meshes.h"

#include <pent/crc32c.h>
#include <pent/error.h>
#include <pent/facets.h>
#include <pent/simulator/mesh_parts.h>
#include <pent/simulator/placed_mesh.h>

#include <algorithm>
#include <span>
#include <utility>

namespace pent::runs {

namespace {

// Cells that are read by all ranks together at a time.
constexpr Eigen::Index kPiece = Eigen::Index{1} << 18;

// What ranks must have alike of a file.
std::uint32_t checksum(const FileInfo& info, std::uint32_t before) {
    const std::uint64_t numbers[] = {info.vertices, info.cells, info.crc32c,
                                     info.is_extrusion ? 1U : 0U};
    return crc32c(numbers, sizeof numbers, before);
}

// Whose vertices are whose, of one body.
struct Owners {
    std::span<const std::uint32_t> of_vertices;
    std::uint32_t own = 0;  // this rank
};

template <int Dim>
MeshPart<Dim> extruded_part(const MeshSource<Dim>& source,
                            const std::vector<std::uint32_t>& columns,
                            const Owners& owners) {
    std::vector<bool> is_wanted(std::size_t{*std::max_element(columns.begin(), columns.end())} + 1,
                                false);
    for (std::size_t vertex = 0; vertex < columns.size(); ++vertex) {
        if (owners.of_vertices[vertex] == owners.own) {
            is_wanted[columns[vertex]] = true;
        }
    }
    return source.cells_over(is_wanted);
}

// A vertex that there is not is near: validation will say so.
template <int Dim>
bool is_near(const Simplices<Dim + 1>& cells, Eigen::Index cell, const Owners& owners) {
    const auto corners = cells.col(cell);
    return std::any_of(corners.begin(), corners.end(), [&](std::uint32_t vertex) {
        return vertex >= owners.of_vertices.size() || owners.of_vertices[vertex] == owners.own;
    });
}

// Cells [first, last) with their labels, if there are any and they are wanted; of them each rank
// reads a slab.
template <int Dim>
SimplexMesh<Dim> piece_of(const MeshSource<Dim>& source,
                          Eigen::Index first,
                          Eigen::Index last,
                          bool has_labels,
                          const RunRanks& ranks) {
    const auto own_cells = ranks.slab_of(last - first);
    std::vector<double> own;
    std::vector<double> own_labels;
    ranks.agree([&] {
        const SimplexMesh<Dim> slab =
            source.cells(first + own_cells.first, first + own_cells.second);
        own.assign(slab.cells.data(), slab.cells.data() + slab.cells.size());
        own_labels.assign(slab.regions.begin(), slab.regions.end());
    });
    const std::vector<double> all = ranks.gather(own);
    SimplexMesh<Dim> piece;
    piece.cells = Eigen::Map<const Eigen::Matrix<double, Dim + 1, Eigen::Dynamic>>(
                      all.data(), Dim + 1, last - first)
                      .template cast<std::uint32_t>();
    for (const double label : has_labels ? ranks.gather(own_labels) : std::vector<double>()) {
        piece.regions.push_back(static_cast<std::uint16_t>(label));
    }
    return piece;
}

template <int Dim>
MeshPart<Dim> read_part(const MeshSource<Dim>& source,
                        bool has_labels,
                        const Owners& owners,
                        const RunRanks& ranks) {
    MeshPart<Dim> part;
    part.cell_count = static_cast<Eigen::Index>(source.info().cells);
    std::vector<std::uint32_t> corners;
    for (Eigen::Index first = 0; first < part.cell_count; first += kPiece) {
        const Eigen::Index last = std::min(first + kPiece, part.cell_count);
        const SimplexMesh<Dim> piece = piece_of(source, first, last, has_labels, ranks);
        for (Eigen::Index cell = 0; cell < piece.cell_count(); ++cell) {
            if (!is_near<Dim>(piece.cells, cell, owners)) {
                continue;
            }
            const auto own = piece.cells.col(cell);
            part.numbers.push_back(static_cast<std::uint32_t>(first + cell));
            corners.insert(corners.end(), own.begin(), own.end());
            if (!piece.regions.empty()) {
                part.mesh.regions.push_back(piece.regions[static_cast<std::size_t>(cell)]);
            }
        }
    }
    part.numbers.shrink_to_fit();
    part.mesh.cells = Eigen::Map<const Simplices<Dim + 1>>(
        corners.data(), Dim + 1, static_cast<Eigen::Index>(part.numbers.size()));
    return part;
}

template <int Dim>
class PartReader {
public:
    PartReader(const Scene& scene, const RunRanks& ranks) : scene_(scene), ranks_(ranks) {}

    std::optional<SceneParts<Dim>> operator()() {
        if (!can_read()) {
            return std::nullopt;
        }
        read_vertices();
        read_cells();
        const bool is_misfit =
            std::any_of(result_.parts.begin(), result_.parts.end(), [](const auto& part) {
                return !match_facets<Dim>(part.mesh.cells, part.mesh.vertex_count())
                            .is_conforming();
            });
        if (ranks_.any(is_misfit)) {
            return std::nullopt;
        }
        return std::move(result_);
    }

private:
    [[nodiscard]] bool can_read() const {
        if (ranks_.count() == 0 || !can_take_parts(scene_)) {
            return false;
        }
        bool can = true;
        std::uint32_t sum = 0;
        ranks_.agree([&] {
            for (const Body& body : scene_.bodies) {
                const FileInfo info = info_of_mesh<Dim>(body);
                can = can && MeshSource<Dim>::can_read(info);
                sum = checksum(info, sum);
            }
        });
        ranks_.refuse_others(sum, "other meshes", "let all of them read the same files");
        return !ranks_.any(!can);
    }

    void read_vertices() {
        for (const Body& body : scene_.bodies) {
            ranks_.agree([&] {
                with_place_of(body, [&] {
                    result_.sources.emplace_back(body.mesh, ranks_.count());
                    meshes_.push_back(result_.sources.back().vertices());
                });
                check_size(meshes_.back(), body);
            });
            if (!result_.sources.back().is_extrusion()) {
                with_place_of(body, [&] { check_checksum(body.mesh, ranks_.writers()); });
            }
        }
        ranks_.agree([&] { owners_ = share_vertices(scene_, meshes_, ranks_.count()); });
    }

    void read_cells() {
        std::size_t first = 0;
        for (std::size_t i = 0; i < meshes_.size(); ++i) {
            const auto count = static_cast<std::size_t>(meshes_[i].vertex_count());
            const Owners owners = {std::span<const std::uint32_t>(owners_).subspan(first, count),
                                   static_cast<std::uint32_t>(ranks_.place())};
            const MeshSource<Dim>& source = result_.sources[i];
            const bool has_labels = are_labels_asked_for(scene_, scene_.bodies[i]);
            MeshPart<Dim> part = source.is_extrusion()
                                     ? extruded_part(source, meshes_[i].columns, owners)
                                     : read_part(source, has_labels, owners, ranks_);
            if (!has_labels) {
                part.mesh.regions.clear();
            }
            part.mesh.positions = std::move(meshes_[i].positions);
            part.mesh.columns = std::move(meshes_[i].columns);
            part.mesh.layers = std::move(meshes_[i].layers);
            ranks_.agree([&] {
                with_place_of(scene_.bodies[i], [&] {
                    validate_part<Dim>(part.mesh, scene_.bodies[i].mesh, part.numbers);
                });
                if (!has_labels) {  // else the simulation does, as all have to look together
                    check_constraints(scene_, scene_.bodies[i], part.mesh);
                }
            });
            result_.parts.push_back(std::move(part));
            first += count;
        }
    }

    const Scene& scene_;
    const RunRanks& ranks_;
    std::vector<SimplexMesh<Dim>> meshes_;  // vertices alone, until they are in parts
    std::vector<std::uint32_t> owners_;
    SceneParts<Dim> result_;
};

}  // namespace

template <int Dim>
std::optional<SceneParts<Dim>> read_parts(const Scene& scene, const RunRanks& ranks) {
    return PartReader<Dim>(scene, ranks)();
}

template std::optional<SceneParts<3>> read_parts<3>(const Scene&, const RunRanks&);
template std::optional<SceneParts<4>> read_parts<4>(const Scene&, const RunRanks&);

}  // namespace pent::runs
