#include "physics_params/size_plausibility.h"

#include <gtest/gtest.h>

#include "core/error.h"

namespace simwright::physics_params {
namespace {

const Category& Named(const char* name) {
  return *KnowledgeBase::Shipped().FindCategory(name);
}

// A chair of 0.45 x 0.5 x 0.9 m whose numbers are in each unit, read as metres.
TEST(SizePlausibility, AChairReadInAWrongUnitIsAbsurdAndItsUnitIsFound) {
  const Eigen::Vector3d metres(0.45, 0.5, 0.9);
  EXPECT_FALSE(IsAbsurdSize(Named("chair"), metres));
  EXPECT_DOUBLE_EQ(SizeFactor(Named("chair"), metres), 1.0);
  for (const char* unit : {"cm", "mm", "in"}) {
    const Eigen::Vector3d numbers = metres / MetresOfUnit(unit);
    EXPECT_TRUE(IsAbsurdSize(Named("chair"), numbers)) << unit;
    EXPECT_EQ(UnitsThatFit(Named("chair"), numbers), std::vector<std::string>{unit});
  }
  EXPECT_NEAR(SizeFactor(Named("chair"), metres * 100.0), 90.0 / 1.22, 1e-9);
  EXPECT_NEAR(SizeFactor(Named("chair"), metres / 10.0), 0.09 / 0.72, 1e-9);
  EXPECT_TRUE(UnitsThatFit(Named("chair"), Eigen::Vector3d(7, 7, 7)).empty());
  // 8 x 8 x 10 may be centimetres or inches: people mean the former.
  EXPECT_EQ(UnitsThatFit(Named("object"), Eigen::Vector3d(8, 8, 10)).front(), "cm");
}

TEST(SizePlausibility, NoRowIsAbsurdItself) {
  for (const Category& c : KnowledgeBase::Shipped().categories()) {
    EXPECT_FALSE(IsAbsurdSize(c, {c.length.min, c.width.min, c.height.min})) << c.name;
    EXPECT_FALSE(IsAbsurdSize(c, {c.length.max, c.width.max, c.height.max})) << c.name;
  }
}

TEST(SizePlausibility, SaysTheSizeAndTheUsualOne) {
  EXPECT_EQ(SizeSentence(Named("chair"), {44.5, 40.0, 89.5}),
            "its size of 44.5 x 40 x 89.5 m is 73.4 times that of the largest 'chair', whose "
            "longest side is 0.72 to 1.22 m");
  EXPECT_THROW(MetresOfUnit("parsec"), core::Error);
}

}  // namespace
}  // namespace simwright::physics_params
