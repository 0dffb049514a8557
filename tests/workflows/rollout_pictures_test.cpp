// `rollout --pictures --poses`: the pictures and poses of one episode.
#include <gtest/gtest.h>

#include <sstream>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "core/image.h"
#include "program.h"
#include "scripted_run.h"

namespace simwright::workflows {
namespace {
using nlohmann::json;

class RolloutPictures : public ScriptedRuns {};

// Returns the mean row of the red pixels of a frame, or -1.
double RedRow(const core::Image& strip, int column, int row, int size) {
  double sum = 0.0;
  int count = 0;
  for (int y = 0; y < size; ++y) {
    for (int x = 0; x < size; ++x) {
      const std::uint8_t* pixel = strip.At(column * size + x, row * size + y);
      if (pixel[0] < 2 * pixel[1] || pixel[0] < 2 * pixel[2] || pixel[0] < 40) continue;
      sum += y;
      ++count;
    }
  }
  return count == 0 ? -1.0 : sum / count;
}

TEST_F(RolloutPictures, ShowTheBlockStandingAndThenLifted) {
  const Outcome outcome = RunProgram("rollout --quiet " + Pick() + " --episodes 2 --pictures " +
                                     Path("p.png") + " --poses " + Path("p.jsonl"));
  ASSERT_EQ(outcome.code, 0) << outcome.text;
  const core::Image strip = core::ReadImage(Path("p.png"));
  const int size = strip.width / 6;
  ASSERT_EQ(strip.height, 2 * size);
  const double first = RedRow(strip, 0, 0, size), last = RedRow(strip, 5, 1, size);
  ASSERT_GT(first, 0.0) << "the block is seen";
  ASSERT_GT(last, 0.0);
  EXPECT_LT(last, first - 0.05 * size) << "and goes up";

  std::istringstream lines(core::ReadFile(Path("p.jsonl")));
  std::string line;
  std::getline(lines, line);
  const json head = json::parse(line);
  EXPECT_EQ(head.at("task"), "pick_up_block");
  EXPECT_EQ(head.at("success"), true);
  ASSERT_EQ(head.at("joints").size(), 8u);
  std::vector<json> moments;
  while (std::getline(lines, line)) moments.push_back(json::parse(line));
  EXPECT_EQ(moments.size(), head.at("subtasks")[0].at("lines").get<size_t>());
  const double start = moments.front().at("things")[0][2], end = moments.back().at("things")[0][2];
  EXPECT_NEAR(start, 0.0, 1e-3);  // on the floor
  EXPECT_NEAR(end, 0.15, 0.03);   // the goal height of its centre is 19 cm
}

}  // namespace
}  // namespace simwright::workflows
