#include "fields_of_base.h"
#include "support/messages.h"
#include "support/temp_folder.h"

#include <pent/mesher/make_body.h>
#include <pent/mesher/read_tetrahedra.h>

#include <Eigen/LU>
#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <map>
#include <set>
#include <string>
#include <vector>

namespace pent::mesher {
namespace {

using test::base_box;
using test::first_edge;
using test::warmth;

template <int Dim>
const Eigen::MatrixXd& field(const Body<Dim>& body, const std::string& name) {
    for (const std::vector<VertexField>* fields :
         {&body.extras.vertex_fields, &body.extras.cell_fields}) {
        for (const VertexField& one : *fields) {
            if (one.name == name) {
                return one.values;
            }
        }
    }
    throw Error("no " + name);
}

struct Case {
    std::string name;
    std::function<void(BodyRequest&)> change;
};

class ExtrudedFields : public testing::Test {
protected:
    Body<4> body(const std::function<void(BodyRequest&)>& change) {
        test::write_file(folder_ / "a.vtk", test::vtk_with_fields(base_));
        test::write_file(folder_ / "turning.txt",
                         "-1 1\n0 0.7  0.1 0 0.3  20 0 10 0 0 0\n1 0.5  0.4 0 0  0 15 -8 0 5 0\n");
        BodyRequest request;
        request.input = folder_ / "a.vtk";
        request.extrusion.layers = 3;
        change(request);
        return make_body(request);
    }

    // Where vertices of a column of the base are, layer by layer.
    static std::map<std::uint32_t, Eigen::Vector4d> way_of(const SimplexMesh<4>& mesh,
                                                           std::uint32_t column) {
        std::map<std::uint32_t, Eigen::Vector4d> way;
        for (Eigen::Index v = 0; v < mesh.vertex_count(); ++v) {
            if (mesh.columns[v] == column) {
                way[mesh.layers[v]] = mesh.positions.col(v);
            }
        }
        return way;
    }

