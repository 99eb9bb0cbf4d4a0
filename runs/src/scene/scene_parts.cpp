#include "scene/scene_parts.h"

#include "scene/scene_meshes.h"

#include <pent/crc32c.h>
#include <pent/error.h>
#include <pent/mesh_extras.h>
#include <pent/simulator/mesh_parts.h>
#include <pent/simulator/placed_mesh.h>
#include <pent/validate_parts.h>

#include <algorithm>
#include <limits>
#include <numeric>
#include <span>
#include <utility>

namespace pent::runs {

namespace {

using simulator::NeededCells;

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

    // A vertex that there is not is of this rank: validation will say so.
    [[nodiscard]] bool has(std::uint32_t vertex) const {
        return vertex >= of_vertices.size() || of_vertices[vertex] == own;
    }
};

// What is read of cells beside their corners.
struct Wanted {
    bool labels = false;
    bool parents = false;
    bool fibers = false;
};

template <int Dim>
Wanted wanted_of(const Scene& scene, const Body& body, const MeshSource<Dim>& source) {
    const SimplexMesh<Dim> one = source.cells(0, 1);
    return {.labels = are_labels_asked_for(scene, body) && !one.regions.empty(),
            .parents = scene.solver.elements == ElementKind::Quadratic && !one.parents.empty(),
            .fibers = are_fibers_asked_for(scene, body) && one.fibers.cols() > 0};
}

// What is wanted of cells, a column of numbers each.
template <int Dim>
Eigen::MatrixXd packed(const SimplexMesh<Dim>& cells, const Wanted& wanted) {
    const int rows =
        Dim + 1 + (wanted.labels ? 1 : 0) + (wanted.parents ? 1 : 0) + (wanted.fibers ? Dim : 0);
    Eigen::MatrixXd all(rows, cells.cell_count());
    for (Eigen::Index cell = 0; cell < cells.cell_count(); ++cell) {
        const auto place = static_cast<std::size_t>(cell);
        int row = Dim + 1;
        all.col(cell).template head<Dim + 1>() = cells.cells.col(cell).template cast<double>();
        if (wanted.labels) {
            all(row++, cell) = cells.regions[place];
        }
        if (wanted.parents) {
            all(row++, cell) = cells.parents[place];
        }
        if (wanted.fibers) {
            all.col(cell).template segment<Dim>(row) = cells.fibers.col(cell);
        }
    }
    return all;
}

template <int Dim>
SimplexMesh<Dim> unpacked(const Eigen::Ref<const Eigen::MatrixXd>& all, const Wanted& wanted) {
    SimplexMesh<Dim> cells;
    cells.cells = all.template topRows<Dim + 1>().template cast<std::uint32_t>();
    for (Eigen::Index cell = 0; cell < all.cols(); ++cell) {
        int row = Dim + 1;
        if (wanted.labels) {
            cells.regions.push_back(static_cast<std::uint16_t>(all(row++, cell)));
        }
        if (wanted.parents) {
            cells.parents.push_back(static_cast<std::uint32_t>(all(row, cell)));
        }
    }
    if (wanted.fibers) {
        cells.fibers = all.template bottomRows<Dim>();
    }
    return cells;
}

// Calls visit(cells, number of the first) for pieces of all cells. Every rank sees each of them,
// and reads a slab of it.
template <int Dim, typename Visit>
void for_each_piece(const MeshSource<Dim>& source,
                    const Wanted& wanted,
                    const RunRanks& ranks,
                    const Visit& visit) {
    const auto count = static_cast<Eigen::Index>(source.info().cells);
    for (Eigen::Index first = 0; first < count; first += kPiece) {
        const Eigen::Index last = std::min(first + kPiece, count);
        const auto slab = ranks.slab_of(last - first);
        std::vector<double> own;
        ranks.agree([&] {
            const Eigen::MatrixXd rows =
                packed(source.cells(first + slab.first, first + slab.second), wanted);
            own.assign(rows.data(), rows.data() + rows.size());
        });
        const std::vector<double> all = ranks.gather(own);
        const auto rows = static_cast<Eigen::Index>(all.size()) / (last - first);
        visit(unpacked<Dim>(Eigen::Map<const Eigen::MatrixXd>(all.data(), rows, last - first),
                            wanted),
              first);
    }
}

// Calls visit(corners, parent, place) for the cells of a piece, where `first` are in front of it.
template <int Dim, typename Visit>
void for_each_cell(const SimplexMesh<Dim>& piece, Eigen::Index first, const Visit& visit) {
    constexpr Eigen::Index kChildren = Eigen::Index{1} << Dim;
    for (Eigen::Index cell = 0; cell < piece.cell_count(); ++cell) {
        const auto place = static_cast<std::size_t>(cell);
        const auto parent = piece.parents.empty()
                                ? static_cast<std::uint32_t>((first + cell) / kChildren)
                                : piece.parents[place];
        visit(std::span<const std::uint32_t>(piece.cells.col(cell).data(), Dim + 1), parent, place);
    }
}

// The cells of a part that are needed, with what is wanted of them.
template <int Dim>
MeshPart<Dim> needed_of(const MeshPart<Dim>& part,
                        const NeededCells& needed,
                        const Wanted& wanted) {
    MeshPart<Dim> own;
    own.cell_count = part.cell_count;
    std::vector<Eigen::Index> kept;
    for_each_cell<Dim>(part.mesh, 0,
                       [&](const auto& corners, std::uint32_t parent, std::size_t place) {
                           if (!needed.has(corners, parent)) {
                               return;
                           }
                           kept.push_back(static_cast<Eigen::Index>(place));
                           own.numbers.push_back(part.numbers[place]);
                           if (wanted.labels) {
                               own.mesh.regions.push_back(part.mesh.regions[place]);
                           }
                       });
    own.mesh.cells = part.mesh.cells(Eigen::all, kept);
    return own;
}

// Cells over base cells with a vertex whose column has one of these.
template <int Dim, typename IsWanted>
MeshPart<Dim> cells_over(const MeshSource<Dim>& source,
                         const std::vector<std::uint32_t>& columns,
                         const IsWanted& is_wanted) {
    std::vector<bool> marks(std::size_t{*std::max_element(columns.begin(), columns.end())} + 1,
                            false);
    for (std::uint32_t vertex = 0; vertex < columns.size(); ++vertex) {
        if (is_wanted(vertex)) {
            marks[columns[vertex]] = true;
        }
    }
    return source.cells_over(marks);
}

// Base cells at the columns of this rank, and where elements reach farther those around them.
template <int Dim>
MeshPart<Dim> extruded_part(const MeshSource<Dim>& source,
                            const Wanted& wanted,
                            NeededCells needed,
                            const std::vector<std::uint32_t>& columns,
                            const Owners& owners) {
    MeshPart<Dim> part =
        cells_over(source, columns, [&](std::uint32_t vertex) { return owners.has(vertex); });
    if (needed.has_to_see_all()) {
        std::vector<bool> is_near(columns.size(), false);
        for_each_cell<Dim>(part.mesh, 0,
                           [&](const auto& corners, std::uint32_t parent, std::size_t /*place*/) {
                               needed.see(corners, parent);
                               for (const std::uint32_t vertex : corners) {
                                   is_near[vertex] = true;
                               }
                           });
        part = cells_over(source, columns, [&](std::uint32_t vertex) { return is_near[vertex]; });
    }
    return needed_of(part, needed, wanted);
}

template <int Dim>
MeshPart<Dim> read_part(const MeshSource<Dim>& source,
                        const Wanted& wanted,
                        NeededCells needed,
                        const RunRanks& ranks) {
    if (needed.has_to_see_all()) {
        for_each_piece(source, wanted, ranks, [&](const auto& piece, Eigen::Index first) {
            for_each_cell<Dim>(piece, first,
                               [&](const auto& corners, std::uint32_t parent,
                                   std::size_t /*place*/) { needed.see(corners, parent); });
        });
    }
    MeshPart<Dim> part;
    part.cell_count = static_cast<Eigen::Index>(source.info().cells);
    std::vector<std::uint32_t> all;
    std::vector<double> fibers;
    for_each_piece(source, wanted, ranks, [&](const auto& piece, Eigen::Index first) {
        for_each_cell<Dim>(
            piece, first, [&](const auto& corners, std::uint32_t parent, std::size_t place) {
                if (!needed.has(corners, parent)) {
                    return;
                }
                part.numbers.push_back(static_cast<std::uint32_t>(first)
                                       + static_cast<std::uint32_t>(place));
                all.insert(all.end(), corners.begin(), corners.end());
                if (wanted.labels) {
                    part.mesh.regions.push_back(piece.regions[place]);
                }
                if (wanted.parents) {
                    part.mesh.parents.push_back(parent);
                }
                if (wanted.fibers) {
                    const auto fiber = piece.fibers.col(static_cast<Eigen::Index>(place));
                    fibers.insert(fibers.end(), fiber.begin(), fiber.end());
                }
            });
    });
    part.numbers.shrink_to_fit();
    part.mesh.cells = Eigen::Map<const Simplices<Dim + 1>>(
        all.data(), Dim + 1, static_cast<Eigen::Index>(part.numbers.size()));
    part.mesh.fibers = Eigen::Map<const Positions<Dim>>(
        fibers.data(), Dim, static_cast<Eigen::Index>(fibers.size() / Dim));
    return part;
}

template <int Dim>
class PartReader {
public:
    PartReader(const Scene& scene, const RunRanks& ranks) : scene_(scene), ranks_(ranks) {}

