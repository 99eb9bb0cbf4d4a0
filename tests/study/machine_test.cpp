#include "machine.h"

#include "support/messages.h"

#include <gtest/gtest.h>

namespace pent::study {
namespace {

TEST(Machine, IsNamedAndHasAProcessor) {
    EXPECT_FALSE(this_machine().node.empty());
    EXPECT_FALSE(this_machine().processor.empty());
}

TEST(Machine, HasTheModelOfItsFirstProcessor) {
    EXPECT_EQ(model_name("processor\t: 0\nmodel\t\t: 1\nmodel name\t: A: B\nmodel name\t: C\n"),
              "A: B");
    EXPECT_EQ(model_name("Processor\t: 0\n"), "");
    EXPECT_EQ(model_name("model name\t:\n"), "");
}

TEST(Machine, OfAnotherModelHasOtherTimes) {
    EXPECT_EQ(mixture_warning({}), "");
    EXPECT_EQ(mixture_warning({{"n1", "A"}, {"n2", "A"}}), "");
    pent::test::expect_contains(mixture_warning({{"n1", "B"}, {"n2", "A"}, {"n1", "B"}}),
                                {"(A: 1 run, B: 2 runs)", "do not compare"});
}

}  // namespace
}  // namespace pent::study
