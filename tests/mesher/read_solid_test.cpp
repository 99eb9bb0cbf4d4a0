#include <pent/error.h>
#include <pent/mesher/read_solid.h>

#include <gtest/gtest.h>

#include <string>

namespace pent::mesher {
namespace {

double value_at_origin(const std::string& text) {
    return parse_solid(text, "shape.toml").value(Eigen::Vector4d::Zero());
}

std::string refusal(const std::string& text) {
    try {
        (void)parse_solid(text, "shape.toml");
    } catch (const Error& error) {
        return error.what();
    }
    return "";
}

void expect_refusal(const std::string& text, const std::vector<std::string>& parts) {
    const std::string message = refusal(text);
    for (const std::string& part : parts) {
        EXPECT_NE(message.find(part), std::string::npos) << part << " in: " << message;
    }
    EXPECT_EQ(message.find('\n'), std::string::npos);
}

TEST(ReadSolid, KnowsEveryPrimitive) {
    EXPECT_DOUBLE_EQ(value_at_origin("[[shape]]\nball = { radius = 2 }"), -2);
    EXPECT_DOUBLE_EQ(value_at_origin("[[shape]]\nbox = { size = [1, 2, 3, 4] }"), -0.5);
    EXPECT_DOUBLE_EQ(value_at_origin("[[shape]]\ncapsule = { radius = 1, length = 2 }"), -1);
    EXPECT_DOUBLE_EQ(value_at_origin("[[shape]]\nspherinder = { radius = 2, length = 2 }"), -1);
    EXPECT_DOUBLE_EQ(value_at_origin("[[shape]]\ncubinder = { radius = 2, size = [3, 2] }"), -1);
    EXPECT_DOUBLE_EQ(value_at_origin("[[shape]]\nduocylinder = { radii = [2, 1] }"), -1);
    EXPECT_DOUBLE_EQ(
        value_at_origin("[[shape]]\nspheritorus = { ring_radius = 2, tube_radius = 1 }"), 1);
    EXPECT_DOUBLE_EQ(
        value_at_origin("[[shape]]\ntorisphere = { ring_radius = 2, tube_radius = 1 }"), 1);
    EXPECT_DOUBLE_EQ(value_at_origin("[[shape]]\ntiger = { ring_radii = [3, 4], tube_radius = 1 }"),
                     4);
    EXPECT_DOUBLE_EQ(
        value_at_origin("[[shape]]\nditorus = { ring_radii = [4, 2], tube_radius = 1 }"), 1);
    EXPECT_DOUBLE_EQ(value_at_origin("[[shape]]\nclifford_torus = { radius = 1, thickness = 0.5 }"),
                     0.75);
    EXPECT_DOUBLE_EQ(value_at_origin("[[shape]]\npolytope = { cells = 8, radius = 2 }"), -1);
    EXPECT_DOUBLE_EQ(
        value_at_origin("[[shape]]\nhalf_space = { normal = [0, 0, 0, 2], offset = 4 }"), -2);
    EXPECT_DOUBLE_EQ(
        value_at_origin("[[shape]]\nexpression = { formula = \"x - 3\", low = [-1, -1, "
                        "-1, -1], high = [1, 1, 1, 1] }"),
        -1);
}

TEST(ReadSolid, CombinesShapesInTheirOrder) {
    const std::string two = "[[shape]]\nball = { radius = 2 }\n[[shape]]\nball = { radius = 1 }\n";
    EXPECT_DOUBLE_EQ(value_at_origin(two), -2);
    EXPECT_DOUBLE_EQ(value_at_origin(two + "op = \"intersection\""), -1);
    EXPECT_DOUBLE_EQ(value_at_origin(two + "op = \"difference\""), 1);
    EXPECT_DOUBLE_EQ(value_at_origin(two + "op = \"intersection\"\nsmooth = 2"), -1 + 1.0 / 8);
}

TEST(ReadSolid, PlacesShapesAndGroups) {
    const Solid solid = parse_solid(
        "[[shape]]\n"
        "scale = 2\n"
        "rotate = [{ plane = \"xw\", degrees = 90 }, { plane = \"xy\", degrees = 90 }]\n"
        "translate = [0, 0, 5, 0]\n"
        "[[shape.shape]]\n"
        "box = { size = [4, 2, 2, 2] }\n"
        "[[shape.shape]]\n"
        "op = \"difference\"\n"
        "ball = { radius = 0.5 }\n",
        "shape.toml");
    // The long side turns from x to w, then w stays.
    EXPECT_NEAR(solid.value({0, 0, 5, 4.5}), 0.5, 1e-14);
    EXPECT_NEAR(solid.value({0, 0, 5, 0}), 1, 1e-14);
}

TEST(ReadSolid, NamesPlaceAndNearestKeyOfWhatItDoesNotKnow) {
    expect_refusal("[[shape]]\nbal = { radius = 1 }", {"shape.toml:2:", "\"bal\"", "\"ball\"?"});
    expect_refusal("[[shape]]\nball = { radios = 1 }",
                   {"shape.toml:2:", "needs \"radius\"", "\"radios\""});
    expect_refusal("[[shape]]\nball = { radius = 1, color = 2 }", {"shape.toml:2:22", "\"color\""});
    expect_refusal("[[shapes]]\nball = { radius = 1 }", {"\"shapes\"", "\"shape\"?"});
    expect_refusal(
        "[[shape]]\nball = { radius = 1 }\n[[shape]]\nball = { radius = 1 }\nop = "
        "\"diference\"",
        {"shape.toml:5:6", "\"difference\"?"});
}

TEST(ReadSolid, NamesTheBlockThatAKeyBelongsTo) {
    for (const std::string key :
         {"ball", "polytope", "image", "op", "smooth", "scale", "rotate", "translate"}) {
        EXPECT_EQ(refusal(key + " = 1\n[[shape]]\nball = { radius = 1 }"),
                  "shape.toml:1:1: unknown key \"" + key + "\" in the file; \"" + key
                      + "\" belongs to [[shape]]");
    }
    EXPECT_EQ(refusal("length = 1\n[[shape]]\nball = { radius = 1 }"),
              "shape.toml:1:1: unknown key \"length\" in the file; \"length\" belongs to"
              " \"capsule\" or \"spherinder\" of [[shape]]");
    EXPECT_EQ(refusal("[[shape]]\nball = { radius = 1 }\nradii = [1, 1]"),
              "shape.toml:3:1: unknown key \"radii\" in \"shape\"; \"radii\" belongs to"
              " \"duocylinder\" of [[shape]]");
    EXPECT_EQ(refusal("[[shape]]\nball = { radius = 1, scale = 2 }"),
              "shape.toml:2:22: unknown key \"scale\" in \"ball\"; \"scale\" belongs to"
              " [[shape]]");
    EXPECT_EQ(refusal("[[shape]]\nball = { radius = 1 }\ndegrees = 30"),
              "shape.toml:3:1: unknown key \"degrees\" in \"shape\"; \"degrees\" belongs to"
              " \"rotate\" of [[shape]]");
    EXPECT_EQ(refusal("shpe = 1"),
              "shape.toml:1:1: unknown key \"shpe\" in the file; did you mean \"shape\"?");
}

TEST(ReadSolid, SaysWhereValuesAreWrong) {
    expect_refusal("[[shape]]\nball = { radius = -1 }", {"shape.toml:2:", "radius is -1"});
    expect_refusal("[[shape]]\nball = { radius = \"big\" }", {"shape.toml:2:", "the text \"big\""});
    expect_refusal("[[shape]]\nball = 1", {"shape.toml:2:8", "a table"});
    expect_refusal("[[shape]]\nbox = { size = [1, 1, 1] }", {"3 entries", "4 numbers"});
    expect_refusal("[[shape]]\nbox = { size = [1, 1, 1, nan] }", {"the entry nan"});
    expect_refusal("[[shape]]\npolytope = { cells = 25, radius = 1 }", {"600"});
    expect_refusal("[[shape]]\nball = { radius = 1 }\nscale = 0", {"shape.toml:3:9", "above 0"});
    expect_refusal("[[shape]]\nball = { radius = 1 }\nrotate = [{ plane = \"xx\", degrees = 1 }]",
                   {"\"xx\"", "two of x y z w"});
    expect_refusal("[[shape]]\nball = { radius = 1 }\nop = \"union\"", {"first shape"});
    expect_refusal("[[shape]]\nball = { radius = 1 }\nbox = { size = [1, 1, 1, 1] }", {"2 of"});
    expect_refusal("[[shape]]\nscale = 2", {"0 of", "ball"});
    expect_refusal(
        "[[shape]]\nexpression = { formula = \"x^^2\", low = [0, 0, 0, 0], high = [1, 1, "
        "1, 1] }",
        {"shape.toml:2:", "x^^2"});
    expect_refusal("", {"no shape"});
    expect_refusal("[[shape]\n", {"shape.toml:1:"});
}

TEST(ReadSolid, RefusesFilesThatAreNotThere) {
    EXPECT_THROW((void)read_solid("/no/such/shape.toml"), Error);
    EXPECT_THROW((void)read_solid("/tmp"), Error);
    EXPECT_TRUE(is_shape_file("a/b.toml"));
    EXPECT_TRUE(is_shape_file("a/B.TOML"));
    EXPECT_FALSE(is_shape_file("a/b.obj"));
}

}  // namespace
}  // namespace pent::mesher
