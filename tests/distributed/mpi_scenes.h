#pragma once

#include "run_program.h"
#include "support/kuhn_box.h"

#include <pent/extrusion.h>
#include <pent/pent_file.h>
#include <pent/runs/report.h>

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <string>
#include <utility>

namespace pent::test {

/// What to put before pent-sim-mpi: several ranks on however many cores, at most two minutes. What
/// Open MPI asks of root, and of machines that are shared.
[[nodiscard]] inline std::string mpirun(int ranks, const std::string& options = "") {
    return "env OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1"
           " OMPI_MCA_mpi_yield_when_idle=1 OMPI_MCA_btl_vader_single_copy_mechanism=none"
           " timeout 120 mpirun -q --oversubscribe --bind-to none "
           + options + " -n " + std::to_string(ranks);
}

/// What a program said, without its name.
[[nodiscard]] inline std::string said(const Outcome& outcome) {
    return outcome.err.substr(outcome.err.find(": "));
}

/// A folder with a bar, two boxes and scenes of them.
class MpiScenes : public testing::Test {
protected:
    MpiScenes() {
        SimplexMesh<4> bar = kuhn_box<4>({6, 2, 2, 2}, {1.5, 0.5, 0.5, 0.5});
        const std::uint32_t base = 7 * 9;
        for (std::uint32_t v = 0; v < bar.vertex_count(); ++v) {
            bar.columns.push_back(v % base);
            bar.layers.push_back(v / base);
        }
        static_cast<void>(write_mesh(folder_ / "bar.pent", bar));
        static_cast<void>(
            write_mesh(folder_ / "box.pent", kuhn_box<3>({3, 3, 3}, {0.5, 0.5, 0.5})));
        write("bar", kBar);
        write("boxes", kBoxes);
    }

    void write(const std::string& scene, const std::string& text) const {
        std::ofstream(path(scene + ".toml")) << text;
    }

    [[nodiscard]] std::string path(const std::string& name) const {
        return (folder_ / name).string();
    }

    /// A scene into the run RUN by so many ranks; 0: by pent-sim.
    [[nodiscard]] Outcome simulate(int ranks,
                                   const std::string& scene,
                                   const std::string& run,
                                   const std::string& options = "") const {
        const std::string arguments =
            " " + path(scene + ".toml") + " -o " + path(run)
            + (options.find("--threads") == std::string::npos ? " --threads 1 " : " ") + options;
        return ranks == 0 ? run_program("pent-sim" + arguments)
                          : run_program("pent-sim-mpi" + arguments, mpirun(ranks));
    }

    [[nodiscard]] std::string frame(const std::string& run,
                                    const std::string& body,
                                    int number) const {
        const std::string digits = std::to_string(number);
        return path(run + "/frames/" + body + "_" + std::string(6 - digits.size(), '0') + digits
                    + ".pent");
    }

    [[nodiscard]] runs::RunReport report(const std::string& run) const {
        return runs::read_report(path(run + "/report.json"));
    }

    /// Positions differ by this part of how far the body has gone since frame 0, at most.
    template <int Dim>
    void expect_near(const std::string& run,
                     const std::string& other,
                     const std::string& body,
                     int number,
                     double tolerance) const {
        const auto a = read_frame<Dim>(frame(run, body, number));
        const auto b = read_frame<Dim>(frame(other, body, number));
        const auto start = read_frame<Dim>(frame(other, body, 0));
        EXPECT_EQ(a.mesh_crc, b.mesh_crc);
        EXPECT_EQ(a.step, b.step);
        EXPECT_EQ(a.time, b.time);
        EXPECT_LT((a.positions - b.positions).norm(),
                  tolerance * (b.positions - start.positions).norm())
            << run << " " << body << " " << number;
    }

    void expect_same_bytes(const std::string& run,
                           const std::string& other,
                           const std::string& body) const {
        for (int number = 0; number <= 4; ++number) {
            const std::string bytes = text_of(frame(run, body, number));
            ASSERT_FALSE(bytes.empty()) << run << " " << number;
            EXPECT_EQ(bytes, text_of(frame(other, body, number))) << run << " " << number;
        }
    }

    /// The extrusion() as base and layers, base.pent, and as the mesh that they make, whole.pent.
    void write_extrusion_and_mesh() const {
        const Extrusion<4> made = extrusion();
        static_cast<void>(write_extrusion<4>(path("base.pent"), made));
        static_cast<void>(write_mesh(
            path("whole.pent"), extrude<4>(made.base, made.ordered, made.layers, made.options)));
    }

