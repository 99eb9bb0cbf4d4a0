#include "valley.h"

#include "closest_point_search.h"
#include "penalty_scenes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <random>

namespace pent::contact {
namespace {

using test::kEps;
using test::kOptions;
using test::kStiffness;

// What is minimized over all shares.
template <int Dim>
double mean_distance(const std::vector<Contact<Dim>>& each, const std::vector<double>& shares) {
    double m = 0;
    Vector<Dim> u = Vector<Dim>::Zero();
    for (std::size_t i = 0; i < each.size(); ++i) {
        const double left = std::min(1.0, each[i].share / each[0].share);
        m += shares[i] * (kEps - std::sqrt(left) * (kEps - each[i].distance));
        u += shares[i] * each[i].direction;
    }
    return m - m * (1 - m / kEps) * (1 - u.squaredNorm()) / 2;
}

template <typename T>
class Valley : public testing::Test {
protected:
    static constexpr int kD = T::value;

    // Contacts of vertex 0 with one facet, turned into the directions given.
    struct Walls {
        Positions<kD> positions = Positions<kD>::Zero(kD, kD + 1);
        std::vector<Contact<kD>> each;

        Walls() { positions.rightCols(kD).setIdentity(); }

        void add(double distance, const Vector<kD>& direction, double share = 1) {
            Contact<kD> contact;
            contact.share = share;
            contact.distance = distance;
            contact.direction = direction.normalized();
            contact.count = kD + 1;
            contact.weights.setConstant(-1.0 / kD);
            contact.weights[0] = 1;
            for (std::uint32_t i = 0; i <= kD; ++i) {
                contact.vertices[i] = i;
            }
            each.push_back(contact);
        }

        [[nodiscard]] std::vector<Contact<kD>> shared() const {
            std::vector<Contact<kD>> contacts = each;
            share_contacts<kD>(contacts, 0, kEps, positions);
            return contacts;
        }
    };

    // Two bodies as one that meets itself.
    [[nodiscard]] static ContactFinder<kD> one_body(const SimplexMesh<kD>& first,
                                                    const SimplexMesh<kD>& second,
                                                    const Positions<kD>& rest) {
        test::Scene<kD> one;
        one.positions = rest;
        Simplices<kD + 1> cells(kD + 1, first.cell_count() + second.cell_count());
        cells << first.cells,
            second.cells.array() + static_cast<std::uint32_t>(first.vertex_count());
        one.surfaces.push_back(make_surface<kD>(cells, rest.cols(), 0));
        one.begin.push_back(rest.cols());
        ContactOptions options = kOptions;
        options.self = true;
        return ContactFinder<kD>(test::contact_scene<kD>(one, options));
    }

    // A box of two cells along each axis with the middle of its upper side pressed in, all vertices
    // shaken, and over the pit the lowest corner of a tilted cube, at a height over the side before
    // and beside the middle.
    struct Pit {
        test::Scene<kD> scene;
        std::array<SimplexMesh<kD>, 2> bodies;
        std::uint32_t corner = 0;

        Pit() {
            SimplexMesh<kD> box = test::cube<kD>(2);
            for (auto x : box.positions.colwise()) {
                Vector<kD> middle = Vector<kD>::Ones();
                middle[1] = 2;
                if ((x - middle).norm() < 1e-9) {
                    x[1] -= 0.2;
                }
            }
            test::shake<kD>(box.positions, 0.02, 7);
            scene.add(box, Vector<kD>::Zero());
            SimplexMesh<kD> tilted = test::cube<kD>(1);
            tilted.positions = test::tilt<kD>() * tilted.positions;
            Eigen::Index lowest = 0;
            tilted.positions.row(1).minCoeff(&lowest);
            scene.add(tilted, -tilted.positions.col(lowest));
            bodies = {box, tilted};
            corner = static_cast<std::uint32_t>(scene.begin[1] + lowest);
            finder_.emplace(test::contact_scene<kD>(scene, kOptions));
        }

