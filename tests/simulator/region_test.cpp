#include "potential_laws.h"
#include "potentials/elasticity.h"
#include "support/messages.h"

#include <pent/simulator/energy.h>
#include <pent/simulator/placed_mesh.h>
#include <pent/simulator/words.h>

#include <algorithm>
#include <cmath>

// Bodies of several materials.

namespace pent::simulator {
namespace {

using pent::test::error_of;
using test::cube_for;
using test::Dimensions;
using test::expect_derivatives;
using test::Setting;
using test::shaken;
using test::value_of;

template <typename T>
class RegionTest : public testing::Test {};
TYPED_TEST_SUITE(RegionTest, Dimensions);

// Cells, or halves of quadratic ones, along an edge of a box of 0.5 m whose elements end in its
// middle.
int cells_of(ElementKind kind) {
    return kind == ElementKind::Quadratic ? 4 : 2;
}

// Two boxes of 0.5 m, of which the upper half along y, and of that a part, are something else.
template <int Dim>
Scene layered_boxes(ElementKind kind) {
    Scene scene = test::two_cubes<Dim>(0.3);
    scene.contact.reset();
    scene.solver.elements = kind;
    Region upper;
    upper.name = "upper";
    upper.select = {HalfSpaceSelection{-Eigen::VectorXd::Unit(Dim, 1), -0.25}};
    upper.material.lame = lame_from_young(Dim, 1e7, 0.1);
    upper.material.density = 3000;
    Region right = upper;
    right.name = "right";
    right.select = {HalfSpaceSelection{-Eigen::VectorXd::Unit(Dim, 0), -0.25}};
    right.material.model = Model::Arap;
    scene.bodies[0].regions = {upper, right};
    return scene;
}

TYPED_TEST(RegionTest, HaveTheirDensityAndOfTwoTheLaterOneCounts) {
    constexpr int kDim = TypeParam::value;
    for (const ElementKind kind : test::kElementKinds) {
        Scene scene = layered_boxes<kDim>(kind);
        scene.bodies[0].regions[1].material.density = 500;
        const Setting<kDim> setting(scene, cells_of(kind));
        const double box = std::pow(0.5, kDim);
        // a: half of 500, a quarter of 3000, a quarter of 1000; b: 1000.
        const double expected =
            box * (0.5 * 500 + 0.25 * 3000 + 0.25 * 1000) + box * scene.bodies[1].material.density;
        EXPECT_NEAR(setting.bodies.masses.sum(), expected, 1e-9 * expected);
        ASSERT_EQ(setting.bodies.ranges.size(), 4);
        Eigen::Index cells = 0;
        for (const CellRange& range : setting.bodies.ranges) {
            EXPECT_EQ(range.begin, cells);
            cells = range.end;
        }
        EXPECT_EQ(cells, setting.bodies.cells().cols());
    }
}

// All cells are there once, in another order.
TYPED_TEST(RegionTest, KeepTheCellsOfTheMeshAndKnowWhichIsWhich) {
    constexpr int kDim = TypeParam::value;
    for (const ElementKind kind : test::kElementKinds) {
        const Setting<kDim> setting(layered_boxes<kDim>(kind), 2);
        const Bodies<kDim>& bodies = setting.bodies;
        for (std::size_t body = 0; body < 2; ++body) {
            const auto range = bodies.cells_of(body);
            std::vector<bool> is_there(static_cast<std::size_t>(range.size), false);
            for (Eigen::Index cell = range.begin; cell < range.begin + range.size; ++cell) {
                const std::uint32_t own = bodies.mesh_cell(body, cell);
                EXPECT_EQ((bodies.cells().col(cell).array()
                           - static_cast<std::uint32_t>(bodies.first_vertex[body]))
                              .matrix(),
                          bodies.meshes[body].cells.col(own));
                is_there[own] = true;
            }
            EXPECT_EQ(std::count(is_there.begin(), is_there.end(), false), 0);
        }
    }
}

TYPED_TEST(RegionTest, HaveTheDerivativesOfTheirEnergyAndAddUpToAll) {
    constexpr int kDim = TypeParam::value;
    for (const ElementKind kind : test::kElementKinds) {
        const Scene scene = layered_boxes<kDim>(kind);
        const Setting<kDim> setting(scene, 3);
        Elasticity<kDim> elasticity(setting.workers, setting.isa, setting.bodies, setting.held,
                                    scene);
        const Positions<kDim> x = shaken<kDim>(setting.bodies.rest(), 0.02, 3);
        const double energy = value_of<kDim>(elasticity, x);
        const std::vector<double> parts = elasticity.energy_of_ranges();
        ASSERT_EQ(parts.size(), 4);
        EXPECT_GT(*std::min_element(parts.begin(), parts.end()), 0);
        EXPECT_NEAR(parts[0] + parts[1] + parts[2] + parts[3], energy, 1e-12 * energy);
        expect_derivatives<kDim>(setting, *elasticity.pattern(), elasticity, x);
    }
}

// Linear and quadratic elements only sum up; smoothed ones have other domains at a border.
TYPED_TEST(RegionTest, OfTheSameMaterialChangeNothing) {
    constexpr int kDim = TypeParam::value;
    for (const ElementKind kind : {ElementKind::Linear, ElementKind::Quadratic}) {
        Scene scene = layered_boxes<kDim>(kind);
        for (Region& region : scene.bodies[0].regions) {
            region.material = scene.bodies[0].material;
        }
        Scene plain = scene;
        plain.bodies[0].regions.clear();
        const auto energy = [&](const Scene& of) {
            const Setting<kDim> setting(of, 2);
            Elasticity<kDim> elasticity(setting.workers, setting.isa, setting.bodies, setting.held,
                                        of);
            return value_of<kDim>(elasticity, shaken<kDim>(setting.bodies.rest(), 0.02, 4));
        };
        EXPECT_NEAR(energy(scene), energy(plain), 1e-12 * energy(plain));
    }
}

// A cube of young 1e5 Pa, with four times as much beyond the middle of an axis, held at one end of
// the first axis and pulled by 1e-5 m at the other: so little that elasticity is linear. It does
// not contract sideways.
template <int Dim>
Scene pulled_cube(ElementKind kind, int stiff_along) {
    Scene scene = test::box_scene<Dim>();
    scene.solver.elements = kind;
    scene.solver.integrator = Integrator::Quasistatic;
    scene.solver.precision = Precision::Double;
    scene.solver.tolerance = 1e-10;
    scene.solver.newton_tolerance = 1e-9;
    scene.bodies[0].material.lame = lame_from_young(Dim, 1e5, 0);
    Region stiff;
    stiff.name = "stiff";
    stiff.select = {HalfSpaceSelection{-Eigen::VectorXd::Unit(Dim, stiff_along), -0.25}};
    stiff.material.lame = lame_from_young(Dim, 4e5, 0);
    scene.bodies[0].regions = {stiff};
    scene.constraints = {
        test::hold(HalfSpaceSelection{Eigen::VectorXd::Unit(Dim, 0), 1e-9}, test::still(Dim))};
    Motion pull = test::still(Dim);
    pull.translate[0] = 1e-5 * scene.frames_per_second;
    scene.constraints.push_back(
        test::hold(HalfSpaceSelection{-Eigen::VectorXd::Unit(Dim, 0), -0.5 + 1e-9}, pull));
    return scene;
}

// Two springs in a row, of which one is four times as stiff: the soft half is stretched by 4/5.
TYPED_TEST(RegionTest, InARowStretchLikeSpringsInARow) {
    constexpr int kDim = TypeParam::value;
    for (const ElementKind kind : test::kElementKinds) {
        const Scene scene = pulled_cube<kDim>(kind, 0);
        Simulation<kDim> simulation(scene, {cube_for<kDim>(scene, cells_of(kind))});
        const StepReport report = simulation.step();
        ASSERT_TRUE(report.is_accepted) << report.failure;
        const SimplexMesh<kDim>& mesh = simulation.mesh(0);
        for (Eigen::Index v = 0; v < mesh.vertex_count(); ++v) {
            if (std::abs(mesh.positions(0, v) - 0.25) < 1e-9) {
                EXPECT_NEAR(simulation.positions(0)(0, v) - 0.25, 0.8e-5, 1e-8);
            }
        }
        ASSERT_EQ(report.regions.size(), 1);
        EXPECT_NEAR(report.regions[0].energy, 0.2 * report.energies.of("elastic"),
                    1e-3 * report.energies.of("elastic"));
    }
}

// Two springs side by side, as flesh around a bone: both are stretched alike, and their forces add
// up: strain 2e-5 times half the end of 0.5^(n - 1) m^(n - 1) times each Young's modulus.
TYPED_TEST(RegionTest, SideBySideAddUpTheirForces) {
    constexpr int kDim = TypeParam::value;
    for (const ElementKind kind : test::kElementKinds) {
        const Scene scene = pulled_cube<kDim>(kind, 1);
        Simulation<kDim> simulation(scene, {cube_for<kDim>(scene, cells_of(kind))});
        const StepReport report = simulation.step();
        ASSERT_TRUE(report.is_accepted) << report.failure;
        const double force = 2e-5 * std::pow(0.5, kDim - 1) * (1e5 + 4e5) / 2;
        EXPECT_NEAR(report.constraints.at(1).force[0], force, 1e-3 * force);
        EXPECT_NEAR(report.regions.at(0).energy, 0.8 * report.energies.of("elastic"),
                    1e-3 * report.energies.of("elastic"));
    }
}

TYPED_TEST(RegionTest, GoOnToTheSameBitsFromASnapshotAndWithAnyThreads) {
    constexpr int kDim = TypeParam::value;
    for (const ElementKind kind : test::kElementKinds) {
        Scene scene = layered_boxes<kDim>(kind);
        scene.gravity[1] = -9.8;
        scene.contact = ContactSettings{.distance = 0.05, .stiffness = 2e3};
        scene.bodies[1].velocity = -20 * Eigen::VectorXd::Unit(kDim, 1);
        const auto make = [&](int threads) {
            return Simulation<kDim>(scene, {cube_for<kDim>(scene, 3), cube_for<kDim>(scene, 3)},
                                    {.threads = threads});
        };
        Simulation<kDim> whole = make(1);
        Simulation<kDim> other = make(3);
        Simulation<kDim> resumed = make(2);
        for (int i = 0; i < 4; ++i) {
            const StepReport report = whole.step();
            EXPECT_EQ(other.step().regions[1].energy, report.regions[1].energy);
            if (i == 1) {
                resumed.restore(whole.save());
            } else if (i > 1) {
                EXPECT_EQ(resumed.step().regions[1].energy, report.regions[1].energy);
            }
        }
        EXPECT_EQ(whole.positions(0), other.positions(0));
        EXPECT_EQ(whole.positions(0), resumed.positions(0));
    }
}

TYPED_TEST(RegionTest, AreSelectedByCentersLayersAndLabels) {
    constexpr int kDim = TypeParam::value;
    SimplexMesh<kDim> mesh = test::cube<kDim>(2);
    for (Eigen::Index v = 0; v < mesh.vertex_count(); ++v) {
        mesh.layers.push_back(static_cast<std::uint32_t>(std::lround(mesh.positions(0, v) / 0.25)));
    }
    for (Eigen::Index cell = 0; cell < mesh.cell_count(); ++cell) {
        mesh.regions.push_back(static_cast<std::uint16_t>(cell % 3));
    }
    const auto half = static_cast<std::ptrdiff_t>(mesh.cell_count() / 2);
    const auto count = [&](const Selection& selection) {
        const std::vector<bool> is_in = select_cells(mesh, {selection}, "it");
        return std::count(is_in.begin(), is_in.end(), true);
    };
    EXPECT_EQ(count(LayerSelection{0, 1}), half);
    EXPECT_EQ(count(LayerSelection{0, 2}), 2 * half);
    EXPECT_EQ(count(HalfSpaceSelection{Eigen::VectorXd::Unit(kDim, 0), 0.25}), half);
    EXPECT_EQ(count(EverythingSelection{}), 2 * half);
    EXPECT_EQ(count(RegionSelection{1}), (2 * half + 1) / 3);
    EXPECT_EQ(error_of([&] { count(LayerSelection{0, 0}); }).substr(0, 19), "it selects no cell:");
}

TYPED_TEST(RegionTest, AreRefusedWithoutANameOrWithNothingInThem) {
    constexpr int kDim = TypeParam::value;
    Scene scene = layered_boxes<kDim>(ElementKind::Linear);
    const auto error = [&] { return error_of([&] { const Setting<kDim> setting(scene, 2); }); };
    scene.bodies[0].regions[1].name = "upper";
    EXPECT_EQ(error(), "body \"a\": two regions have the name \"upper\"");
    scene.bodies[0].regions[1].name = "";
    EXPECT_NE(error().find("body \"a\": the name of the region \"\" may have letters"),
              std::string::npos);
    scene.bodies[0].regions[1].name = "right";
    scene.bodies[0].regions[1].source = "s.toml:9:1";
    scene.bodies[0].regions[1].select = {RegionSelection{7}};
    pent::test::expect_contains(
        error(),
        {"s.toml:9:1: region \"right\" selects no cell: the mesh has no regions; the body"});
}

}  // namespace
}  // namespace pent::simulator
