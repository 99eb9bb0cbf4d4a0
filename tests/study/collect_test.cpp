#include "collect.h"

#include <gtest/gtest.h>

namespace pent::study {
namespace {

TEST(Ranges, AreWrittenAsPeopleDo) {
    EXPECT_EQ(ranges_text({}), "");
    EXPECT_EQ(ranges_text({3}), "3");
    EXPECT_EQ(ranges_text({1, 2, 3, 5, 7, 8}), "1-3, 5, 7-8");
}

}  // namespace
}  // namespace pent::study
