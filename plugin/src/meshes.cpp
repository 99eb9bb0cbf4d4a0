// Meshes, frames and scenes without a simulation.

#include "handles.h"

#include <pent/facets.h>
#include <pent/runs/relocated.h>
#include <pent/runs/scene_file.h>
#include <pent/validate_extras.h>

#include <algorithm>
#include <utility>

using namespace pent;
using namespace pent::plugin;

namespace {

// work(std::integral_constant) with the dimension, 2, 3 or 4.
template <typename Work>
auto for_dimension(int dimension, const Work& work) {
    switch (dimension) {
        case 2:
            return work(std::integral_constant<int, 2>());
        case 3:
            return work(std::integral_constant<int, 3>());
        case 4:
            return work(std::integral_constant<int, 4>());
        default:
            throw Error("a mesh of " + std::to_string(dimension)
                        + " dimensions was given; expected 2, 3 or 4");
    }
}

template <int Dim>
constexpr int dimension_of(const SimplexMesh<Dim>& /*mesh*/) {
    return Dim;
}

template <int Dim>
constexpr int dimension_of(const Frame<Dim>& /*frame*/) {
    return Dim;
}

// Calls work(mesh, stored).
template <typename Value, typename Work>
Value with_mesh(const pent_stored_mesh* handle, Value failure, const Work& work) {
    return guarded(failure, [&]() -> Value {
        const std::shared_ptr<StoredMesh> stored = meshes().find(handle, "mesh");
        return std::visit([&](const auto& mesh) -> Value { return work(mesh, *stored); },
                          stored->mesh);
    });
}

template <typename List>
auto* data_or_null(const List& list) {
    return list.size() == 0 ? nullptr : list.data();
}

template <int Dim>
pent_mesh c_mesh(const SimplexMesh<Dim>& mesh) {
    return {.positions = mesh.positions.data(),
            .vertices = mesh.vertex_count(),
            .cells = mesh.cells.data(),
            .cell_count = mesh.cell_count(),
            .regions = data_or_null(mesh.regions),
            .columns = data_or_null(mesh.columns),
            .layers = data_or_null(mesh.layers),
            .parents = data_or_null(mesh.parents),
            .fibers = data_or_null(mesh.fibers)};
}

pent_field c_field(const VertexField& field) {
    return {.name = field.name.c_str(),
            .values = field.values.data(),
            .rows = static_cast<int32_t>(field.values.rows())};
}

std::vector<pent_field> c_fields(const std::vector<VertexField>& fields) {
    std::vector<pent_field> seen(fields.size());
    std::transform(fields.begin(), fields.end(), seen.begin(), c_field);
    return seen;
}

std::vector<VertexField> fields_of(const pent_field* fields,
                                   std::int64_t field_count,
                                   Eigen::Index count,
                                   const char* name) {
    std::vector<VertexField> copied;
    for (std::int64_t i = 0; i < field_count; ++i) {
        require(fields, name);
        const pent_field& field = fields[i];
        require(field.name, "the name of a field");
        require(field.values, field.name);
        if (field.rows < 1 || field.rows > 4) {
            throw Error(std::string(field.name) + " has " + std::to_string(field.rows)
                        + " rows, expected 1, or the dimension for a vector");
        }
        copied.push_back(
            {field.name, Eigen::Map<const Eigen::MatrixXd>(field.values, field.rows, count)});
    }
    return copied;
}

template <typename Value>
std::vector<Value> copied(const Value* values, Eigen::Index count) {
    return values == nullptr ? std::vector<Value>() : std::vector<Value>(values, values + count);
}

template <int Dim>
MeshExtras<Dim> extras_of(const pent_mesh_extras& extras, const SimplexMesh<Dim>& mesh) {
    MeshExtras<Dim> made;
    made.vertex_fields = fields_of(extras.vertex_fields, extras.vertex_field_count,
                                   mesh.vertex_count(), "vertex_fields");
    made.cell_fields =
        fields_of(extras.cell_fields, extras.cell_field_count, mesh.cell_count(), "cell_fields");
    if (extras.facet_count > 0) {
        require(extras.facets, "facets");
        made.boundary = Eigen::Map<const Simplices<Dim>>(extras.facets, Dim, extras.facet_count);
        made.labels = copied(extras.labels, extras.facet_count);
        made.base_labels = copied(extras.base_labels, extras.facet_count);
    }
    made.bisection_tags = copied(extras.bisection_tags, mesh.cell_count());
    return made;
}

// What is beside the mesh that is stored, which it fits.
template <int Dim>
void set_extras(MeshExtras<Dim> extras, StoredMesh& stored) {
    const auto& kept = stored.extras.emplace<MeshExtras<Dim>>(std::move(extras));
    stored.vertex_fields = c_fields(kept.vertex_fields);
    stored.cell_fields = c_fields(kept.cell_fields);
}

}  // namespace

