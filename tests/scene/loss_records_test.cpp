// Training losses as a table and as a plot.
#include "scene/model/loss_records.h"

#include <cmath>

#include <gtest/gtest.h>

#include "core/files.h"

namespace simwright::scene {
namespace {

std::vector<LossRecord> Losses(int count) {
  std::vector<LossRecord> losses;
  for (int i = 1; i <= count; ++i) {
    losses.push_back({50 * i, 2.0 / i, 0.8 / i, 0.9 / i, 0.01 / i, 1.5 / i, 1.0 / i});
  }
  return losses;
}

TEST(LossRecords, AreReadAsTheyWereWritten) {
  const core::TemporaryFolder folder;
  const std::filesystem::path path = folder.path() / "losses.csv";
  EXPECT_TRUE(ReadLosses(path, 100).empty());
  core::WriteFile(path, LossesText(Losses(4)) + "250,0.1,cut o");
  const std::vector<LossRecord> read = ReadLosses(path, 150);
  ASSERT_EQ(read.size(), 3u);
  EXPECT_EQ(read[2].step, 150);
  EXPECT_NEAR(read[2].total, 2.0 / 3.0, 1e-6);
  EXPECT_NEAR(read[2].cross_entropy, 0.5, 1e-6);
  EXPECT_NEAR(read[2].held_out, 1.0 / 3.0, 1e-6);
  EXPECT_EQ(ReadLosses(path, 1000).size(), 4u);
  EXPECT_TRUE(ReadLosses(path, 0).empty());
}

// Panels are 660 pixels wide from 80 on and 220 high, the zero line of the upper one at 280. It
// reaches to 1.1, because the first record, 2, belongs to the first twentieth and is clamped to the
// top.
TEST(LossRecords, CurvesHaveAPointARecord) {
  const std::string svg = LossCurves("one & two", Losses(20));
  EXPECT_NE(svg.find("one &amp; two"), std::string::npos);
  EXPECT_NE(svg.find("<polyline class=\"one\" points=\"113.0,60.0 146.0,80.0 "), std::string::npos);
  EXPECT_NE(svg.find(" 740.0,270.0 \"/>"), std::string::npos);  // held out, 0.05
  for (const std::vector<LossRecord>& few : {Losses(0), Losses(1)}) {
    const std::string of_few = LossCurves("few", few);
    EXPECT_EQ(of_few.find("nan"), std::string::npos);
    EXPECT_EQ(of_few.find("inf"), std::string::npos);
  }
  std::vector<LossRecord> unknown = Losses(3);
  for (LossRecord& loss : unknown) loss.held_out = NAN;  // nothing was held out
  EXPECT_EQ(LossCurves("unknown", unknown).find("nan"), std::string::npos);
}

}  // namespace
}  // namespace simwright::scene