    SceneParts<Dim> operator()() {
        check_infos();
        read_vertices();
        read_cells();
        return std::move(result_);
    }

private:
    void check_infos() const {
        std::uint32_t sum = 0;
        ranks_.agree([&] {
            for (const Body& body : scene_.bodies) {
                sum = checksum(info_of_mesh<Dim>(body), sum);
            }
        });
        ranks_.refuse_others(sum, "other meshes", "let all of them read the same files");
    }

    void read_vertices() {
        for (const Body& body : scene_.bodies) {
            with_place_of(body, [&] { read_vertices(body); });
            ranks_.agree([&] { check_size(meshes_.back(), body); });
        }
        ranks_.agree([&] { result_.owners = share_vertices(scene_, meshes_, ranks_.count()); });
    }

    void read_vertices(const Body& body) {
        ranks_.agree([&] {
            result_.sources.emplace_back(body.mesh, ranks_.count());
            meshes_.push_back(result_.sources.back().vertices());
        });
        const MeshSource<Dim>& source = result_.sources.back();
        if (!is_text(source)) {
            check_sum_of(body, source);
        }
        if (!meshes_.back().positions.allFinite()) {
            refuse_vertices(body, source);
        }
    }

    [[nodiscard]] static bool is_text(const MeshSource<Dim>& source) {
        return source.info().encoding == Encoding::Ascii;
    }

