#include "handles.h"

#include <pent/runs/scene_meshes.h>

#include <algorithm>
#include <atomic>
#include <limits>
#include <utility>

namespace pent::plugin {

namespace {

std::uintptr_t next_number() {
    static std::atomic<std::uintptr_t> next = 1;  // of all handles, so that none stands for two
    return next++;
}

std::uintptr_t number_of(const void* handle) {
    return reinterpret_cast<std::uintptr_t>(handle);
}

template <typename Label>
std::vector<Label> labels(const Label* first, std::int64_t count) {
    return first == nullptr ? std::vector<Label>() : std::vector<Label>(first, first + count);
}

}  // namespace

template <typename Handle, typename Thing>
Handle* Handles<Handle, Thing>::add(std::shared_ptr<Thing> thing) {
    const std::lock_guard<std::mutex> lock(mutex_);
    const std::uintptr_t number = next_number();
    things_[number] = std::move(thing);
    return reinterpret_cast<Handle*>(number);  // NOLINT(performance-no-int-to-ptr)
}

template <typename Handle, typename Thing>
std::shared_ptr<Thing> Handles<Handle, Thing>::find(const Handle* handle, const char* what) {
    const std::lock_guard<std::mutex> lock(mutex_);
    const auto found = things_.find(number_of(handle));
    if (found == things_.end()) {
        throw Error("there is no such " + std::string(what)
                    + ": it is NULL, was never opened, or is closed");
    }
    return found->second;
}

template <typename Handle, typename Thing>
void Handles<Handle, Thing>::remove(const Handle* handle, const char* what) {
    const std::shared_ptr<Thing> last = find(handle, what);  // goes behind the lock
    const std::lock_guard<std::mutex> lock(mutex_);
    things_.erase(number_of(handle));
}

template class Handles<pent_simulation, Opened>;
template class Handles<pent_state, Offered::Snapshots>;
template class Handles<pent_kept, Kept>;
template class Handles<pent_stored_mesh, StoredMesh>;
template class Handles<pent_stored_frame, StoredFrame>;

Handles<pent_simulation, Opened>& simulations() {
    static Handles<pent_simulation, Opened> all;  // a C interface has nowhere else to keep them
    return all;
}

Handles<pent_state, Offered::Snapshots>& states() {
    static Handles<pent_state, Offered::Snapshots> all;
    return all;
}

Handles<pent_kept, Kept>& kept_arrays() {
    static Handles<pent_kept, Kept> all;
    return all;
}

Handles<pent_stored_mesh, StoredMesh>& meshes() {
    static Handles<pent_stored_mesh, StoredMesh> all;
    return all;
}

Handles<pent_stored_frame, StoredFrame>& frames() {
    static Handles<pent_stored_frame, StoredFrame> all;
    return all;
}

std::string& last_error() {
    static thread_local std::string text;
    return text;
}

std::string one_line(std::string text) {
    std::replace_if(
        text.begin(), text.end(), [](char c) { return c == '\n' || c == '\r'; }, ' ');
    return text;
}

void require(const void* argument, const char* name) {
    if (argument == nullptr) {
        throw Error(std::string(name) + " is NULL");
    }
}

template <int Dim>
SimplexMesh<Dim> mesh_of(const pent_mesh& mesh, const std::string& name) {
    const std::string of = name + ": ";
    constexpr auto kMaxCount = std::int64_t{std::numeric_limits<std::uint32_t>::max()};
    if (mesh.vertices < 1 || mesh.vertices > kMaxCount || mesh.cell_count < 1
        || mesh.cell_count > kMaxCount) {
        throw Error(of + std::to_string(mesh.vertices) + " vertices and "
                    + std::to_string(mesh.cell_count) + " cells; expected 1 to "
                    + std::to_string(kMaxCount) + " of either");
    }
    require(mesh.positions, (of + "positions").c_str());
    require(mesh.cells, (of + "cells").c_str());
    SimplexMesh<Dim> made;
    made.positions = array<Dim>(mesh.positions, mesh.vertices, "positions");
    made.cells = Eigen::Map<const Simplices<Dim + 1>>(mesh.cells, Dim + 1,
                                                      static_cast<Eigen::Index>(mesh.cell_count));
    made.regions = labels(mesh.regions, mesh.cell_count);
    made.columns = labels(mesh.columns, mesh.vertices);
    made.layers = labels(mesh.layers, mesh.vertices);
    made.parents = labels(mesh.parents, mesh.cell_count);
    if (mesh.fibers != nullptr) {
        made.fibers = array<Dim>(mesh.fibers, mesh.cell_count, "fibers");
    }
    return made;
}

template <int Dim>
SimplexMesh<Dim> mesh_of_body(const Scene& scene,
                              const simulator::Body& body,
                              const pent_mesh& mesh) {
    const std::string name = "mesh of \"" + body.name + "\"";
    SimplexMesh<Dim> made = mesh_of<Dim>(mesh, name);
    validate(made, name);
    std::vector<std::string> warnings;  // for which this interface has no place
    runs::judge_mesh(scene, body, made, warnings);
    return made;
}

template SimplexMesh<2> mesh_of(const pent_mesh&, const std::string&);
template SimplexMesh<3> mesh_of(const pent_mesh&, const std::string&);
template SimplexMesh<4> mesh_of(const pent_mesh&, const std::string&);
template SimplexMesh<3> mesh_of_body(const Scene&, const simulator::Body&, const pent_mesh&);
template SimplexMesh<4> mesh_of_body(const Scene&, const simulator::Body&, const pent_mesh&);

}  // namespace pent::plugin