    const SimplexMesh<3> base_ = base_box();
    const test::TempFolder folder_;
    const std::vector<Case> whole_ = {
        {"straight", [](BodyRequest&) {}},
        {"leaning",
         [](BodyRequest& r) {
             r.extrusion.direction = Eigen::Vector4d(0.1, 0.2, 0.3, -0.5);
             r.extrusion.order = VertexOrder::Quality;
         }},
        {"turning",
         [this](BodyRequest& r) {
             r.extrusion.layers = 0;
             r.extrusion.profile = folder_ / "turning.txt";
         }},
        {"round", [](BodyRequest& r) { r.extrusion.round = true; }},
        {"moved", [](BodyRequest& r) { r.translation = Eigen::Vector4d(1, 2, 3, 4); }}};
    const std::vector<Case> cut_ = {{"subdivided", [](BodyRequest& r) { r.subdivide = 3; }},
                                    {"quadratic", [](BodyRequest& r) {
                                         r.subdivide = 2;
                                         r.is_quadratic = true;
                                     }}};
};

// The origin is a vertex of the base, and a layer moves it by the offset alone: what is left of a
// place is `linear` times that in the base.
TEST_F(ExtrudedFields, MoveVectorsOfVerticesAsLayersMovePoints) {
    for (std::vector<Case> cases : {whole_, cut_}) {
        for (const Case& one : cases) {
            const Body<4> made = body(one.change);
            const std::map<std::uint32_t, Eigen::Vector4d> origin = way_of(made.mesh, 0);
            const Eigen::MatrixXd& place = field(made, "place");
            ASSERT_EQ(place.cols(), made.mesh.vertex_count()) << one.name;
            for (Eigen::Index v = 0; v < made.mesh.vertex_count(); ++v) {
                const auto offset = origin.find(made.mesh.layers[v]);
                const Eigen::Vector4d expected =
                    offset == origin.end()
                        ? Eigen::Vector4d(0, 0, 0, 0)  // of the points at both ends
                        : Eigen::Vector4d(made.mesh.positions.col(v) - offset->second);
                // Rounding of numbers below 10.
                EXPECT_LT((place.col(v) - expected).norm(), 1e-14) << one.name << " " << v;
            }
        }
    }
}

TEST_F(ExtrudedFields, GiveEveryCopyOfAVertexTheSameNumber) {
    for (const Case& one : whole_) {
        const Body<4> made = body(one.change);
        const Eigen::MatrixXd& values = field(made, "warmth");
        double mean = 0;
        for (const auto& x : base_.positions.colwise()) {
            mean += warmth(x) / static_cast<double>(base_.vertex_count());
        }
        for (Eigen::Index v = 0; v < made.mesh.vertex_count(); ++v) {
            const std::uint32_t column = made.mesh.columns[v];
            const bool is_end = column >= base_.vertex_count();
            const double expected = is_end ? mean : warmth(base_.positions.col(column));
            EXPECT_NEAR(values(0, v), expected, is_end ? 1e-14 : 0) << one.name << " " << v;
        }
    }
}

TEST_F(ExtrudedFields, StayLinearWhenCellsAreCut) {
    for (const Case& one : cut_) {
        const Body<4> made = body(one.change);
        const Eigen::MatrixXd& values = field(made, "warmth");
        ASSERT_EQ(values.cols(), made.mesh.vertex_count());
        for (Eigen::Index v = 0; v < made.mesh.vertex_count(); ++v) {
            EXPECT_NEAR(values(0, v), warmth(made.mesh.positions.col(v).head<3>()), 1e-14)
                << one.name << " " << v;
        }
        // A cell is over the one of the base that its middle is over.
        const Eigen::MatrixXd& numbers = field(made, "number");
        ASSERT_EQ(numbers.cols(), made.mesh.cell_count());
        for (Eigen::Index cell = 0; cell < made.mesh.cell_count(); ++cell) {
            Eigen::Vector3d middle = Eigen::Vector3d::Zero();
            for (const std::uint32_t corner : made.mesh.cells.col(cell)) {
                middle += made.mesh.positions.col(corner).head<3>() / 5;
            }
            const auto number = static_cast<Eigen::Index>(numbers(0, cell));
            Eigen::Matrix4d corners;
            for (int k = 0; k < 4; ++k) {
                corners.col(k) << base_.positions.col(base_.cells(k, number)), 1;
            }
            const Eigen::Vector4d weights =
                corners.inverse() * Eigen::Vector4d(middle[0], middle[1], middle[2], 1);
            EXPECT_GT(weights.minCoeff(), 0) << one.name << " " << cell;
            EXPECT_EQ(made.mesh.fibers.col(cell).head<3>(), first_edge(base_, number));
            EXPECT_EQ(made.mesh.fibers(3, cell), 0);
        }
    }
}

// A cell is known by its columns. Its layers are two, in which the edge of the base is where its
// ends are.
TEST_F(ExtrudedFields, TurnFibersWithTheEdgesThatTheyAre) {
    std::map<std::set<std::uint32_t>, Eigen::Index> cell_over;
    for (Eigen::Index cell = 0; cell < base_.cell_count(); ++cell) {
        cell_over[{base_.cells.col(cell).begin(), base_.cells.col(cell).end()}] = cell;
    }
    for (const Case& one : whole_) {
        const Body<4> made = body(one.change);
        const SimplexMesh<4>& mesh = made.mesh;
        ASSERT_EQ(mesh.fibers.cols(), mesh.cell_count()) << one.name;
        std::vector<std::map<std::uint32_t, Eigen::Vector4d>> ways;
        for (Eigen::Index column = 0; column < base_.vertex_count(); ++column) {
            ways.push_back(way_of(mesh, static_cast<std::uint32_t>(column)));
        }
        for (Eigen::Index cell = 0; cell < mesh.cell_count(); ++cell) {
            std::set<std::uint32_t> columns;
            std::set<std::uint32_t> layers;
            for (const std::uint32_t corner : mesh.cells.col(cell)) {
                layers.insert(mesh.layers[corner]);
                if (mesh.columns[corner] < base_.vertex_count()) {
                    columns.insert(mesh.columns[corner]);
                }
            }
            const Eigen::Index below = cell_over.at(columns);
            EXPECT_EQ(field(made, "number")(0, cell), static_cast<double>(below)) << one.name;
            Eigen::Vector4d expected = Eigen::Vector4d::Zero();
            ASSERT_EQ(layers.size(), 2U);
            for (const std::uint32_t layer : layers) {
                const auto& from = ways[base_.cells(0, below)];
                const auto& to = ways[base_.cells(1, below)];
                if (from.contains(layer)) {  // in a point the edge is nothing
                    expected += (to.at(layer) - from.at(layer)) / 2;
                }
            }
            EXPECT_LT((mesh.fibers.col(cell) - expected).norm(), 1e-14) << one.name << " " << cell;
        }
    }
}

TEST_F(ExtrudedFields, AreThoseOfTheFileInThreeDimensions) {
    test::write_file(folder_ / "a.vtk", test::vtk_with_fields(base_));
    for (const bool is_quadratic : {false, true}) {
        BodyRequest request;
        request.input = folder_ / "a.vtk";
        request.is_quadratic = is_quadratic;
        const Body<3> made = make_solid(request);
        ASSERT_EQ(field(made, "place").cols(), made.mesh.vertex_count());
        EXPECT_LT((field(made, "place") - made.mesh.positions).norm(), 1e-14);
        const int children = is_quadratic ? 8 : 1;
        for (Eigen::Index cell = 0; cell < made.mesh.cell_count(); ++cell) {
            EXPECT_EQ(field(made, "number")(0, cell), static_cast<double>(cell / children));
            EXPECT_EQ(made.mesh.fibers.col(cell), first_edge(base_, cell / children));
        }
    }
}

TEST_F(ExtrudedFields, AreLeftOutWithAWordWhereBaseAndLayersAreKept) {
    const Body<4> made = body([](BodyRequest& r) { r.extrusion.is_kept = true; });
    EXPECT_TRUE(made.extras.vertex_fields.empty() && made.extras.cell_fields.empty());
    EXPECT_EQ(made.mesh.fibers.cols(), 0);
    test::expect_contains(made.report.left_out,
                          {"warmth (base and layers have no place for it), place (", "number (",
                           "fibers (base and layers have no place for it)"});
}

TEST(ReadTetrahedra, SaysWhichArraysAreNoQuantitiesOfABody) {
    const test::TempFolder folder;
    test::write_file(folder / "a.vtk",
                     test::to_legacy_vtk(test::parts_of(test::kuhn_box<3>({1, 1, 1}, {1, 1, 1})))
                         + "CELL_DATA 6\nFIELD f 4\npair 2 6 int\n1 2 3 4 5 6 7 8 9 10 11 12\n"
                           "hole 1 6 double\n1 2 nan 4 5 6\nage 1 6 int\n1 2 3 4 5 6\n"
                           "age 1 6 int\n1 2 3 4 5 6\n");
    const TetrahedraFile file = read_tetrahedra(folder / "a.vtk");
    EXPECT_EQ(file.left_out,
              "array pair of 2 components, array age, a second one, array hole, which some cells do"
              " not have in finite numbers");
    ASSERT_EQ(file.extras.cell_fields.size(), 1U);
    EXPECT_EQ(file.extras.cell_fields[0].name, "age");
}

}  // namespace
}  // namespace pent::mesher
