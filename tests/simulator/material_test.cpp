#include <pent/error.h>
#include <pent/simulator/material.h>

#include <gtest/gtest.h>

#include <limits>

namespace pent::simulator {
namespace {

// Hooke's law for a bar under stress along one axis only must give back E and nu.
TEST(LameFromYoung, MakesABarStretchByStressOverYoungAndNarrowByPoisson) {
    for (const int dim : {2, 3, 4, 5}) {
        const double young = 3e4;
        for (const double poisson : {-0.6, 0.0, 0.1, 0.9 * poisson_limit(dim)}) {
            const Lame lame = lame_from_young(dim, young, poisson);
            const double along = 1e-3;
            const double across = -poisson * along;
            const double trace = along + (dim - 1) * across;
            // A few roundings of terms that grow like 1 / (1 - (n-1) nu) <= 10.
            EXPECT_NEAR(2 * lame.mu * along + lame.lambda * trace, young * along, 1e-12 * young);
            EXPECT_NEAR(2 * lame.mu * across + lame.lambda * trace, 0, 1e-12 * young);
        }
    }
}

TEST(LameFromYoung, IsTheTextbookFormulaInThreeDimensions) {
    const Lame lame = lame_from_young(3, 1.0, 0.25);
    EXPECT_DOUBLE_EQ(lame.mu, 0.4);
    EXPECT_DOUBLE_EQ(lame.lambda, 0.4);
}

TEST(LameFromYoung, RefusesPoissonAtTheLimitOfTheDimension) {
    EXPECT_NO_THROW(static_cast<void>(lame_from_young(3, 1, 0.4)));
    for (const double poisson : {1.0 / 3, 0.4, -1.0, -2.0}) {
        try {
            static_cast<void>(lame_from_young(4, 1, poisson));
            FAIL() << poisson;
        } catch (const Error& error) {
            EXPECT_NE(std::string(error.what()).find("1/3"), std::string::npos) << error.what();
        }
    }
    EXPECT_THROW(static_cast<void>(lame_from_young(4, 0, 0.2)), Error);
    EXPECT_THROW(static_cast<void>(lame_from_young(4, -1, 0.2)), Error);
}

TEST(YoungFromLame, InvertsLameFromYoung) {
    for (const int dim : {2, 3, 4}) {
        const YoungPoisson back = young_from_lame(dim, lame_from_young(dim, 7e5, 0.28));
        EXPECT_NEAR(back.young, 7e5, 1e-9 * 7e5);
        EXPECT_NEAR(back.poisson, 0.28, 1e-14);
    }
}

TEST(CheckMaterial, WantsPositiveShearBulkAndDensity) {
    const Material good{.lame = {.lambda = -0.4, .mu = 1}, .density = 1};
    EXPECT_NO_THROW(check(good, 4));  // bulk modulus -0.4 + 2/4 > 0
    EXPECT_THROW(check(Material{.lame = {.lambda = -0.5, .mu = 1}}, 4), Error);
    EXPECT_THROW(check(Material{.lame = {.lambda = 1, .mu = 0}}, 4), Error);
    EXPECT_THROW(check(Material{.lame = {.lambda = 1, .mu = 1}, .density = 0}, 4), Error);
}

// To be told from numbers that are merely large.
TEST(CheckMaterial, WantsFiniteNumbersAlone) {
    for (const double wrong :
         {std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity(),
          std::numeric_limits<double>::quiet_NaN()}) {
        EXPECT_THROW(check(Material{.lame = {.lambda = 1, .mu = wrong}, .density = 1}, 4), Error);
        EXPECT_THROW(check(Material{.lame = {.lambda = wrong, .mu = 1}, .density = 1}, 4), Error);
        EXPECT_THROW(check(Material{.lame = {.lambda = 1, .mu = 1}, .density = wrong}, 4), Error);
        EXPECT_THROW(static_cast<void>(lame_from_young(4, wrong, 0.2)), Error);
        EXPECT_THROW(static_cast<void>(lame_from_young(4, 1, wrong)), Error);
    }
    EXPECT_NO_THROW(check(Material{.lame = {.lambda = 1e300, .mu = 1e300}, .density = 1e300}, 4));
}

}  // namespace
}  // namespace pent::simulator