    // Behind all else that is wrong with the file, as read_mesh() has it.
    void refuse_vertices(const Body& body, const MeshSource<Dim>& source) const {
        if (is_text(source)) {
            for_each_piece(source, {}, ranks_, [](const auto&, Eigen::Index /*first*/) {});
            check_sum_of(body, source);
        }
        validate_part<Dim>(meshes_.back(), body.mesh, {});
    }

    // Of text behind what is wrong with its numbers, as read_mesh() has it.
    void check_sum_of(const Body& body, const MeshSource<Dim>& source) const {
        if (!source.is_extrusion()) {
            check_checksum(body.mesh, ranks_.writers());
        }
    }

    [[nodiscard]] std::int64_t sum(std::int64_t own) const {
        const std::vector<double> all = ranks_.list(static_cast<double>(own));
        return static_cast<std::int64_t>(std::accumulate(all.begin(), all.end(), 0.0));
    }

    // How the facets of a whole mesh meet. One is judged by the rank that has its lowest corner,
    // and with that all of its cells.
    [[nodiscard]] FacetMatch<Dim> facets_of_all(const MeshPart<Dim>& part,
                                                const Owners& owners) const {
        FacetMatch<Dim> own;
        ranks_.agree([&] {
            own = match_facets<Dim>(part.mesh.cells, part.mesh.vertex_count(),
                                    [&](std::uint32_t vertex) { return owners.has(vertex); });
        });
        const double first = own.is_conforming()
                                 ? std::numeric_limits<double>::infinity()
                                 : part.numbers[static_cast<std::size_t>(own.first_fault)];
        const std::vector<double> firsts = ranks_.list(first);
        FacetMatch<Dim> all;
        all.one_sided = sum(own.one_sided);
        all.overfull = sum(own.overfull);
        if (!all.is_conforming()) {
            all.first_fault =
                static_cast<std::int64_t>(*std::min_element(firsts.begin(), firsts.end()));
        }
        return all;
    }