template <int Dim>
const std::vector<std::uint32_t>& plugin::boundary_of(StoredMesh& stored,
                                                      const SimplexMesh<Dim>& mesh) {
    std::call_once(stored.has_boundary, [&] {
        const FacetMatch<Dim> match = match_facets<Dim>(mesh.cells, mesh.vertex_count());
        if (!match.is_conforming()) {
            throw Error(stored.name + ": " + std::string(cell_name(Dim)) + " "
                        + std::to_string(match.first_fault)
                        + " does not fit its neighbors; expected every facet on the boundary, or"
                          " shared by two cells from opposite sides");
        }
        stored.boundary.assign(match.boundary.data(),
                               match.boundary.data() + match.boundary.size());
    });
    return stored.boundary;
}

template const std::vector<std::uint32_t>& plugin::boundary_of(StoredMesh&, const SimplexMesh<2>&);
template const std::vector<std::uint32_t>& plugin::boundary_of(StoredMesh&, const SimplexMesh<3>&);
template const std::vector<std::uint32_t>& plugin::boundary_of(StoredMesh&, const SimplexMesh<4>&);

pent_stored_mesh* pent_read_mesh(const char* path) {
    return guarded<pent_stored_mesh*>(nullptr, [&] {
        require(path, "path");
        const FileInfo info = read_info(path);
        auto stored = std::make_shared<StoredMesh>();
        for_dimension(info.dimension, [&](auto dimension) {
            auto file = read_mesh<decltype(dimension)::value>(path);
            stored->mesh = std::move(file.mesh);
            set_extras(std::move(file.extras), *stored);
        });
        stored->name = path;
        stored->created_by = info.created_by;
        stored->crc32c = info.crc32c;
        return meshes().add(std::move(stored));
    });
}

pent_stored_mesh* pent_store_mesh(int dimension,
                                  const pent_mesh* mesh,
                                  const pent_mesh_extras* extras) {
    return guarded<pent_stored_mesh*>(nullptr, [&] {
        require(mesh, "mesh");
        auto stored = std::make_shared<StoredMesh>();
        stored->name = "mesh";
        for_dimension(dimension, [&](auto constant) {
            constexpr int kDim = decltype(constant)::value;
            SimplexMesh<kDim> made = mesh_of<kDim>(*mesh, stored->name);
            validate(made, stored->name);
            MeshExtras<kDim> beside;
            if (extras != nullptr) {
                beside = extras_of(*extras, made);
                validate_extras(made, beside, stored->name);
            }
            stored->mesh = std::move(made);
            set_extras(std::move(beside), *stored);
        });
        return meshes().add(std::move(stored));
    });
}

int pent_write_mesh(const pent_stored_mesh* mesh,
                    const char* path,
                    const char* created_by,
                    int is_ascii) {
    return with_mesh(mesh, -1, [&]<int Dim>(const SimplexMesh<Dim>& held, StoredMesh& stored) {
        require(path, "path");
        require(created_by, "created_by");
        static_cast<void>(
            write_mesh(path, held,
                       {.encoding = is_ascii != 0 ? Encoding::Ascii : Encoding::Binary,
                        .created_by = created_by},
                       std::get<MeshExtras<Dim>>(stored.extras)));
        return 0;
    });
}

int pent_mesh_info_of(const pent_stored_mesh* mesh, pent_mesh_info* info) {
    return with_mesh(mesh, -1, [&](const auto& held, StoredMesh& stored) {
        require(info, "info");
        *info = {.dimension = dimension_of(held),
                 .arrays = c_mesh(held),
                 .hypervolume = total_volume(held),
                 .created_by = stored.created_by.c_str(),
                 .crc32c = stored.crc32c};
        return 0;
    });
}

