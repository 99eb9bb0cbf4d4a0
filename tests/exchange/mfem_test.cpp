#include "polytopes.h"
#include "support/kuhn_box.h"

#include <map>
#include <set>
#include <sstream>
#include <vector>

namespace pent::exchange {
namespace {

using test::error_as;
using test::read_as;
using test::text_as;

// Two layers over a cube, of two labels.
SimplexMesh<4> layered() {
    SimplexMesh<4> mesh = pent::test::kuhn_box<4>({1, 1, 1, 2}, {1, 1, 1, 2});
    for (std::uint32_t v = 0; v < mesh.vertex_count(); ++v) {
        mesh.columns.push_back(v % 8);
        mesh.layers.push_back(v / 8);
    }
    for (Eigen::Index cell = 0; cell < mesh.cell_count(); ++cell) {
        mesh.regions.push_back(cell % 2 == 0 ? 0 : 4);
    }
    return mesh;
}

TEST(Mfem, IsReadAsItWasWritten) {
    const SimplexMesh<4> mesh = layered();
    const auto again = std::get<Body>(read_as("a.mesh", text_as("a.mesh", Body{mesh}))).mesh;
    EXPECT_EQ(again.positions, mesh.positions);
    EXPECT_EQ(again.cells, mesh.cells);
    EXPECT_EQ(again.regions, mesh.regions);
    // Where all labels are 1 there are no regions; where all are another one, that is theirs.
    SimplexMesh<4> plain = mesh;
    plain.regions.clear();
    EXPECT_TRUE(
        std::get<Body>(read_as("a.mesh", text_as("a.mesh", Body{plain}))).mesh.regions.empty());
    plain.regions.assign(mesh.regions.size(), 1);
    EXPECT_EQ(std::get<Body>(read_as("a.mesh", text_as("a.mesh", Body{plain}))).mesh.regions,
              plain.regions);
}

// Labels are regions + 1, and those of the boundary may lie behind them.
TEST(Mfem, KeepsTheLargestRegion) {
    Body body{layered()};
    body.mesh.regions.back() = 65535;
    for (const bool has_mfem_attributes : {false, true}) {
        const std::string text =
            text_as("a.mesh", body, {.has_mfem_attributes = has_mfem_attributes});
        EXPECT_EQ(std::get<Body>(read_as("a.mesh", text)).mesh.regions, body.mesh.regions);
    }
}

// MFEM wants det[v1 - v0, ..., v4 - v0] > 0, or it swaps corners and with them their order.
TEST(Mfem, HasPositivePentatopesOfTheHypervolumeOfTheBody) {
    std::istringstream text(text_as("a.mesh", Body{layered()}));
    std::string word;
    while (text >> word && word != "elements") {
    }
    int count = 0;
    text >> count;
    std::vector<std::array<int, 7>> elements(static_cast<std::size_t>(count));
    for (auto& element : elements) {
        for (int& number : element) {
            text >> number;
        }
        EXPECT_EQ(element[1], 8);
    }
    while (text >> word && word != "vertices") {
    }
    int dimension = 0;
    text >> count >> dimension;
    std::vector<Eigen::Vector4d> points(static_cast<std::size_t>(count));
    for (Eigen::Vector4d& point : points) {
        text >> point[0] >> point[1] >> point[2] >> point[3];
    }
    double sum = 0;
    for (const auto& element : elements) {
        Eigen::Matrix4d edges;
        for (std::size_t i = 0; i < 4; ++i) {
            edges.col(static_cast<Eigen::Index>(i)) =
                points.at(static_cast<std::size_t>(element.at(3 + i)))
                - points.at(static_cast<std::size_t>(element[2]));
        }
        EXPECT_GT(edges.determinant(), 0);
        sum += edges.determinant() / 24;
    }
    EXPECT_NEAR(sum, 2, 1e-14);
}

// How many tetrahedra of the boundary have each label.
std::map<int, int> labels_of(const std::string& text) {
    std::istringstream lines(text.substr(text.find("boundary\n")));
    std::string word;
    int count = 0;
    lines >> word >> count;
    std::map<int, int> labels;
    for (int i = 0; i < count; ++i) {
        std::array<int, 6> entry{};
        for (int& number : entry) {
            lines >> number;
        }
        EXPECT_EQ(entry[1], 4);
        ++labels[entry[0]];
    }
    return labels;
}

// 6 tetrahedra in each end, and the side of a cube of 6 squares over two layers.
TEST(Mfem, LabelsBottomSidesAndTop) {
    EXPECT_EQ(labels_of(text_as("a.mesh", Body{layered()})),
              (std::map<int, int>{{1, 6}, {2, 6 * 6 * 2}, {3, 6}}));
    std::map<int, int> labels =
        labels_of(text_as("a.mesh", Body{layered()}, {.has_mfem_attributes = true}));
    EXPECT_EQ(labels[1] + labels[5], 6);  // as the cells behind them
    EXPECT_EQ(labels[6], 6 * 6 * 2);
    EXPECT_EQ(labels[7], 6);
    SimplexMesh<4> plain = layered();
    plain.regions.clear();
    EXPECT_EQ(labels_of(text_as("a.mesh", Body{plain}, {.has_mfem_attributes = true})),
              (std::map<int, int>{{1, 6}, {2, 6 * 6 * 2}, {3, 6}}));
    SimplexMesh<4> flat = layered();
    flat.layers.clear();
    flat.columns.clear();
    EXPECT_EQ(labels_of(text_as("a.mesh", Body{flat})), (std::map<int, int>{{1, 84}}));
    EXPECT_EQ(labels_of(text_as("a.mesh", Body{flat}, {.has_mfem_attributes = true})),
              (std::map<int, int>{{1, 84}}));
    SimplexMesh<4> later = layered();  // a slab that does not begin at the first layer of all
    for (std::uint32_t& layer : later.layers) {
        layer += 3;
    }
    EXPECT_EQ(labels_of(text_as("a.mesh", Body{later})),
              labels_of(text_as("a.mesh", Body{layered()})));
}

// A cut between slabs of space-time is not the bottom or the top of all; what has no label, or 0,
// has that of its place.
TEST(Mfem, KeepsTheLabelsOfTheBoundary) {
    Body body{layered()};
    const TetSurface boundary = boundary_of(body.mesh);  // all vertices are on it
    std::vector<Eigen::Index> labeled;
    for (Eigen::Index f = 0; f < boundary.tetrahedra.cols(); ++f) {
        const Eigen::RowVector4d w = boundary.points(3, boundary.tetrahedra.col(f));
        if ((w.array() == 0).all() || (w.array() == 2).all()) {
            labeled.push_back(f);
            body.extras.labels.push_back(w[0] == 0 ? 4 : 5);
        }
    }
    body.extras.boundary = boundary.tetrahedra(Eigen::all, labeled);
    body.extras.boundary.row(1).swap(body.extras.boundary.row(3));  // in any order of corners
    const std::map<int, int> kept = {{4, 6}, {2, 72}, {5, 6}};
    EXPECT_EQ(labels_of(text_as("a.mesh", body)), kept);
    // Behind the labels of the cells, 1 and 5.
    EXPECT_EQ(labels_of(text_as("a.mesh", body, {.has_mfem_attributes = true})),
              (std::map<int, int>{{8, 6}, {6, 72}, {9, 6}}));
    body.extras.labels[0] = 0;
    const int place = boundary.points(3, body.extras.boundary(0, 0)) == 0 ? 1 : 3;
    EXPECT_EQ(labels_of(text_as("a.mesh", body))[place], 1);
    // Without layers, too.
    body.mesh.layers.clear();
    body.mesh.columns.clear();
    body.extras.labels[0] = 7;
    EXPECT_EQ(labels_of(text_as("a.mesh", body))[7], 1);
    EXPECT_EQ(labels_of(text_as("a.mesh", body, {.has_mfem_attributes = true}))[11], 1);
}

// Facets and their labels, whatever the order of both.
std::map<std::set<std::uint32_t>, int> labels_of(const Body& body) {
    std::map<std::set<std::uint32_t>, int> labels;
    for (std::size_t f = 0; f < body.extras.labels.size(); ++f) {
        const auto corners = body.extras.boundary.col(static_cast<Eigen::Index>(f));
        labels[{corners.begin(), corners.end()}] = body.extras.labels[f];
    }
    return labels;
}

TEST(Mfem, ReadsTheLabelsOfTheBoundary) {
    const Body plain{layered()};
    const auto again = std::get<Body>(read_as("a.mesh", text_as("a.mesh", plain)));
    std::map<int, int> counts;
    for (const auto& [corners, label] : labels_of(again)) {
        ++counts[label];
    }
    EXPECT_EQ(counts, (std::map<int, int>{{1, 6}, {2, 72}, {3, 6}}));
    // Outward, so that a .pent file may have them: their volumes with a point inside are positive.
    const Eigen::Vector4d inside(0.5, 0.5, 0.5, 1);
    for (const auto& corners : again.extras.boundary.colwise()) {
        Eigen::Matrix4d edges;
        for (int k = 0; k < 4; ++k) {
            edges.col(k) = again.mesh.positions.col(corners[k]) - inside;
        }
        EXPECT_GT(edges.determinant(), 0);
    }
    // Labels of one's own are those that were written, and stay so.
    Body own = again;
    for (std::size_t f = 0; f < own.extras.labels.size(); ++f) {
        own.extras.labels[f] = static_cast<std::uint16_t>(65535 - f);
    }
    const auto copy = std::get<Body>(read_as("a.mesh", text_as("a.mesh", own)));
    EXPECT_EQ(labels_of(copy), labels_of(own));
    // Where all are 1, as without any, there are none.
    Body flat{layered()};
    flat.mesh.layers.clear();
    flat.mesh.columns.clear();
    EXPECT_TRUE(std::get<Body>(read_as("a.mesh", text_as("a.mesh", flat))).extras.labels.empty());
}

// As others write it: comments between sections, a negative pentatope.
TEST(Mfem, TurnsCellsOverThatAreNegative) {
    const std::string text =
        "MFEM mesh v1.0\n\n#\n# PENTATOPE = 8\n#\n\ndimension\n4\n\nelements\n1\n3 8 0 1 2 4 3\n\n"
        "boundary\n0\n\nvertices\n5\n4\n0 0 0 0\n1 0 0 0\n0 1 0 0\n0 0 1 0\n0 0 0 1\n";
    const SimplexMesh<4> mesh = std::get<Body>(read_as("a.mfem", text)).mesh;
    EXPECT_NEAR(total_volume(mesh), 1.0 / 24, 1e-16);
    EXPECT_EQ(mesh.regions, std::vector<std::uint16_t>{2});
}

TEST(Mfem, NamesTheLineOfWhatIsWrong) {
    pent::test::expect_contains(error_as("a.mesh", "MeshVersionFormatted 2\n"),
                                {"line 1: ", "found \"MeshVersionFormatted\", expected \"MFEM\""});
    pent::test::expect_contains(error_as("a.mesh", "abcdefghijklmnopqrstuvwxyz\n"),
                                {"found \"abcdefghijklmnopqrst\", expected \"MFEM\""});
    pent::test::expect_contains(error_as("a.mesh", "MFEM mesh v1.0\ndimension\n1\n"),
                                {"a mesh of 1 dimension; expected 4"});
    pent::test::expect_contains(error_as("a.mesh", "MFEM mesh v1.0\ndimension\n3\n"),
                                {"line 3: ", "3 dimensions"});
    std::string text = text_as("a.mesh", Body{layered()});
    const auto replaced = [&](const std::string& from, const std::string& to) {
        std::string bad = text;
        bad.replace(bad.find(from), from.size(), to);
        return error_as("a.mesh", bad);
    };
    pent::test::expect_contains(replaced("1 8 0", "1 9 0"),
                                {"line 10: ", "kind 9; expected 8, a pentatope"});
    pent::test::expect_contains(replaced("1 8 0", "0 8 0"), {"line 10: ", "label of 0"});
    pent::test::expect_contains(replaced("1 8 0", "65537 8 0"),
                                {"line 10: ", "label of 65537", "expected 1 to 65536"});
    pent::test::expect_contains(replaced("1 8 0", "1 8 99"), {"index 99 of 24"});
    pent::test::expect_contains(replaced("\n4\n0 0 0 0", "\n3\n0 0 0 0"),
                                {"found \"3\", expected 4 coordinates"});
    EXPECT_NE(error_as("a.mesh", text.substr(0, text.size() / 2)), "");
}

}  // namespace
}  // namespace pent::exchange
