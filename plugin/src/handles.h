#pragma once

#include <pent/error.h>
#include <pent/pent_file.h>
#include <pent/simulator/simulation.h>

#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <pent_plugin_meshes.h>
#include <string>
#include <type_traits>
#include <variant>
#include <vector>

namespace pent::plugin {

using simulator::Scene;
using simulator::Simulation;

/// A triangle surface whose arrays a host sees.
struct SeenSurface {
    Positions<3> positions;
    Simplices<3> triangles;
    Simplices<2> ends;
    Eigen::VectorXd weights;
};

/// The boundary of a body, found where it is first asked for.
struct BodyBoundary {
    std::vector<std::uint32_t> facets;
    std::shared_ptr<const void> index;  // viewer::Boundary of the dimension, for slices
};

/// Those of bodies that were asked for, by their numbers.
using Boundaries = std::map<int, BodyBoundary>;

/// Simulations and states of the dimensions that scenes may have here.
template <int... Dims>
struct Offer {
    using Simulations = std::variant<std::unique_ptr<Simulation<Dims>>...>;
    using Snapshots = std::variant<simulator::Snapshot<Dims>...>;
};
#ifdef PENT_ONLY_4D  // half the code: for a module that a page loads
using Offered = Offer<4>;
#else
using Offered = Offer<3, 4>;
#endif

/// What is behind a handle: a simulation, and what of it was handed out.
struct Opened {
    Offered::Simulations simulation;
    std::shared_ptr<Boundaries> boundaries = std::make_shared<Boundaries>();
    SeenSurface surface;
    std::vector<pent_contact> contacts;
    std::vector<std::string> energy_names;
    std::vector<pent_energy> energies;
    std::mutex in_use;
};

/// Arrays of a simulation that outlive it.
struct Kept {
    std::shared_ptr<const void> arrays;
    std::shared_ptr<const Boundaries> boundaries;
};

/// A mesh without a simulation. Nothing of it changes, but that its boundary is found and
/// indexed once.
struct StoredMesh {
    std::variant<SimplexMesh<2>, SimplexMesh<3>, SimplexMesh<4>> mesh;
    // What its file has beside it, of the same dimension.
    std::variant<MeshExtras<2>, MeshExtras<3>, MeshExtras<4>> extras;
    std::vector<pent_field> vertex_fields;  // those of the extras, as a host sees them
    std::vector<pent_field> cell_fields;
    std::string name;  // in messages
    std::string created_by;
    std::uint32_t crc32c = 0;
    std::once_flag has_boundary;
    std::vector<std::uint32_t> boundary;
    std::once_flag is_indexed;
    std::shared_ptr<const void> index;  // viewer::Boundary of the dimension, for slices
};

using StoredFrame = std::variant<Frame<2>, Frame<3>, Frame<4>>;

/// Things by handles. A handle is a number, the next of all, which nobody takes for an address: one
/// that is not there is found to be so.
template <typename Handle, typename Thing>
class Handles {
public:
    [[nodiscard]] Handle* add(std::shared_ptr<Thing> thing);

    /// Throws an Error that says what is not there.
    [[nodiscard]] std::shared_ptr<Thing> find(const Handle* handle, const char* what);
    void remove(const Handle* handle, const char* what);

private:
    std::mutex mutex_;
    std::map<std::uintptr_t, std::shared_ptr<Thing>> things_;
};

[[nodiscard]] Handles<pent_simulation, Opened>& simulations();
[[nodiscard]] Handles<pent_state, Offered::Snapshots>& states();
[[nodiscard]] Handles<pent_kept, Kept>& kept_arrays();
[[nodiscard]] Handles<pent_stored_mesh, StoredMesh>& meshes();
[[nodiscard]] Handles<pent_stored_frame, StoredFrame>& frames();

/// What pent_last_error() says in this thread.
[[nodiscard]] std::string& last_error();

/// What went wrong on one line: names of files may have line breaks.
[[nodiscard]] std::string one_line(std::string text);

/// Calls work(); what it throws becomes last_error() and the value for failure.
template <typename Value, typename Work>
Value guarded(Value failure, const Work& work) noexcept {
    try {
        last_error().clear();
        return work();
    } catch (const std::exception& error) {
        last_error() = one_line(error.what());
    } catch (...) {  // GCOVR_EXCL_START: C cannot catch, so nothing may get out, whatever it is
        last_error() = "unknown failure";
    }  // GCOVR_EXCL_STOP
    return failure;
}

/// Takes a thing from its handle. Where that succeeds last_error() stays as it is.
template <typename Things, typename Handle>
int release(Things& things, Handle* handle, const char* what) noexcept {
    const std::string before = last_error();
    return guarded(-1, [&] {
        things.remove(handle, what);
        last_error() = before;
        return 0;
    });
}

/// Calls work(simulation, opened) with a simulation of either dimension that no other thread uses.
template <typename Value, typename Work>
Value with(const pent_simulation* handle, Value failure, const Work& work) noexcept {
    return guarded(failure, [&]() -> Value {
        const std::shared_ptr<Opened> opened = simulations().find(handle, "simulation");
        const std::unique_lock<std::mutex> lock(opened->in_use, std::try_to_lock);
        if (!lock.owns_lock()) {
            throw Error("another thread is using this simulation; take turns");
        }
        return std::visit([&](auto& held) -> Value { return work(*held, *opened); },
                          opened->simulation);
    });
}

/// The same for one of its bodies, which has to be there.
template <typename Value, typename Work>
Value with_body(const pent_simulation* handle, int body, Value failure, const Work& work) noexcept {
    return with(handle, failure, [&](auto& simulation, Opened& opened) -> Value {
        if (body < 0 || body >= simulation.body_count()) {
            throw Error("body " + std::to_string(body) + " of "
                        + std::to_string(simulation.body_count()) + "; count from 0");
        }
        return work(simulation, opened);
    });
}

/// Throws an Error where a host gave NULL.
void require(const void* argument, const char* name);

template <typename Held>
inline constexpr int kDimOf = 0;
template <int Dim>
inline constexpr int kDimOf<Simulation<Dim>> = Dim;

template <int Dim>
[[nodiscard]] Eigen::Matrix<double, Dim, 1> vector(const double* numbers, const char* name) {
    require(numbers, name);
    return Eigen::Map<const Eigen::Matrix<double, Dim, 1>>(numbers);
}

/// dimension x count numbers of a host.
template <int Dim>
[[nodiscard]] Positions<Dim> array(const double* numbers, std::int64_t count, const char* name) {
    if (count > 0) {
        require(numbers, name);
    }
    return Eigen::Map<const Positions<Dim>>(numbers, Dim, count);
}

/// The mesh of a host, copied; what it says of vertices and cells is not checked here.
///
/// @param name  In messages.
template <int Dim>
[[nodiscard]] SimplexMesh<Dim> mesh_of(const pent_mesh& mesh, const std::string& name);

/// The same for a body of a scene, checked as one that pent_open_file() reads.
template <int Dim>
[[nodiscard]] SimplexMesh<Dim> mesh_of_body(const Scene& scene,
                                            const simulator::Body& body,
                                            const pent_mesh& mesh);

/// The boundary facets of a stored mesh, Dim indices each. Throws an Error where cells do not fit
/// together.
template <int Dim>
[[nodiscard]] const std::vector<std::uint32_t>& boundary_of(StoredMesh& stored,
                                                            const SimplexMesh<Dim>& mesh);

}  // namespace pent::plugin
