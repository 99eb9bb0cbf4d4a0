#include "pent/obstacles_file.h"

#include <pent/error.h>
#include <pent/output_file.h>

#include <gtest/gtest.h>

#include <cmath>
#include <support/messages.h>
#include <support/temp_folder.h>
#include <type_traits>

namespace pent {
namespace {

using test::error_of;
using test::expect_contains;
using test::TempFolder;

// The numbers of a shape, one after the other.
template <int Dim>
std::vector<double> numbers_of(const ObstacleShape<Dim>& obstacle) {
    std::vector<double> numbers;
    std::visit(
        [&](const auto& shape) {
            shape.fields(shape, [&](const char* /*name*/, const auto& value, ShapeField /*kind*/) {
                if constexpr (std::is_arithmetic_v<std::remove_cvref_t<decltype(value)>>) {
                    numbers.push_back(value);
                } else {
                    const Eigen::VectorXd all = value.reshaped();
                    numbers.insert(numbers.end(), all.begin(), all.end());
                }
            });
        },
        obstacle);
    return numbers;
}

template <int Dim>
std::vector<ObstacleShape<Dim>> one_of_each() {
    using Vector = Eigen::Matrix<double, Dim, 1>;
    const Vector odd = Vector::LinSpaced(0.1, 1.0 / 3.0);
    Eigen::Matrix<double, Dim, Dim> turned = Eigen::Matrix<double, Dim, Dim>::Identity();
    turned(0, 0) = turned(Dim - 1, Dim - 1) = std::cos(0.3);
    turned(Dim - 1, 0) = std::sin(0.3);
    turned(0, Dim - 1) = -turned(Dim - 1, 0);
    return {HalfSpace<Dim>{odd.normalized(), -0.7},
            Ball<Dim>{odd, 1e-300},
            Cavity<Dim>{-odd, 1e300},
            Bowl<Dim>{3 * odd, 6, Vector::Unit(1)},
            Cuboid<Dim>{odd, 2 * odd},
            Cuboid<Dim>{odd, 2 * odd, turned}};
}

template <int Dim>
void expect_same_after_reading() {
    const TempFolder folder;
    const std::vector<ObstacleShape<Dim>> written = one_of_each<Dim>();
    write_obstacles(folder / "obstacles.json", written);
    const std::vector<ObstacleShape<Dim>> read = read_obstacles<Dim>(folder / "obstacles.json");
    ASSERT_EQ(read.size(), written.size());
    for (std::size_t i = 0; i < read.size(); ++i) {
        EXPECT_EQ(read[i].index(), written[i].index());
        EXPECT_EQ(numbers_of<Dim>(read[i]), numbers_of<Dim>(written[i]));
    }
}

TEST(ObstaclesFile, IsReadBackToTheLastBit) {
    expect_same_after_reading<3>();
    expect_same_after_reading<4>();
}

TEST(ObstaclesFile, MayHaveNone) {
    const TempFolder folder;
    write_obstacles<3>(folder / "obstacles.json", {});
    EXPECT_TRUE(read_obstacles<3>(folder / "obstacles.json").empty());
}

// What reading a file with this list of obstacles of dimension 3 is refused with.
std::string refusal_of(const std::string& list) {
    const TempFolder folder;
    write_text(folder / "o.json",
               "{\"pent_obstacles\": 1, \"dimension\": 3, \"obstacles\": " + list + "}");
    return error_of([&] { (void)read_obstacles<3>(folder / "o.json"); });
}

TEST(ObstaclesFile, IsRefusedWithTheObstacleThatIsWrong) {
    const std::string good = R"({"kind": "ball", "center": [0, 0, 0], "radius": 1})";
    const auto second = [&](const std::string& entry) {  // behind one that is as it should be
        return refusal_of("[" + good + ", " + entry + "]");
    };
    expect_contains(second("3"), {"obstacle 2", "no kind"});
    expect_contains(second(R"({"kind": "cap\nsule"})"),
                    {"obstacle 2", "\"cap\\nsule\"", "half_space"});
    expect_contains(second(R"({"kind": "ball", "center": [0, 0], "radius": 1})"),
                    {"obstacle 2", "\"center\"", "3 finite numbers"});
    expect_contains(second(R"({"kind": "ball", "center": [0, 0, 1e999], "radius": 1})"),
                    {"is not the list"});  // no JSON: such a number is out of range
    expect_contains(second(R"({"kind": "ball", "center": [0, 0, "0"], "radius": 1})"),
                    {"\"center\""});
    expect_contains(second(R"({"kind": "ball", "center": [0, 0, 0], "radius": 0})"),
                    {"\"radius\"", "above 0"});
    expect_contains(second(R"({"kind": "half_space", "normal": [0, 2, 0], "offset": 0})"),
                    {"\"normal\"", "of length 1"});
    expect_contains(second(R"({"kind": "half_space", "normal": [0, 1, 0]})"), {"\"offset\""});
    const auto box = [&](const std::string& axes) {
        return second(R"({"kind": "box", "center": [0, 0, 0], "sides": [1, 2, 3], "axes": )" + axes
                      + "}");
    };
    for (const std::string axes :
         {"[]", "3", "[[1, 0, 0], [0, 1, 0]]", "[1, 0, 0]", "[[1, 0, 0], [0, 1, 0], [0, 0, \"1\"]]",
          "[[1, 0, 0], [0, 1, 0], [0, 0, -1]]", "[[1, 0, 0], [0, 1, 0], [0, 0.1, 1]]"}) {
        expect_contains(box(axes), {"obstacle 2", "\"axes\"", "3 vectors of length 1"});
    }
    expect_contains(second(R"({"kind": "ball", "center": [0, 0, 0], "radius": 1, "poses": []})"),
                    {"obstacle 2", "\"poses\"", "newer"});
}

TEST(ObstaclesFile, IsRefusedWhereItIsSomethingElse) {
    const TempFolder folder;
    const auto refusal = [&](const std::string& text) {
        write_text(folder / "o.json", text);
        return error_of([&] { (void)read_obstacles<4>(folder / "o.json"); });
    };
    for (const std::string text :
         {"", "{", "[]", "null", "{}", R"({"pent_obstacles": 1})", "\xff\xfe",
          R"({"pent_obstacles": 2, "dimension": 4, "obstacles": []})",
          R"({"pent_obstacles": "1", "dimension": 4, "obstacles": []})",
          R"({"dimension": 4, "obstacles": []})",
          R"({"pent_obstacles": 1, "dimension": 4, "obstacles": {}})"}) {
        expect_contains(refusal(text), {"o.json", "is not the list of a run's obstacles"});
    }
    expect_contains(refusal(R"({"pent_obstacles": 1, "dimension": 3, "obstacles": []})"),
                    {"dimension", "expected 4"});
    expect_contains(error_of([&] { (void)read_obstacles<4>(folder / "none.json"); }),
                    {"none.json"});
}

}  // namespace
}  // namespace pent