        // Of vertices of the cube with the box.
        [[nodiscard]] std::vector<Contact<kD>> contacts(const Positions<kD>& positions) {
            std::vector<Contact<kD>> found;
            for (const Contact<kD>& contact : finder_->find(positions, kStiffness).list) {
                if (contact.kind == ContactKind::PointFacet && contact.first.index == 1) {
                    found.push_back(contact);
                }
            }
            return found;
        }

        [[nodiscard]] Positions<kD> at(const Vector<kD>& place) const {
            Positions<kD> positions = scene.positions;
            positions.rightCols(scene.begin[2] - scene.begin[1]).colwise() +=
                place - positions.col(corner);
            return positions;
        }

        // On a way across the pit, that passes no middle and runs along no axis.
        [[nodiscard]] static Vector<kD> place(double t) {
            Vector<kD> result = Vector<kD>::LinSpaced(1.03, 1.07);
            Vector<kD> way = Vector<kD>::LinSpaced(1, 0.4);
            way[1] = 0;
            result += t * way.normalized();
            result[1] = 1.95;
            return result;
        }

    private:
        std::optional<ContactFinder<kD>> finder_;
    };
};

using Dimensions = testing::Types<std::integral_constant<int, 3>, std::integral_constant<int, 4>>;
TYPED_TEST_SUITE(Valley, Dimensions);

TYPED_TEST(Valley, OfTwoLikeWallsIsTheHandWorkedOne) {
    constexpr int kDim = TypeParam::value;
    typename TestFixture::Walls walls;
    const double d = 0.05;
    const double angle = 0.3;  // of each wall with the ground
    const Vector<kDim> up = Vector<kDim>::Unit(kDim - 1);
    const Vector<kDim> aside = Vector<kDim>::Unit(0);
    walls.add(d, std::cos(angle) * up + std::sin(angle) * aside);
    walls.add(d, std::cos(angle) * up - std::sin(angle) * aside);
    const std::vector<Contact<kDim>> shared = walls.shared();
    ASSERT_EQ(shared.size(), 2U);
    const double kappa = d * (1 - d / kEps);
    const double spread = std::sin(angle) * std::sin(angle);
    for (const Contact<kDim>& contact : shared) {
        EXPECT_NEAR(contact.share, 0.5, 1e-12);
        EXPECT_NEAR(contact.distance, d - kappa * spread / 2, 1e-15);
    }
}

TYPED_TEST(Valley, HasTheSharesOfTheLeastDistance) {
    constexpr int kDim = TypeParam::value;
    std::mt19937 random(3);
    std::uniform_real_distribution<double> draw(0, 1);
    int shared_by_many = 0;
    for (int k = 0; k < 200; ++k) {
        typename TestFixture::Walls walls;
        const double steep = std::pow(10, -2 * draw(random));
        const double d = 0.9 * kEps * draw(random);
        for (int i = 0; i < 6; ++i) {
            Vector<kDim> direction = Vector<kDim>::Unit(0);
            for (double& x : direction) {
                x += steep * (2 * draw(random) - 1);
            }
            const double left = i == 0 || k % 2 == 0 ? 0.7 : 1 - 0.5 * draw(random) * steep;
            walls.add(d * (1 + (i == 0 ? 0 : 0.1 * steep * steep * draw(random))), direction, left);
        }
        const std::vector<Contact<kDim>> found = walls.shared();
        double sum = 0;
        for (const Contact<kDim>& contact : found) {
            sum += contact.share;
            EXPECT_EQ(contact.distance, found[0].distance);
        }
        EXPECT_NEAR(sum, 0.7, 1e-12);  // what is left of the nearest one
        shared_by_many += found.size() > 2 ? 1 : 0;
        for (int trial = 0; trial < 200; ++trial) {
            std::vector<double> shares(walls.each.size());
            double all = 0;
            for (double& share : shares) {
                share = std::pow(draw(random), 4);
                all += share;
            }
            for (double& share : shares) {
                share /= all;
            }
            EXPECT_GE(mean_distance<kDim>(walls.each, shares), found[0].distance * (1 - 1e-9));
        }
    }
    EXPECT_GT(shared_by_many, 50);
}

// Facets of which a corner is the nearest point, some of them faded: as the vertex moves, d changes
// as their shares, gains and directions say.
TYPED_TEST(Valley, OfFadedFacetsHasTheirGradient) {
    constexpr int kDim = TypeParam::value;
    std::mt19937 random(4);
    std::uniform_real_distribution<double> draw(0, 1);
    int shared_by_many = 0;
    for (int k = 0; k < 100; ++k) {
        std::vector<Vector<kDim>> corners;
        std::vector<double> left;
        for (int i = 0; i < 5; ++i) {
            Vector<kDim> direction = Vector<kDim>::Unit(0);
            for (double& x : direction) {
                x += 0.6 * (2 * draw(random) - 1);
            }
            corners.push_back(-0.5 * kEps * (1 + 0.02 * i) * direction.normalized());
            left.push_back(i == 0 ? 0.6 : 0.9 * draw(random) + 0.1);
        }
        const auto shared_at = [&](const Vector<kDim>& x) {
            typename TestFixture::Walls walls;
            for (std::size_t i = 0; i < corners.size(); ++i) {
                const Vector<kDim> away = x - corners[i];
                walls.add(away.norm(), away, left[i]);
                walls.each.back().weights.setZero();
                walls.each.back().weights.template head<2>() << 1, -1;
            }
            return walls.shared();
        };
        Vector<kDim> gradient = Vector<kDim>::Zero();
        const std::vector<Contact<kDim>> found = shared_at(Vector<kDim>::Zero());
        for (const Contact<kDim>& contact : found) {
            gradient += contact.share / left[0] * contact.gain * contact.direction;
        }
        shared_by_many += found.size() > 1 ? 1 : 0;
        const double h = 1e-6 * kEps;
        for (int axis = 0; axis < kDim; ++axis) {
            const Vector<kDim> step = h * Vector<kDim>::Unit(axis);
            const double slope =
                (shared_at(step)[0].distance - shared_at(-step)[0].distance) / (2 * h);
            EXPECT_NEAR(slope, gradient[axis], 1e-6) << k;
        }
    }
    EXPECT_GT(shared_by_many, 50);
}

// Nothing of a facet is left where it fades away, and on the way there d changes evenly.
TYPED_TEST(Valley, LosesAFacetThatFadesEvenly) {
    constexpr int kDim = TypeParam::value;
    const auto distance = [&](double left) {
        typename TestFixture::Walls walls;
        const Vector<kDim> up = Vector<kDim>::Unit(kDim - 1);
        const Vector<kDim> aside = Vector<kDim>::Unit(0);
        walls.add(0.3 * kEps, up + 0.7 * aside);
        walls.add(0.31 * kEps, up - 0.7 * aside, left);
        return walls.shared()[0].distance;
    };
    EXPECT_EQ(distance(1e-6), 0.3 * kEps);
    EXPECT_LT(distance(1), 0.28 * kEps);
    for (int k = 1; k <= 1000; ++k) {  // by the root of what is left
        const double root = 1e-3 * k;
        const double before = root - 1e-3;
        EXPECT_LT(std::abs(distance(root * root) - distance(before * before)), 1e-3 * kEps);
    }
}

TYPED_TEST(Valley, LeavesFlatAndBulgingSurfacesAlone) {
    constexpr int kDim = TypeParam::value;
    for (const double bulge : {0.0, 0.02, 0.1}) {
        const auto lowered = [&](const Vector<kDim>& x) {
            return bulge * (x - Vector<kDim>::Ones()).squaredNorm();
        };
        SimplexMesh<kDim> box = test::cube<kDim>(2);
        for (auto x : box.positions.colwise()) {
            x[1] -= lowered(x);
        }
        test::Scene<kDim> scene;
        scene.add(box, Vector<kDim>::Zero());
        const SimplexMesh<kDim> cube = test::cube<kDim>(1);
        scene.add(cube, 3 * Vector<kDim>::Ones());
        ContactFinder<kDim> finder(test::contact_scene<kDim>(scene, kOptions));
        ContactFinder<kDim> own = TestFixture::one_body(box, cube, scene.positions);
        int found = 0;
        for (int k = 0; k < 40; ++k) {
            Vector<kDim> corner = Vector<kDim>::LinSpaced(0.73, 0.81);
            corner[0] += 0.013 * k;
            corner[kDim - 1] += 0.007 * k;
            corner[1] = 2;
            corner[1] += 0.05 - lowered(corner);
            scene.body(1).colwise() += corner - scene.body(1).col(0);
            for (ContactFinder<kDim>* of : {&finder, &own}) {
                for (const Contact<kDim>& contact : of->find(scene.positions, kStiffness).list) {
                    if (contact.kind == ContactKind::PointFacet
                        && contact.vertices[0] == scene.begin[1]) {
                        ++found;
                        EXPECT_TRUE(contact.share == 1 || contact.is_self());  // which may fade
                        EXPECT_EQ(contact.gain, 1);
                    }
                }
            }
        }
        EXPECT_EQ(found, 80) << bulge;
    }
}

TYPED_TEST(Valley, ForcesAreDerivativesOfTheEnergy) {
    constexpr int kDim = TypeParam::value;
    typename TestFixture::Pit pit;
    int in_valleys = 0;
    for (int k = 0; k < 160; ++k) {
        const Positions<kDim> x = pit.at(pit.place(-0.4 + 0.005 * k));
        Positions<kDim> gradient = Positions<kDim>::Zero(kDim, x.cols());
        const std::vector<Contact<kDim>> contacts = pit.contacts(x);
        in_valleys += contacts.size() > 1 ? 1 : 0;
        for (const Contact<kDim>& contact : contacts) {
            EXPECT_EQ(contact.weights[0], 1);  // the vertex, and of the facet a point in its plane
            EXPECT_NEAR(contact.weights.sum(), 0, 1e-14);
            for (int i = 0; i <= kDim; ++i) {
                gradient.col(contact.vertices[i]) -= contact.force(i);
            }
        }
        const auto energy = [&](const Positions<kDim>& at) {
            double sum = 0;
            for (const Contact<kDim>& contact : pit.contacts(at)) {
                sum += contact.energy;
            }
            return sum;
        };
        for (unsigned trial = 0; trial < 3; ++trial) {
            Positions<kDim> step = Positions<kDim>::Zero(kDim, x.cols());
            test::shake<kDim>(step, 1, 60 + trial);
            const double h = 1e-6;
            const double slope = (energy(x + h * step) - energy(x - h * step)) / (2 * h);
            // Where a nearest point is within an edge, a turn of that is taken across it, too.
            EXPECT_NEAR(slope, gradient.cwiseProduct(step).sum(), 1e-4 * gradient.norm()) << k;
        }
    }
    EXPECT_GT(in_valleys, 10);
}

// One body of the same two parts, far apart at rest, has the same contacts with itself.
TYPED_TEST(Valley, OfItsOwnBodyIsThatOfAnother) {
    constexpr int kDim = TypeParam::value;
    typename TestFixture::Pit pit;
    const auto of_cube = [&](const Contacts<kDim>& contacts) {
        std::vector<Contact<kDim>> found;
        for (const Contact<kDim>& contact : contacts.list) {
            if (contact.kind == ContactKind::PointFacet
                && contact.vertices[0] >= static_cast<std::uint32_t>(pit.scene.begin[1])) {
                found.push_back(contact);
            }
        }
        return found;
    };
    ContactFinder<kDim> finder =
        TestFixture::one_body(pit.bodies[0], pit.bodies[1], pit.at(3 * Vector<kDim>::Ones()));
    int in_valleys = 0;
    for (int k = 0; k < 160; ++k) {
        const Positions<kDim> x = pit.at(pit.place(-0.4 + 0.005 * k));
        const std::vector<Contact<kDim>> wanted = pit.contacts(x);
        const std::vector<Contact<kDim>> found = of_cube(finder.find(x, kStiffness));
        ASSERT_EQ(found.size(), wanted.size());
        in_valleys += wanted.size() > 1 ? 1 : 0;
        for (std::size_t i = 0; i < found.size(); ++i) {
            EXPECT_EQ(found[i].vertices, wanted[i].vertices);
            EXPECT_EQ(found[i].weights, wanted[i].weights);
            EXPECT_EQ(found[i].direction, wanted[i].direction);
            EXPECT_EQ(found[i].distance, wanted[i].distance);
            EXPECT_EQ(found[i].share, wanted[i].share);
            EXPECT_EQ(found[i].slope, wanted[i].slope);
        }
    }
    EXPECT_GT(in_valleys, 10);
}

// What was near at rest has no share of a valley: there are as many contacts fewer as the place at
// rest comes nearer.
TYPED_TEST(Valley, OfItsOwnBodyIsOfFacetsThatWereFarAtRest) {
    constexpr int kDim = TypeParam::value;
    typename TestFixture::Pit pit;
    int in_valleys = 0;
    for (int k = 0; k < 20; ++k) {
        const Positions<kDim> rest = pit.at(pit.place(-0.6 + 0.03 * k));
        ContactFinder<kDim> finder = TestFixture::one_body(pit.bodies[0], pit.bodies[1], rest);
        for (int to = 0; to < 20; ++to) {
            const Positions<kDim> x = pit.at(pit.place(-0.4 + 0.04 * to));
            int contacts = 0;
            for (const Contact<kDim>& contact : finder.find(x, kStiffness).list) {
                if (contact.kind != ContactKind::PointFacet) {
                    continue;
                }
                ++contacts;
                Corners<kDim, kDim> facet;
                for (int i = 0; i < kDim; ++i) {
                    facet.col(i) = rest.col(contact.vertices[1 + i]);
                }
                const Corners<kDim, 1> vertex = rest.col(contact.vertices[0]);
                EXPECT_FALSE((ClosestPointSearch<kDim, 1, kDim>(vertex, facet, kEps * kEps).run()))
                    << k << " " << to;
            }
            in_valleys += contacts > 1 ? 1 : 0;
        }
    }
    EXPECT_GT(in_valleys, 10);
}

// Between places so near each other, a force that is 2 k (eps - d) u changes by 2 k times what d
// does, and by what u turns: around a point at a distance d by 1 / d, in a valley by 1 / kappa,
// which is eps / (d (eps - d)).
TYPED_TEST(Valley, ForceTurnsEvenlyWhereTheNearestFacetChanges) {
    constexpr int kDim = TypeParam::value;
    typename TestFixture::Pit pit;
    const auto force = [&](double t) {
        Vector<kDim> sum = Vector<kDim>::Zero();
        for (const Contact<kDim>& contact : pit.contacts(pit.at(pit.place(t)))) {
            sum += contact.force(0);
        }
        return sum;
    };
    const double step = 2e-4;
    Vector<kDim> last = force(-0.4);
    double turned = 0;
    for (int k = 1; k < 4000; ++k) {
        const Vector<kDim> next = force(-0.4 + step * k);
        EXPECT_LT((next - last).norm(), 2 * kStiffness * step * (1 + 2 * kEps / 0.05)) << k;
        turned += (next - last).norm();
        last = next;
    }
    EXPECT_GT(turned, 20);
}

}  // namespace
}  // namespace pent::contact
