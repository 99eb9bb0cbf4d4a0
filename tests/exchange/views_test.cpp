#include "polytopes.h"

#include <algorithm>
#include <sstream>
#include <vector>

namespace pent::exchange {
namespace {

using test::sixteen_cell;
using test::text_as;

// Points, tetrahedra and w as other programs will find them.
struct View {
    std::vector<Eigen::Vector4d> points;
    std::vector<std::vector<int>> tetrahedra;
};

TetSurface with_digits() {
    TetSurface surface = sixteen_cell();
    surface.points = 0.1 * surface.points.array() + 1.0 / 3;
    return surface;
}

void expect_all_of(const View& view, const TetSurface& surface) {
    ASSERT_EQ(static_cast<Eigen::Index>(view.points.size()), surface.points.cols());
    for (std::size_t p = 0; p < view.points.size(); ++p) {
        EXPECT_EQ(view.points[p], surface.points.col(static_cast<Eigen::Index>(p)));
    }
    ASSERT_EQ(static_cast<Eigen::Index>(view.tetrahedra.size()), surface.tetrahedra.cols());
    for (std::size_t t = 0; t < view.tetrahedra.size(); ++t) {
        for (int k = 0; k < 4; ++k) {
            EXPECT_EQ(view.tetrahedra[t][k],
                      static_cast<int>(surface.tetrahedra(k, static_cast<Eigen::Index>(t))));
        }
    }
}

void expect_words(std::istream& text, std::initializer_list<const char*> words) {
    for (const char* expected : words) {
        std::string word;
        text >> word;
        EXPECT_EQ(word, expected);
    }
}

TEST(LegacyVtk, HasTheBoundaryWithWAsAScalar) {
    const std::string all = text_as("a.vtk", with_digits());
    // A line for each point, twice, for each tetrahedron and its type, and ten others.
    EXPECT_EQ(std::count(all.begin(), all.end(), '\n'), 2 * 8 + 2 * 16 + 10);
    std::istringstream text(all);
    std::string line;
    std::getline(text, line);
    EXPECT_EQ(line, "# vtk DataFile Version 3.0");
    std::getline(text, line);
    EXPECT_LE(line.size(), 256U);  // as the format has it
    expect_words(text, {"ASCII", "DATASET", "UNSTRUCTURED_GRID", "POINTS", "8", "double"});
    View view{std::vector<Eigen::Vector4d>(8), {}};
    for (Eigen::Vector4d& point : view.points) {
        text >> point[0] >> point[1] >> point[2];
    }
    expect_words(text, {"CELLS", "16", "80"});
    for (int t = 0; t < 16; ++t) {
        expect_words(text, {"4"});
        std::vector<int>& corners = view.tetrahedra.emplace_back(4);
        text >> corners[0] >> corners[1] >> corners[2] >> corners[3];
    }
    expect_words(text, {"CELL_TYPES", "16"});
    for (int t = 0; t < 16; ++t) {
        expect_words(text, {"10"});
    }
    expect_words(text,
                 {"POINT_DATA", "8", "SCALARS", "w", "double", "1", "LOOKUP_TABLE", "default"});
    for (Eigen::Vector4d& point : view.points) {
        text >> point[3];
    }
    EXPECT_TRUE(text);
    expect_all_of(view, with_digits());
}

TEST(Gmsh, HasTheBoundaryWithWAsAView) {
    std::istringstream text(text_as("a.msh", with_digits()));
    expect_words(text, {"$MeshFormat", "2.2", "0", "8", "$EndMeshFormat", "$Comments"});
    std::string word;
    while (text >> word && word != "$EndComments") {
    }
    expect_words(text, {"$Nodes", "8"});
    View view{std::vector<Eigen::Vector4d>(8), {}};
    int number = 0;
    for (Eigen::Vector4d& point : view.points) {
        text >> number >> point[0] >> point[1] >> point[2];
        EXPECT_EQ(number, &point - view.points.data() + 1);
    }
    expect_words(text, {"$EndNodes", "$Elements", "16"});
    for (int t = 0; t < 16; ++t) {
        text >> number;
        EXPECT_EQ(number, t + 1);
        expect_words(text, {"4", "2", "1", "1"});
        std::vector<int>& corners = view.tetrahedra.emplace_back(4);
        for (int& corner : corners) {
            text >> corner;
            --corner;
        }
    }
    expect_words(text, {"$EndElements", "$NodeData", "1", "\"w\"", "1", "0", "3", "0", "1", "8"});
    for (std::size_t p = 0; p < view.points.size(); ++p) {
        text >> number >> view.points[p][3];
        EXPECT_EQ(number, static_cast<int>(p) + 1);
    }
    expect_words(text, {"$EndNodeData"});
    expect_all_of(view, with_digits());
}

}  // namespace
}  // namespace pent::exchange