int pent_mesh_extras_of(const pent_stored_mesh* mesh, pent_mesh_extras* extras) {
    return with_mesh(mesh, -1, [&]<int Dim>(const SimplexMesh<Dim>&, StoredMesh& stored) {
        require(extras, "extras");
        const auto& held = std::get<MeshExtras<Dim>>(stored.extras);
        *extras = {.vertex_fields = data_or_null(stored.vertex_fields),
                   .vertex_field_count = static_cast<int64_t>(stored.vertex_fields.size()),
                   .cell_fields = data_or_null(stored.cell_fields),
                   .cell_field_count = static_cast<int64_t>(stored.cell_fields.size()),
                   .facets = data_or_null(held.boundary),
                   .facet_count = held.boundary.cols(),
                   .labels = data_or_null(held.labels),
                   .base_labels = data_or_null(held.base_labels),
                   .bisection_tags = data_or_null(held.bisection_tags)};
        return 0;
    });
}

const uint32_t* pent_mesh_boundary(const pent_stored_mesh* mesh, int64_t* count) {
    return with_mesh<const uint32_t*>(
        mesh, nullptr, [&](const auto& held, StoredMesh& stored) -> const uint32_t* {
            require(count, "count");
            const std::vector<std::uint32_t>& boundary = boundary_of(stored, held);
            *count = static_cast<int64_t>(boundary.size()) / dimension_of(held);
            return boundary.data();
        });
}

int pent_free_mesh(pent_stored_mesh* mesh) {
    return release(meshes(), mesh, "mesh");
}

pent_stored_frame* pent_read_frame(const char* path) {
    return guarded<pent_stored_frame*>(nullptr, [&] {
        require(path, "path");
        return for_dimension(read_info(path).dimension, [&](auto dimension) {
            return frames().add(
                std::make_shared<StoredFrame>(read_frame<decltype(dimension)::value>(path)));
        });
    });
}

int pent_frame_info_of(const pent_stored_frame* frame, pent_frame_info* info) {
    return guarded(-1, [&] {
        const std::shared_ptr<StoredFrame> stored = frames().find(frame, "frame");
        require(info, "info");
        std::visit(
            [&](const auto& held) {
                *info = {.dimension = dimension_of(held),
                         .vertices = held.positions.cols(),
                         .positions = held.positions.data(),
                         .velocities = data_or_null(held.velocities),
                         .contact_forces = data_or_null(held.contact_forces),
                         .field_count = static_cast<int64_t>(held.fields.size()),
                         .mesh_name = held.mesh_name.c_str(),
                         .mesh_crc32c = held.mesh_crc,
                         .frame = held.frame,
                         .step = held.step,
                         .time = held.time};
            },
            *stored);
        return 0;
    });
}

int pent_frame_field(const pent_stored_frame* frame, int64_t field, pent_field* found) {
    return guarded(-1, [&] {
        const std::shared_ptr<StoredFrame> stored = frames().find(frame, "frame");
        require(found, "found");
        const std::vector<VertexField>& fields = std::visit(
            [](const auto& held) -> const std::vector<VertexField>& { return held.fields; },
            *stored);
        const auto count = static_cast<int64_t>(fields.size());
        if (field < 0 || field >= count) {
            throw Error("field " + std::to_string(field) + " of " + std::to_string(count)
                        + "; count from 0");
        }
        *found = c_field(fields[static_cast<std::size_t>(field)]);
        return 0;
    });
}

int pent_free_frame(pent_stored_frame* frame) {
    return release(frames(), frame, "frame");
}

const char* pent_scene_text(const char* scene, const char* name, const char* folder) {
    return guarded<const char*>(nullptr, [&] {
        require(scene, "scene");
        require(name, "name");
        require(folder, "folder");
        static thread_local std::string text;
        text = runs::scene_text(runs::parse_scene(scene, name, folder));
        return text.c_str();
    });
}

const char* pent_scene_text_for(const char* scene,
                                const char* name,
                                const char* folder,
                                const char* target) {
    return guarded<const char*>(nullptr, [&] {
        require(scene, "scene");
        require(name, "name");
        require(folder, "folder");
        require(target, "target");
        static thread_local std::string text;
        text = runs::scene_text(
            runs::relocated(runs::parse_scene(scene, name, folder), folder, target));
        return text.c_str();
    });
}