    /// A box of tetrahedra through five layers, each turned and smaller than the one below.
    [[nodiscard]] static Extrusion<4> extrusion() {
        Extrusion<4> made;
        made.base = kuhn_box<3>({3, 2, 2}, {0.6, 0.4, 0.4});
        made.base.positions.colwise() -= Eigen::Vector3d(0.3, 0.2, 0.2);
        for (Eigen::Index cell = 0; cell < made.base.cell_count(); ++cell) {
            made.base.regions.push_back(cell % 5 == 0 ? 7 : 3);
        }
        made.ordered.cells = made.base.cells;
        for (auto cell : made.ordered.cells.colwise()) {
            bool is_odd = false;
            for (int pass = 0; pass < 4; ++pass) {
                for (int i = 0; i < 3; ++i) {
                    if (cell[i] > cell[i + 1]) {
                        std::swap(cell[i], cell[i + 1]);
                        is_odd = !is_odd;
                    }
                }
            }
            made.ordered.is_odd.push_back(is_odd ? 1 : 0);
        }
        for (int l = 0; l < 5; ++l) {
            const double angle = 0.05 * l;
            Layer<4> layer;
            layer.linear.setIdentity();
            layer.linear.topLeftCorner<2, 2>() << std::cos(angle), -std::sin(angle),
                std::sin(angle), std::cos(angle);
            layer.linear *= 1 - 0.03 * l;
            layer.offset << 0.01 * l, 0, 0, 0.12 * l;
            made.layers.push_back(layer);
        }
        return made;
    }

    /// Two bodies of one mesh with regions in R^4, of which one is held at an end and the other
    /// falls on it.
    static std::string twins(const std::string& mesh) {
        std::string scene = kTwins;
        for (std::size_t at = 0; (at = scene.find("MESH")) != std::string::npos;) {
            scene.replace(at, 4, mesh);
        }
        return scene;
    }

    static constexpr const char* kTwins = R"([scene]
gravity = [0, -9.8, 0, 0]
frames = 4
frames_per_second = 100

[[body]]
name = "a"
mesh = "MESH.pent"
material = { young = 1e5 }
[[body.region]]
name = "stiff"
select = { region = 7 }
material = { young = 1e6 }

[[body]]
name = "b"
mesh = "MESH.pent"
material = { young = 1e5 }
place = { translate = [0.05, 0.415, 0.02, 0.03] }
velocity = [0, -3, 0, 0]

[[constraint]]
body = "a"
select = { half_space = { normal = [1, 0, 0, 0], offset = -0.2 } }

[contact]
distance = 0.02
stiffness = 1000

[solver]
integrator = "newton_euler"
tolerance = 1e-8
precision = "double"
)";

    // A bar in R^4 that is turned by its left end, falls and is damped.
    static constexpr const char* kBar = R"([scene]
gravity = [0, -9.8, 0, 0]
frames = 4

[damping]
mass = 0.1
stiffness = 0.002

[[body]]
name = "bar"
mesh = "bar.pent"
material = { young = 1e5 }

[[constraint]]
body = "bar"
select = { half_space = { normal = [1, 0, 0, 0], offset = 1e-6 } }
motion = { rotate = [{ plane = "wx", degrees_per_s = 60 }] }

[solver]
integrator = "bdf2"
tolerance = 1e-8
newton_tolerance = 1e-7
precision = "double"
)";

    // Two boxes in R^3, one of which falls on the other, which lies on a floor.
    static constexpr const char* kBoxes = R"([scene]
dimension = 3
gravity = [0, -9.8, 0]
frames = 4
frames_per_second = 100

[[body]]
name = "a"
mesh = "box.pent"
material = { young = 1e5 }

[[body]]
name = "b"
mesh = "box.pent"
material = { young = 1e5 }
place = { translate = [0.1, 0.53, 0.05] }
velocity = [0.3, -2, 0]

[[obstacle]]
half_space = { normal = [0, 1, 0], offset = -0.005 }

[contact]
distance = 0.02
stiffness = 1000
friction = 0.3

[solver]
integrator = "newton_euler"
tolerance = 1e-8
newton_tolerance = 1e-7
precision = "double"
)";

    TempFolder folder_;
};

}  // namespace pent::test
