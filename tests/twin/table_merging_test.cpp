#include "twin/table_merging.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/error.h"
#include "library_fit/fit_kinds.h"

namespace simwright::twin {
namespace {

struct Known {
  const char* kind;
  double x, y, yaw;
};
const std::vector<Known> kObjects{{"mug", 0.0, 0.9, 0.3},
                                  {"bottle", 0.2, 1.0, 0.0},
                                  {"mug", -0.2, 1.1, -1.0},
                                  {"bowl", 0.05, 1.2, 0.5}};

// The reconstruction that a camera turned and moved against the first one makes, `scale` times too
// large, of the objects listed.
TableReconstruction Seen(const std::vector<int>& objects, double turn, const Eigen::Vector2d& move,
                         double scale, double position_error) {
  TableReconstruction table;
  table.log_scale_error = scale == 1.0 ? 0.0 : 0.1;
  for (const int index : objects) {
    const Known& known = kObjects[static_cast<size_t>(index)];
    const Eigen::Vector2d at =
        scale * (Eigen::Rotation2Dd(-turn) * (Eigen::Vector2d(known.x, known.y) - move));
    ReconstructedObject object;
    object.fit.instance.kind = library_fit::FindFitKind(known.kind);
    object.fit.pose = {at.x(), at.y(), known.yaw - turn};
    object.position_error = position_error;
    object.yaw_error = 0.1;
    object.size_error = 0.05;
    object.confidence = 0.6;
    table.objects.push_back(object);
  }
  return table;
}

TEST(MergeTables, AlignsAndAverages) {
  std::vector<TableReconstruction> views{Seen({0, 1, 2, 3}, 0.0, {0, 0}, 1.0, 0.02),
                                         Seen({3, 2, 1, 0}, 1.4, {0.6, 0.8}, 1.0, 0.01)};
  // The second photo sees the mug 1 cm farther along x of the first one, with half the error.
  const Eigen::Vector2d off = Eigen::Rotation2Dd(-1.4) * Eigen::Vector2d(0.01, 0.0);
  views[1].objects[3].fit.pose.x += off.x();
  views[1].objects[3].fit.pose.y += off.y();
  const MergedTables merged = MergeTables(views, {});
  ASSERT_EQ(merged.objects.size(), 4u);
  EXPECT_TRUE(merged.findings.empty());
  EXPECT_EQ(merged.log_scale_error, 0.0);
  EXPECT_NEAR(merged.first_from_view[1].turn, 1.4, 0.03);
  EXPECT_NEAR(merged.objects[0].pose.x, 0.008, 0.004);
  EXPECT_NEAR(merged.objects[2].pose.x, -0.2, 0.004);
  EXPECT_NEAR(merged.objects[2].pose.y, 1.1, 0.004);
  EXPECT_NEAR(merged.objects[1].pose.yaw, 0.0, 0.03);
  EXPECT_NEAR(merged.objects[0].position_error, 1.0 / std::sqrt(2500.0 + 10000.0), 1e-9);
  EXPECT_NEAR(merged.objects[0].confidence, 1.0 - 0.4 * 0.4, 1e-9);
  EXPECT_EQ(merged.objects[0].seen_in, (std::vector<int>{0, 1}));
}

// The first is 10 % too large, the second 10 % too small: what they share is right.
TEST(MergeTables, AveragesUnknownScales) {
  const MergedTables merged = MergeTables({Seen({0, 1, 2}, 0.0, {0, 0}, 1.1, 0.01),
                                           Seen({0, 1, 2}, -0.8, {-0.5, 0.4}, 1.0 / 1.1, 0.01)},
                                          {});
  EXPECT_NEAR(merged.log_scale, -std::log(1.1), 1e-6);
  EXPECT_NEAR(merged.log_scale_error, 0.1 / std::sqrt(2.0), 1e-9);
  EXPECT_NEAR(merged.objects[1].pose.x, 0.2, 1e-6);
  EXPECT_NEAR(merged.objects[1].pose.y, 1.0, 1e-6);
  EXPECT_NEAR(merged.objects[1].size_factor, merged.objects[1].view == 0 ? 1.0 / 1.1 : 1.1, 1e-6);
}

TEST(MergeTables, AddsWhatTheFirstDoesNotShowAndReportsDisagreement) {
  std::vector<TableReconstruction> views{Seen({0, 1, 2}, 0.0, {0, 0}, 1.0, 0.01),
                                         Seen({0, 1, 2, 3}, 0.7, {0.3, 0.2}, 1.0, 0.01)};
  views[1].objects[1].fit.instance.kind = library_fit::FindFitKind("jar");
  views[1].objects[1].confidence = 0.9;
  const MergedTables merged = MergeTables(views, {});
  ASSERT_EQ(merged.objects.size(), 4u);
  EXPECT_EQ(merged.objects[3].view, 1);
  EXPECT_NEAR(merged.objects[3].pose.x, 0.05, 1e-6);
  EXPECT_NEAR(merged.objects[3].pose.yaw, 0.5, 1e-6);
  ASSERT_EQ(merged.findings.size(), 1u);
  EXPECT_EQ(merged.findings[0].code, "twin-views-disagree");
  EXPECT_NE(merged.findings[0].sentence.find("bottle in photo 1, jar in photo 2"),
            std::string::npos);
  EXPECT_EQ(merged.objects[1].view, 1);
  views[1].objects[3].confidence = 0.1;
  EXPECT_EQ(MergeTables(views, {}).objects.size(), 3u);
}

TEST(MergeTables, NamesTheAssetsThatWereFoundAgain) {
  std::vector<TableReconstruction> views{Seen({0, 1, 2}, 0.0, {0, 0}, 1.0, 0.01),
                                         Seen({0, 1, 2, 3}, 0.7, {0.3, 0.2}, 1.0, 0.01)};
  views[1].objects[1].retrieved = 1;
  views[1].objects[1].confidence = 0.9;
  views[1].objects[3].retrieved = 0;
  views[1].objects[3].confidence = 0.1;
  std::vector<TableAsset> assets(2);
  assets[0].name = "my_plate";
  assets[1].name = "my_vase";
  const core::Findings findings = MergeTables(views, assets).findings;
  ASSERT_EQ(findings.size(), 2u);
  EXPECT_EQ(findings[0].place, "my_plate");
  EXPECT_EQ(findings[1].place, "my_vase");
  EXPECT_NE(findings[1].sentence.find("bottle in photo 1, my_vase in photo 2"), std::string::npos)
      << findings[1].sentence;
}

TEST(MergeTables, RefusesPhotosOfOtherTables) {
  EXPECT_THROW(
      MergeTables({Seen({0, 1}, 0.0, {0, 0}, 1.0, 0.01), Seen({2, 3}, 0.3, {0, 0}, 1.0, 0.01)}, {}),
      core::Error);
  EXPECT_THROW(MergeTables({}, {}), core::Error);
}

}  // namespace
}  // namespace simwright::twin
