#include "ground.h"
#include "obstacle_view.h"
#include "surfaces.h"

#include <pent/contact/obstacles.h>
#include <pent/viewer/obstacle_slice.h>
#include <pent/viewer/obstacle_surface.h>

#include <Eigen/LU>
#include <Eigen/QR>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

namespace pent::viewer {
namespace {

// Whether a point is in a convex body.
bool is_below_all_sides(const TriangleMesh& surface, const Eigen::Vector3d& x) {
    const double size = bounding_box(surface).diagonal().norm();
    for (Eigen::Index i = 0; i < surface.triangle_count(); ++i) {
        const Eigen::Vector3d a = surface.positions.col(surface.triangles(0, i));
        const Eigen::Vector3d b = surface.positions.col(surface.triangles(1, i));
        const Eigen::Vector3d c = surface.positions.col(surface.triangles(2, i));
        const Eigen::Vector3d normal = (b - a).cross(c - a);
        if (normal.norm() > 1e-9 * size * size && normal.dot(x - a) >= 0) {
            return false;
        }
    }
    return true;
}

// Whether a point is in what a slice has solid.
bool is_solid(const ObstacleSlice& slice, const Eigen::Vector3d& x) {
    return !slice.is_empty && (!slice.plane || slice.plane->normal.dot(x) < slice.plane->offset)
           && (!slice.ball || (x - slice.ball->center).norm() < slice.ball->radius)
           && (!slice.hollow || (x - slice.hollow->center).norm() > slice.hollow->radius)
           && (!slice.block || is_below_all_sides(*slice.block, x));
}

// The point of R^4 that is seen at x.
Eigen::Vector4d point_at(const FramedHyperplane& plane, const Eigen::Vector3d& x) {
    Eigen::Vector4d seen;
    seen << x, plane.offset;
    return plane.frame.transpose() * seen;
}

class Random {
public:
    double number(double low, double high) {
        return std::uniform_real_distribution<double>(low, high)(engine_);
    }
    template <int Dim>
    Eigen::Matrix<double, Dim, 1> point() {
        Eigen::Matrix<double, Dim, 1> p;
        for (double& x : p) {
            x = number(-1, 1);
        }
        return p;
    }
    FramedHyperplane hyperplane() { return hyperplane_across(point<4>(), number(-0.8, 0.8)); }
    template <int Dim>
    std::vector<ObstacleShape<Dim>> one_of_each() {
        return {HalfSpace<Dim>{point<Dim>().normalized(), number(-0.5, 0.5)},
                Ball<Dim>{point<Dim>(), number(0.2, 1)},
                Cavity<Dim>{point<Dim>(), number(0.2, 1)},
                Bowl<Dim>{point<Dim>(), number(0.2, 1), point<Dim>().normalized()},
                Cuboid<Dim>{0.5 * point<Dim>(), 2.2 * point<Dim>().cwiseAbs().array() + 0.2},
                Cuboid<Dim>{0.5 * point<Dim>(), 2.2 * point<Dim>().cwiseAbs().array() + 0.2,
                            axes<Dim>()}};
    }
    template <int Dim>
    Eigen::Matrix<double, Dim, Dim> axes() {
        Eigen::Matrix<double, Dim, Dim> columns;
        for (int axis = 0; axis < Dim; ++axis) {
            columns.col(axis) = point<Dim>();
        }
        Eigen::Matrix<double, Dim, Dim> turned = columns.householderQr().householderQ();
        turned.col(0) *= turned.determinant() < 0 ? -1 : 1;
        return turned;
    }

private:
    std::mt19937 engine_{7};
};

// Within rounding of the surface either answer is right.
constexpr double kTouching = 1e-9;

TEST(ObstacleSlice, IsSolidWhereContactHoldsTheObstacleForSolid) {
    Random random;
    int solid = 0;
    int points = 0;
    for (int repeat = 0; repeat < 200; ++repeat) {
        const FramedHyperplane plane = random.hyperplane();
        for (const ObstacleShape<4>& obstacle : random.one_of_each<4>()) {
            const ObstacleSlice cut = slice(obstacle, plane);
            for (int i = 0; i < 50; ++i) {
                const Eigen::Vector3d x = 1.5 * random.point<3>();
                const double distance =
                    contact::signed_distance<4>(obstacle, point_at(plane, x)).value;
                if (std::abs(distance) > kTouching) {
                    ASSERT_EQ(is_solid(cut, x), distance < 0) << obstacle.index() << " " << x;
                    solid += distance < 0 ? 1 : 0;
                    ++points;
                }
            }
        }
    }
    EXPECT_GT(solid, points / 5);  // the random obstacles are neither too small nor too large
    EXPECT_LT(solid, 4 * points / 5);
}

TEST(ObstacleSlice, InThreeDimensionsIsTheObstacleItself) {
    Random random;
    for (int repeat = 0; repeat < 50; ++repeat) {
        for (const ObstacleShape<3>& obstacle : random.one_of_each<3>()) {
            const ObstacleSlice all = whole(obstacle);
            for (int i = 0; i < 50; ++i) {
                const Eigen::Vector3d x = 1.5 * random.point<3>();
                const double distance = contact::signed_distance<3>(obstacle, x).value;
                if (std::abs(distance) > kTouching) {
                    ASSERT_EQ(is_solid(all, x), distance < 0) << obstacle.index() << " " << x;
                }
            }
        }
    }
}

TEST(ObstacleSlice, OfAHalfSpaceBesideTheHyperplaneIsEverythingOrNothing) {
    const ObstacleShape<4> half_space = HalfSpace<4>{Eigen::Vector4d::UnitW(), 0.3};
    EXPECT_TRUE(slice(half_space, hyperplane_at(0.2)).is_everything());
    EXPECT_TRUE(slice(half_space, hyperplane_at(0.4)).is_empty);
    EXPECT_TRUE(slice(half_space, hyperplane_at(0.3)).is_empty);  // touches it
    // A turn by 90 degrees leaves rounding in the axes, which must not become a far plane.
    const PlaneRotation turn[] = {{0, 3, std::numbers::pi / 2}};
    const ObstacleShape<4> wall = HalfSpace<4>{Eigen::Vector4d::UnitX(), 0.3};
    EXPECT_TRUE(slice(wall, hyperplane_at(0.2, turn)).is_everything());
    EXPECT_TRUE(slice(wall, hyperplane_at(0.4, turn)).is_empty);
}

TEST(ObstacleSlice, OfRoundOnesBeyondTheirRadiusIsWhatIsAroundThem) {
    const Eigen::Vector4d center(1, 2, 3, 0);
    for (const double w : {-0.5, 0.5, 0.7}) {  // touching, and beyond
        const FramedHyperplane plane = hyperplane_at(w);
        EXPECT_TRUE(slice(Ball<4>{center, 0.5}, plane).is_empty);
        EXPECT_TRUE(slice(Cavity<4>{center, 0.5}, plane).is_everything());
        const ObstacleSlice ground = slice(Bowl<4>{center, 0.5, Eigen::Vector4d::UnitY()}, plane);
        EXPECT_TRUE(ground.plane && !ground.hollow);
    }
}

// A bowl whose up has a part along w is met by a hyperplane above its center with the hollow over
// or under the ground.
TEST(ObstacleSlice, OfALeaningBowlLosesAHollowThatIsInTheAir) {
    const ObstacleShape<4> bowl =
        Bowl<4>{Eigen::Vector4d::Zero(), 1, Eigen::Vector4d(0, 0.6, 0, 0.8)};
    const ObstacleSlice over = slice(bowl, hyperplane_at(0.9));
    EXPECT_TRUE(over.plane && !over.hollow);
    const ObstacleSlice under = slice(bowl, hyperplane_at(-0.9));
    ASSERT_TRUE(under.plane && under.hollow);
    EXPECT_LT(under.plane->normal.dot(under.hollow->center) + under.hollow->radius,
              under.plane->offset);  // buried
}

// How far off the surface solid and free are told apart: further than it bulges between corners,
// 0.011 of a radius; flat sides do not, but may be close to each other.
double step_off(const ObstacleSlice& slice) {
    if (slice.block) {
        return 1e-6;
    }
    const std::optional<Sphere>& round = slice.ball ? slice.ball : slice.hollow;
    return 0.02 * std::min(1.0, round ? round->radius : 1);
}

// Whether a point is between a hollow and the plane over it, where the solid may be as thin as a
// sheet.
bool is_in_lip(const ObstacleSlice& slice, const Eigen::Vector3d& x) {
    return slice.plane && slice.hollow
           && std::abs(slice.plane->normal.dot(x) - slice.plane->offset) < 0.05
           && (x - slice.hollow->center).norm() < slice.hollow->radius + 0.05;
}

TEST(ObstacleSurface, LiesOnTheObstacleAndIsTurnedOutOfIt) {
    Random random;
    const Sphere view{Eigen::Vector3d(0.1, 0.2, 0.3), 2};
    int triangles = 0;
    for (int repeat = 0; repeat < 40; ++repeat) {
        const FramedHyperplane plane = random.hyperplane();
        for (const ObstacleShape<4>& obstacle : random.one_of_each<4>()) {
            const ObstacleSlice cut = slice(obstacle, plane);
            const TriangleMesh mesh = obstacle_surface(cut, view, 24);
            for (const auto& x : mesh.positions.colwise()) {
                EXPECT_NEAR(contact::signed_distance<4>(obstacle, point_at(plane, x)).value, 0,
                            1e-12);
            }
            for (const auto& triangle : mesh.triangles.colwise()) {
                const Eigen::Matrix3d corners = mesh.positions(Eigen::all, triangle);
                const Eigen::Vector3d normal = (corners.col(1) - corners.col(0))
                                                   .cross(corners.col(2) - corners.col(0))
                                                   .normalized();
                const Eigen::Vector3d middle = corners.rowwise().mean();
                if (is_in_lip(cut, middle)) {
                    continue;
                }
                const double step = step_off(cut);
                ASSERT_FALSE(is_solid(cut, middle + step * normal)) << obstacle.index();
                ASSERT_TRUE(is_solid(cut, middle - step * normal)) << obstacle.index();
                ++triangles;
            }
        }
    }
    EXPECT_GT(triangles, 10000);
}

TEST(ObstacleSurface, OfABallOrAHollowIsClosedWithTheBallsVolume) {
    const Sphere ball{Eigen::Vector3d(1, -2, 3), 0.7};
    const double volume = 4.0 / 3 * std::numbers::pi * std::pow(ball.radius, 3);
    const TriangleMesh solid = obstacle_surface({.ball = ball}, {}, 200);
    EXPECT_TRUE(test::is_closed_and_oriented(solid));
    EXPECT_NEAR(enclosed_volume(solid), volume, 1e-3 * volume);  // chords: (pi / 200)^2 and less
    const TriangleMesh hollow = obstacle_surface({.hollow = ball}, {}, 200);
    EXPECT_TRUE(test::is_closed_and_oriented(hollow));
    EXPECT_NEAR(enclosed_volume(hollow), -volume, 1e-3 * volume);
}

TEST(ObstacleSurface, OfAPlaneEndsAtTheRadiusOfTheView) {
    const ObstacleSlice floor = {.plane = Plane{Eigen::Vector3d::UnitY(), -1}};
    const TriangleMesh disk = obstacle_surface(floor, {Eigen::Vector3d(5, 6, 7), 2}, 300);
    EXPECT_NEAR(area(disk), 4 * std::numbers::pi, 1e-3);  // chords: 2 (pi / 300)^2 / 3 of it
    const Eigen::AlignedBox3d box = bounding_box(disk);
    EXPECT_NEAR((box.center() - Eigen::Vector3d(5, -1, 7)).norm(), 0, 1e-12);
}

TEST(ObstacleSurface, IsNothingWhereTheSliceIsNothingOrEverything) {
    const Sphere view{Eigen::Vector3d::Zero(), 1};
    EXPECT_EQ(obstacle_surface({.is_empty = true}, view).triangle_count(), 0);
    EXPECT_EQ(obstacle_surface({}, view).triangle_count(), 0);
}

// The furthest any image of the ball's points is in a direction, by many of its points.
double reach_of_images(const Ball<4>& ball,
                       const Projection& projection,
                       const Eigen::Vector3d& direction) {
    Random random;
    Positions<4> points(4, 100000);
    for (auto point : points.colwise()) {
        point = ball.center + ball.radius * random.point<4>().normalized();
    }
    return (direction.transpose() * project(points, projection)).maxCoeff();
}

TEST(ObstacleOutline, ReachesAsFarAsTheImagesOfTheBallsPoints) {
    Random random;
    const Ball<4> ball{Eigen::Vector4d(0.3, -0.2, 0.5, 0.4), 0.6};
    for (const bool is_perspective : {false, true}) {
        const Projection projection{
            .film = hyperplane_across({0.2, 0.1, -0.3, 1}, 0.1),
            .center = {0.1, 0.2, 0.3},
            .eye_distance = is_perspective ? std::optional<double>(2.5) : std::nullopt};
        const TriangleMesh mesh = outline(ball, projection);
        EXPECT_TRUE(test::is_closed_and_oriented(mesh));
        EXPECT_GT(enclosed_volume(mesh), 0);
        for (int repeat = 0; repeat < 5; ++repeat) {
            const Eigen::Vector3d direction = random.point<3>().normalized();
            const double reach = (direction.transpose() * mesh.positions).maxCoeff();
            // Of 100,000 random points the nearest to the furthest is about 0.05 radii away, where
            // the ball has turned by 0.05^2 / 2 of its radius.
            EXPECT_NEAR(reach, reach_of_images(ball, projection, direction), 0.004);
        }
    }
}

TEST(ObstacleOutline, OfABoxReachesAsFarAsTheImagesOfItsCorners) {
    Random random;
    const Cuboid<4> box{Eigen::Vector4d(0.3, -0.2, 0.5, 0.4), Eigen::Vector4d(0.6, 0.8, 0.3, 0.7),
                        random.axes<4>()};
    for (const bool is_perspective : {false, true}) {
        const Projection projection{
            .film = hyperplane_across({0.2, 0.1, -0.3, 1}, 0.1),
            .center = {0.1, 0.2, 0.3},
            .eye_distance = is_perspective ? std::optional<double>(2.5) : std::nullopt};
        const TriangleMesh mesh = outline(box, projection);
        EXPECT_GT(enclosed_volume(mesh), 0);
        const Positions<3> corners = project(to_mesh<4>(box).positions, projection);
        for (int repeat = 0; repeat < 5; ++repeat) {
            const Eigen::Vector3d direction = random.point<3>().normalized();
            EXPECT_NEAR((direction.transpose() * mesh.positions).maxCoeff(),
                        (direction.transpose() * corners).maxCoeff(), 1e-12);
        }
    }
    const Projection near{.film = hyperplane_at(0), .eye_distance = 0.5};
    EXPECT_EQ(outline(box, near).triangle_count(), 0);  // it reaches behind the eye
}

TEST(ObstacleOutline, IsNothingForABallThatReachesBesideOrBehindTheEye) {
    const Projection projection{.film = hyperplane_at(0), .eye_distance = 2};
    EXPECT_EQ(outline({Eigen::Vector4d(0, 0, 0, 1.5), 1}, projection).triangle_count(), 0);
    EXPECT_EQ(outline({Eigen::Vector4d(9, 0, 0, 3), 0.5}, projection).triangle_count(), 0);
    EXPECT_GT(outline({Eigen::Vector4d(9, 0, 0, 1), 0.5}, projection).triangle_count(), 0);
}

// The first point of a ray where it goes from the free into the solid, by small steps; negative if
// it does not within a distance of 6.
double entry_by_steps(const ObstacleSlice& slice,
                      const Eigen::Vector3d& from,
                      const Eigen::Vector3d& direction) {
    constexpr double kStep = 1e-3;
    bool was_solid = is_solid(slice, from);
    for (double distance = kStep; distance < 6; distance += kStep) {
        const bool now_solid = is_solid(slice, from + distance * direction);
        if (now_solid && !was_solid) {
            return distance;
        }
        was_solid = now_solid;
    }
    return -1;
}

// Where a point is in a picture of a camera, pixels from its middle.
Eigen::Vector2d seen_at(const Eigen::Vector3d& point, const Camera& camera, int height) {
    const Eigen::Vector3d p = camera_frame(camera).transpose() * (point - camera.position);
    return p.head<2>() / -p.z() * (height / (2 * std::tan(camera.field_of_view / 2)));
}

// The farthest that the middles of chords are from those of their arcs on the nearest circle of a
// ball that is seen from the front.
double dent(const Sphere& ball, int corners, const Camera& camera, int height) {
    const Eigen::Vector3d back = (camera.position - ball.center).normalized();
    const Eigen::Vector3d across = camera_frame(camera).col(0);
    const Eigen::Vector3d u = (across - across.dot(back) * back).normalized();
    const Eigen::Vector3d v = back.cross(u);
    // The rim as it is seen: where rays from the eye touch the ball.
    const double share = ball.radius / (camera.position - ball.center).norm();
    const Eigen::Vector3d middle = ball.center + share * ball.radius * back;
    const double radius = ball.radius * std::sqrt(1 - share * share);
    double most = 0;
    for (int i = 0; i < corners; ++i) {
        const auto at = [&](double k) {
            const double angle = 2 * std::numbers::pi * k / corners;
            return Eigen::Vector3d(middle + radius * (std::cos(angle) * u + std::sin(angle) * v));
        };
        const Eigen::Vector3d chord = (at(i) + at(i + 1)) / 2;
        const Eigen::Vector2d gap =
            seen_at(chord, camera, height) - seen_at(at(i + 0.5), camera, height);
        most = std::max(most, gap.norm());
    }
    return most;
}

TEST(RoundCircle, IsRoundToTheEyeAndNoFiner) {
    Random random;
    int in_between = 0;
    for (int repeat = 0; repeat < 300; ++repeat) {
        const Sphere ball{random.point<3>(), std::exp(random.number(-7, 0))};
        Camera camera;
        camera.position = ball.center + random.number(2, 40) * random.point<3>().normalized();
        camera.target = ball.center;
        camera.field_of_view = random.number(0.2, 1.5);
        const int height = repeat % 2 == 0 ? 720 : 200;
        const int corners = round_circle(ball, camera, height);
        EXPECT_EQ(corners % 8, 0);
        EXPECT_GE(corners, 8);
        EXPECT_LE(corners, kFineCircle);
        if (corners < kFineCircle) {
            EXPECT_LT(dent(ball, corners, camera, height), 0.1);
        }
        // Where the eye is near, the front is nearer than the rim that is measured here.
        const double distance = (ball.center - camera.position).norm();
        if (corners > 8 && distance > 4 * ball.radius) {
            EXPECT_GT(dent(ball, corners - 8, camera, height), 0.07);
            in_between += corners < kFineCircle ? 1 : 0;
        }
    }
    EXPECT_GT(in_between, 100);
    const Camera inside{.position = {0, 0, 0.5}, .target = {0, 0, 0}};
    EXPECT_EQ(round_circle({Eigen::Vector3d::Zero(), 1}, inside, 720), kFineCircle);
}

TEST(RoundCircle, GoesForWallsAndOutlinesAlike) {
    const Ball<4> ball{{1, 0, 0, 0}, 0.5};
    const FramedHyperplane plane = hyperplane_at(0);
    const Camera camera{.position = {1, 0, 50}, .target = {1, 0, 0}};
    const int circle = round_circle({{1, 0, 0}, 0.5}, camera, 720);
    ASSERT_LT(circle, kFineCircle / 2);
    const Eigen::Index expected = wall_surface(slice(ball, plane), circle).triangle_count();
    const RenderObject outline = outline_object(ball, {.film = plane}, 0.5F, camera, 720);
    EXPECT_EQ(outline.triangles.cols(), expected);
}

TEST(Ground, IsMetWhereARayGoesFromTheFreeIntoTheSolid) {
    Random random;
    int hits = 0;
    for (int repeat = 0; repeat < 1200; ++repeat) {
        const std::vector<ObstacleShape<4>> shapes = random.one_of_each<4>();
        const ObstacleSlice cut = slice(shapes[repeat % 4], random.hyperplane());
        const RaySpace space{random.point<3>(), std::ldexp(1.0, repeat % 3 - 1)};
        const Eigen::Vector3d from = 2 * random.point<3>();
        const Eigen::Vector3d direction = random.point<3>().normalized();
        const GroundHit hit =
            Ground(cut, space).first_hit(space.point(from), direction.cast<float>());
        const double distance = space.unit * double{hit.distance};
        const double expected = entry_by_steps(cut, from, direction);
        if (expected < 0) {
            EXPECT_FALSE(distance < 5.99) << repeat;
            continue;
        }
        // A step, and what single precision makes of rays that graze.
        EXPECT_NEAR(distance, expected, 2e-3) << repeat;
        const Eigen::Vector3d point = from + distance * direction;
        const Eigen::Vector3d normal = hit.normal.cast<double>();
        EXPECT_NEAR(normal.norm(), 1, 1e-6);
        EXPECT_LT(normal.dot(direction), 0);  // faces the eye
        EXPECT_FALSE(is_solid(cut, point + 1e-3 * normal));
        EXPECT_TRUE(is_solid(cut, point - 1e-3 * normal));
        ++hits;
    }
    EXPECT_GT(hits, 100);
}

TEST(Ground, SpreadsAlongAPlaneFromWhereItIsNearest) {
    const Ground floor({.plane = Plane{Eigen::Vector3d::UnitY(), -2}}, {Eigen::Vector3d(1, 0, 1)});
    EXPECT_NEAR(floor.spread(Vec(3, -2, 4)), 5, 1e-6);
    EXPECT_EQ(floor.spread(Vec(0, -2, 0)), 0);
}

}  // namespace
}  // namespace pent::viewer
