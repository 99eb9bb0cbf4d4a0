#pragma once

#include "support/kuhn_box.h"

#include <pent/simulator/simulation.h>

#include <gtest/gtest.h>

#include <array>
#include <pent_plugin.h>
#include <string>
#include <utility>

namespace pent::test {

/// Owns a simulation of the plugin.
class Host {
public:
    explicit Host(pent_simulation* simulation) : simulation_(simulation) {
        EXPECT_NE(simulation, nullptr) << pent_last_error();
    }
    ~Host() { static_cast<void>(pent_close(simulation_)); }
    Host(Host&& other) noexcept : simulation_(std::exchange(other.simulation_, nullptr)) {}
    Host(const Host&) = delete;
    Host& operator=(const Host&) = delete;
    Host& operator=(Host&&) = delete;

    // NOLINTNEXTLINE(google-explicit-constructor): stands for it
    operator pent_simulation*() const { return simulation_; }

private:
    pent_simulation* simulation_;
};

/// A box of one cell of 1 m.
template <int Dim>
const SimplexMesh<Dim>& box() {
    static const SimplexMesh<Dim> mesh = [] {
        std::array<int, Dim> count{};
        std::array<double, Dim> size{};
        count.fill(1);
        size.fill(1);
        return kuhn_box<Dim>(count, size);
    }();
    return mesh;
}

/// As a host in C has it; the mesh must last.
template <int Dim>
pent_mesh closed_c_mesh(const SimplexMesh<Dim>& mesh) {
    pent_mesh made = {};
    made.positions = mesh.positions.data();
    made.vertices = mesh.vertex_count();
    made.cells = mesh.cells.data();
    made.cell_count = mesh.cell_count();
    return made;
}

/// Two boxes, one on the ground, one above.
inline constexpr const char* kScene4 =
    "[scene]\ngravity = [0, -9, 0, 0]\n"
    "[[body]]\nname = \"low\"\nmesh = \"-\"\n"
    "[[body]]\nname = \"high\"\nmesh = \"-\"\nplace = { translate = [0.2, 1.5, 0, 0] }\n"
    "[[obstacle]]\nhalf_space = { normal = [0, 1, 0, 0] }\ndistance = 0.1\n"
    "[contact]\ndistance = 0.1\n[solver]\nintegrator = \"bdf2\"\n";
inline constexpr const char* kScene3 =
    "[scene]\ndimension = 3\ngravity = [0, -9, 0]\n"
    "[[body]]\nname = \"low\"\nmesh = \"-\"\n"
    "[[body]]\nname = \"high\"\nmesh = \"-\"\nplace = { translate = [0, 5, 0] }\n"
    "[[obstacle]]\nhalf_space = { normal = [0, 1, 0] }\ndistance = 0.1\n";

inline Host open4(int threads = 1) {
    const std::array<pent_mesh, 2> meshes = {closed_c_mesh(box<4>()), closed_c_mesh(box<4>())};
    return Host(pent_open_text(kScene4, meshes.data(), 2, threads));
}
inline Host open3() {
    const std::array<pent_mesh, 2> meshes = {closed_c_mesh(box<3>()), closed_c_mesh(box<3>())};
    return Host(pent_open_text(kScene3, meshes.data(), 2, 1));
}

/// Expects that this is part of the last error, and that it is one line.
inline void expect_error(const std::string& part) {
    const std::string error = pent_last_error();
    EXPECT_NE(error.find(part), std::string::npos) << "no '" << part << "' in: " << error;
    EXPECT_EQ(error.find('\n'), std::string::npos) << error;
}

}  // namespace pent::test