    void read_cells() {
        std::size_t first = 0;
        for (std::size_t i = 0; i < meshes_.size(); ++i) {
            const auto count = static_cast<std::size_t>(meshes_[i].vertex_count());
            const Owners owners = {
                std::span<const std::uint32_t>(result_.owners).subspan(first, count),
                static_cast<std::uint32_t>(ranks_.place())};
            const Body& body = scene_.bodies[i];
            with_place_of(body, [&] { result_.parts.push_back(read_cells(i, owners)); });
            judge_facets<Dim>(scene_, body, facets_of_all(result_.parts[i], owners),
                              result_.warnings);
            first += count;
        }
    }

    // Takes the vertices over.
    MeshPart<Dim> read_cells(std::size_t i, const Owners& owners) {
        const MeshSource<Dim>& source = result_.sources[i];
        const Body& body = scene_.bodies[i];
        Wanted wanted;
        ranks_.agree([&] { wanted = wanted_of(scene_, body, source); });
        const NeededCells needed(scene_.solver.elements, owners.of_vertices.size(),
                                 [&](std::uint32_t vertex) { return owners.has(vertex); });
        // The cells that make a quadratic one, if any do, need not be at neighboring columns.
        MeshPart<Dim> part =
            source.is_extrusion() && scene_.solver.elements != ElementKind::Quadratic
                ? extruded_part(source, wanted, needed, meshes_[i].columns, owners)
                : read_part<Dim>(source, wanted, needed, ranks_);
        // What is beside the mesh is for its copy in the folder alone, which reads it then.
        const MeshSlab slab =
            slab_of(meshes_[i].vertex_count(), part.cell_count, ranks_.place(), ranks_.count());
        MeshExtras<Dim> extras;
        ranks_.agree([&] { extras = read_extras<Dim>(body.mesh, slab); });
        if (is_text(source)) {
            check_sum_of(body, source);
        }
        part.mesh.positions = std::move(meshes_[i].positions);
        part.mesh.columns = std::move(meshes_[i].columns);
        part.mesh.layers = std::move(meshes_[i].layers);
        validate_parts<Dim>(part.mesh, body.mesh, part.numbers, ranks_);
        ranks_.agree([&] { validate_extras(extras, slab, part.mesh.vertex_count(), body.mesh); });
        return part;
    }

    const Scene& scene_;
    const RunRanks& ranks_;
    std::vector<SimplexMesh<Dim>> meshes_;  // vertices alone, until they are in parts
    SceneParts<Dim> result_;
};

}  // namespace

template <int Dim>
SceneParts<Dim> read_parts(const Scene& scene, const RunRanks& ranks) {
    return PartReader<Dim>(scene, ranks)();
}

template SceneParts<3> read_parts<3>(const Scene&, const RunRanks&);
template SceneParts<4> read_parts<4>(const Scene&, const RunRanks&);

}  // namespace pent::runs
