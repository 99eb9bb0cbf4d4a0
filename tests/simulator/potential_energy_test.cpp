#include "potentials/potential_energy.h"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace pent::simulator {
namespace {

constexpr int kDim = 3;

// k/2 |x|^2 of all vertices, which counts how often it was asked.
class Spring final : public Potential<kDim> {
public:
    explicit Spring(double k) : k_(k) {}

    double evaluate(const Positions<kDim>& x, Positions<kDim>& gradient) override {
        ++evaluations;
        value_ = 0.5 * k_ * x.squaredNorm();
        gradient += k_ * x;
        return value_;
    }
    void add_hessian(const Positions<kDim>& /*x*/,
                     double /*weight*/,
                     Filter /*filter*/,
                     NewtonSystem<kDim>& /*system*/) override {}
    std::vector<TermEnergy> energies() const override {
        return {{"spring " + std::to_string(static_cast<int>(k_)), value_}};
    }
    bool begin_step(const StepStart<kDim>& start) override {
        return std::exchange(k_, start.h) != start.h;  // a stiffness that is held during a step
    }
    double max_step(const Positions<kDim>& /*from*/, const Positions<kDim>& /*to*/) override {
        return step_limit;
    }
    bool is_bounded() const override { return step_limit < 1; }
    bool adapt() override { return std::exchange(will_adapt, false); }
    double rounding() const override { return 1e-3 * k_; }
    bool has_kink() const override { return is_kinked; }

    int evaluations = 0;
    double step_limit = 1;
    bool will_adapt = false;
    bool is_kinked = false;

private:
    double k_;
    double value_ = 0;
};

class PotentialEnergyTest : public testing::Test {
protected:
    PotentialEnergy<kDim> sum_;
    Spring& first_ = sum_.add(std::make_unique<Spring>(2));
    Spring& second_ = sum_.add(std::make_unique<Spring>(5));
    Positions<kDim> x_ = Positions<kDim>::Random(kDim, 4);
};

TEST_F(PotentialEnergyTest, IsTheSumOfItsTerms) {
    sum_.update(x_);
    EXPECT_DOUBLE_EQ(sum_.value(), 3.5 * x_.squaredNorm());
    EXPECT_LT((sum_.gradient() - 7 * x_).norm(), 1e-14 * x_.norm());
    EXPECT_LT((sum_.gradient_of(second_) - 5 * x_).norm(), 1e-14 * x_.norm());
    const std::vector<TermEnergy> parts = sum_.energies();
    ASSERT_EQ(parts.size(), 2U);  // in the order in which they were added
    EXPECT_EQ(parts[0].name, "spring 2");
    EXPECT_EQ(parts[1].name, "spring 5");
    EXPECT_DOUBLE_EQ(parts[0].energy + parts[1].energy, sum_.value());
    EXPECT_DOUBLE_EQ(sum_.rounding(), 7e-3);
}

TEST_F(PotentialEnergyTest, IsNotEvaluatedTwiceAtOnePlace) {
    sum_.update(x_);
    sum_.update(x_);
    EXPECT_EQ(first_.evaluations, 1);
    sum_.invalidate();
    sum_.update(x_);
    EXPECT_EQ(first_.evaluations, 2);
    x_(0, 0) = std::nextafter(x_(0, 0), 2);
    sum_.update(x_);
    EXPECT_EQ(first_.evaluations, 3);
}

TEST_F(PotentialEnergyTest, GoesAsFarAsEachOfItsTermsLets) {
    EXPECT_FALSE(sum_.is_bounded());
    EXPECT_EQ(sum_.max_step(x_, 2 * x_), 1);
    first_.step_limit = 0.75;
    second_.step_limit = 0.25;
    EXPECT_TRUE(sum_.is_bounded());
    EXPECT_EQ(sum_.max_step(x_, 2 * x_), 0.25);
}

// Whatever a term takes from the start of a step, or learns in one, counts at once.
TEST_F(PotentialEnergyTest, IsEvaluatedAgainWhereATermHasChanged) {
    sum_.update(x_);
    const Positions<kDim> still = Positions<kDim>::Zero(kDim, x_.cols());
    sum_.begin_step({.positions = x_,
                     .velocities = still,
                     .origin = x_,
                     .prescribed_displacement = still,
                     .h = 0.5});
    sum_.update(x_);
    EXPECT_DOUBLE_EQ(sum_.value(), 0.5 * x_.squaredNorm());
    EXPECT_FALSE(sum_.adapt());
    second_.will_adapt = true;
    EXPECT_TRUE(sum_.adapt());
    EXPECT_FALSE(sum_.has_kink());
    first_.is_kinked = true;
    EXPECT_TRUE(sum_.has_kink());
}

}  // namespace
}  // namespace pent::simulator
