#include "polytopes.h"
#include "support/kuhn_box.h"

#include <map>
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
    const auto again = std::get<SimplexMesh<4>>(read_as("a.mesh", text_as("a.mesh", mesh)));
    EXPECT_EQ(again.positions, mesh.positions);
    EXPECT_EQ(again.cells, mesh.cells);
    EXPECT_EQ(again.regions, mesh.regions);
}

// MFEM wants det[v1 - v0, ..., v4 - v0] > 0, or it swaps corners and with them their order.
TEST(Mfem, HasPositivePentatopesOfTheHypervolumeOfTheBody) {
    std::istringstream text(text_as("a.mesh", layered()));
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
    EXPECT_EQ(labels_of(text_as("a.mesh", layered())),
              (std::map<int, int>{{1, 6}, {2, 6 * 6 * 2}, {3, 6}}));
    std::map<int, int> labels =
        labels_of(text_as("a.mesh", layered(), {.has_mfem_attributes = true}));
    EXPECT_EQ(labels[1] + labels[5], 6);  // as the cells behind them
    EXPECT_EQ(labels[6], 6 * 6 * 2);
    EXPECT_EQ(labels[7], 6);
    SimplexMesh<4> flat = layered();
    flat.layers.clear();
    flat.columns.clear();
    EXPECT_EQ(labels_of(text_as("a.mesh", flat)), (std::map<int, int>{{1, 84}}));
}

// As others write it: comments between sections, a negative pentatope.
TEST(Mfem, TurnsCellsOverThatAreNegative) {
    const std::string text =
        "MFEM mesh v1.0\n\n#\n# PENTATOPE = 8\n#\n\ndimension\n4\n\nelements\n1\n3 8 0 1 2 4 3\n\n"
        "boundary\n0\n\nvertices\n5\n4\n0 0 0 0\n1 0 0 0\n0 1 0 0\n0 0 1 0\n0 0 0 1\n";
    const auto mesh = std::get<SimplexMesh<4>>(read_as("a.mfem", text));
    EXPECT_NEAR(total_volume(mesh), 1.0 / 24, 1e-16);
    EXPECT_EQ(mesh.regions, std::vector<std::uint16_t>{2});
}

TEST(Mfem, NamesTheLineOfWhatIsWrong) {
    pent::test::expect_contains(error_as("a.mesh", "MeshVersionFormatted 2\n"),
                                {"line 1: ", "expected \"MFEM\""});
    pent::test::expect_contains(error_as("a.mesh", "MFEM mesh v1.0\ndimension\n3\n"),
                                {"line 3: ", "3 dimensions"});
    std::string text = text_as("a.mesh", layered());
    const auto replaced = [&](const std::string& from, const std::string& to) {
        std::string bad = text;
        bad.replace(bad.find(from), from.size(), to);
        return error_as("a.mesh", bad);
    };
    pent::test::expect_contains(replaced("1 8 0", "1 9 0"), {"line 10: ", "kind 9"});
    pent::test::expect_contains(replaced("1 8 0", "0 8 0"), {"line 10: ", "label of 0"});
    pent::test::expect_contains(replaced("1 8 0", "1 8 99"), {"index 99 of 24"});
    pent::test::expect_contains(replaced("\n4\n0 0 0 0", "\n3\n0 0 0 0"), {"4 coordinates"});
    EXPECT_NE(error_as("a.mesh", text.substr(0, text.size() / 2)), "");
}

}  // namespace
}  // namespace pent::exchange
