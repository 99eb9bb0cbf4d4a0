#include "sound_base.h"

#include "moving_shapes.h"
#include "support/messages.h"
#include "support/temp_folder.h"

#include <pent/mesher/edge_order.h>
#include <pent/mesher/links.h>
#include <pent/mesher/make_body.h>
#include <pent/mesher/moving_mesh.h>
#include <pent/mesher/straight_layers.h>

#include <gtest/gtest.h>

#include <array>
#include <string>
#include <vector>

namespace pent::mesher {
namespace {

// A tetrahedron on one side of the plane z = 0 and its mirror image on the other, with that many
// corners in common: they touch in nothing, a point, an edge, or share a triangle.
SimplexMesh<3> two_tetrahedra(int common) {
    SimplexMesh<3> mesh;
    mesh.positions.resize(3, 8);
    mesh.positions << 1, 2, 1.5, 1.5, 1, 2, 1.5, 1.5,  //
        4, 4, 5, 4.3, 4, 4, 5, 4.3,                    //
        0, 0.5, 0.5, 1, 0, -0.5, -0.5, -1;
    for (int k = 0; k < common; ++k) {
        mesh.positions(2, k) = 0;
    }
    mesh.cells.resize(4, 2);
    mesh.cells << 0, 4, 1, 5, 2, 6, 3, 7;
    for (int k = 0; k < common; ++k) {
        mesh.cells(k, 1) = static_cast<std::uint32_t>(k);
    }
    if (common == 0) {
        mesh.positions.rightCols(4).row(2).array() -= 1;
    }
    std::swap(mesh.cells(2, 1), mesh.cells(3, 1));
    return mesh;
}

// The file of a mesh without the points that no cell has.
std::string medit(const SimplexMesh<3>& mesh) {
    std::string text = "MeshVersionFormatted 2\nDimension 3\nVertices "
                       + std::to_string(mesh.vertex_count()) + "\n";
    for (const auto& x : mesh.positions.colwise()) {
        text += formatted("%.17g %.17g %.17g 0\n", x[0], x[1], x[2]);
    }
    text += "Tetrahedra " + std::to_string(mesh.cell_count()) + "\n";
    for (const auto& cell : mesh.cells.colwise()) {
        text += formatted("%u %u %u %u 0\n", cell[0] + 1, cell[1] + 1, cell[2] + 1, cell[3] + 1);
    }
    return text + "End\n";
}

// What is wrong with them, as every way to a body has it; empty if nothing is.
std::string error_of_body(const SimplexMesh<3>& mesh, int dimension, bool is_moving) {
    const test::TempFolder folder;
    BodyRequest request;
    if (is_moving) {
        for (const char* name : {"f0.vtk", "f1.vtk"}) {
            test::write_file(folder / name, test::to_legacy_vtk(test::parts_of(mesh)));
        }
    } else {
        test::write_file(folder / "f0.mesh", medit(mesh));
        request.input = folder / "f0.mesh";
    }
    try {
        if (is_moving) {
            static_cast<void>(read_moving_mesh(folder / "f0.vtk", {.time_step = 1}));
        } else if (dimension == 3) {
            static_cast<void>(make_solid(request));
        } else {
            static_cast<void>(make_body(request));
        }
    } catch (const Error& error) {
        return error.what();
    }
    return "";
}

// What is taken is what is sound as an extruded body, too.
TEST(SoundBase, RefusesWhatTouchesInAPointOrAnEdgeAlone) {
    const std::array<std::string, 4> found = {
        "", "parts touch in a point alone, once, first at (1, 4, 0); join them",
        "parts touch in an edge alone, once, first from (1, 4, 0) to (2, 4, 0); join them", ""};
    for (int common = 0; common < 4; ++common) {
        const SimplexMesh<3> mesh = two_tetrahedra(common);
        for (const int dimension : {3, 4}) {
            for (const bool is_moving : {false, true}) {
                const std::string error = error_of_body(mesh, dimension, is_moving);
                SCOPED_TRACE(std::to_string(common) + " in " + std::to_string(dimension) + ": "
                             + error);
                EXPECT_EQ(error.empty(), found[common].empty());
                test::expect_contains(error, {found[common]});
            }
        }
        const std::vector<std::uint32_t> ranks = {0, 1, 2, 3, 4, 5, 6, 7};
        const SimplexMesh<4> extruded =
            extrude<4>(mesh, order_cells<3>(mesh, direct_edges<3>(mesh, ranks)),
                       straight_layers<4>(Eigen::Vector4d(0, 0, 0, 1), 2));
        EXPECT_EQ(prove(extruded).holds() && check_links(extruded).faulty == 0,
                  found[common].empty())
            << common;
    }
}

TEST(SoundBase, CountsThePlacesWherePartsTouch) {
    // Cubes of 4 x 4 x 4 like the dark ones of a chessboard in space: those of a layer touch in
    // edges along z, those of two layers in edges along x or y.
    SimplexMesh<3> board = test::kuhn_box<3>({2, 2, 2}, {2, 2, 2});
    Simplices<4> kept(4, 24);
    int next = 0;
    for (const int cube : {0, 3, 5, 6}) {
        kept.middleCols(6 * next++, 6) = board.cells.middleCols(6 * cube, 6);
    }
    board.cells = kept;
    test::expect_contains(test::error_of([&] { require_sound_base(board, "board"); }),
                          {"board: parts touch in an edge alone, 6 times, first from (", " to ("});
    Simplices<4> corners(4, 12);
    SimplexMesh<3> box = test::kuhn_box<3>({2, 2, 2}, {2, 2, 2});
    corners << box.cells.middleCols(0, 6), box.cells.middleCols(42, 6);
    box.cells = corners;
    test::expect_contains(test::error_of([&] { require_sound_base(box, "box"); }),
                          {"box: parts touch in a point alone, once, first at (1, 1, 1)"});
}

TEST(SoundBase, SaysOfTetrahedraThroughOneAnotherThatTheyDoNotFit) {
    SimplexMesh<3> mesh = two_tetrahedra(3);
    mesh.positions(2, 7) = 0.7;  // both on one side of their triangle
    std::swap(mesh.cells(2, 1), mesh.cells(3, 1));
    test::expect_contains(test::error_of([&] { require_sound_base(mesh, "pair"); }),
                          {"pair: the tetrahedra do not fit together: 1 of 7 facets", "m^3"});
    // A third one at the same triangle, so that its edges have three triangles of the boundary.
    SimplexMesh<3> three = two_tetrahedra(3);
    three.cells.conservativeResize(4, 3);
    three.cells.col(2) = three.cells.col(0);
    three.cells(3, 2) = 4;
    three.positions.col(4) << 1.6, 4.2, 0.5;
    test::expect_contains(test::error_of([&] { require_sound_base(three, "three"); }),
                          {"three: the tetrahedra do not fit together: 1 of 10 facets"});
}

}  // namespace
}  // namespace pent::mesher
