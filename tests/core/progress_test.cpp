#include "core/progress.h"

#include <gtest/gtest.h>

#include <chrono>
#include <string>
#include <thread>

namespace simwright::core {
namespace {

ProgressState Training() {
  ProgressState state;
  state.name = "train open";
  state.elapsed = 100.0;
  return state;
}

TEST(ProgressLine, SaysCountDetailAndTimeLeft) {
  ProgressState state = Training();
  state.done = 50;
  state.total = 100;
  state.detail = "46 % succeed";
  EXPECT_EQ(ProgressLine(state), "train open: 50/100, 46 % succeed, 100 s left");
  state.total = 500;  // 2 s per step, 450 steps
  EXPECT_EQ(ProgressLine(state), "train open: 50/500, 46 % succeed, 15 min left");
}

// A training that ends after --minutes does not take the time of all its steps.
TEST(ProgressLine, TimeLeftKeepsToALimit) {
  ProgressState state = Training();
  state.done = 50;
  state.total = 500;
  state.most_left = 30.0;
  EXPECT_EQ(ProgressLine(state), "train open: 50/500, 30 s left");
  state.done = 499;  // the last step takes 0.2 s
  EXPECT_EQ(ProgressLine(state), "train open: 499/500, 0 s left");
  state.done = state.total = 0;
  EXPECT_EQ(ProgressLine(state), "train open: at most 30 s left");
  state.most_left = -5.0;  // overdue: it is at its last step
  EXPECT_EQ(ProgressLine(state), "train open: at most 0 s left");
}

TEST(ProgressLine, WithoutStepsSaysTheTimeSoFar) {
  EXPECT_EQ(ProgressLine(Training()), "train open: 100 s so far");
}

int Lines(const std::string& text, const std::string& with) {
  int count = 0;
  for (size_t at = text.find(with); at != std::string::npos; at = text.find(with, at + 1)) ++count;
  return count;
}

// A stage without completed steps still reports every interval.
TEST(Progress, WithoutATerminalALineComesEveryInterval) {
  Progress progress(Progress::Style::kPlain, 0.02);
  progress.Stage("wait", 3);
  progress.Say("so far 7", 60.0);
  progress.Advance();
  std::string text;
  for (int i = 0; i < 100 && Lines(text, "wait: 1/3, so far 7, ") < 2; ++i) {
    testing::internal::CaptureStderr();
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
    text += testing::internal::GetCapturedStderr();
  }
  EXPECT_GE(Lines(text, "wait: 1/3, so far 7, "), 2) << text;
  EXPECT_EQ(Lines(text, "s left\n"), Lines(text, "wait: ")) << text;
  testing::internal::CaptureStderr();
  progress.Finish();
  text = testing::internal::GetCapturedStderr();
  const std::string end = text.substr(text.rfind("wait: "));
  EXPECT_EQ(end.find("left"), std::string::npos) << end;
  EXPECT_NE(end.find(" s\n"), std::string::npos) << end;
}

TEST(Progress, ASilentOneWritesNothing) {
  testing::internal::CaptureStderr();
  {
    Progress progress;
    progress.Stage("wait", 3);
    progress.Say("so far 7");
    progress.Advance();
    progress.Finish();
  }
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
}

}  // namespace
}  // namespace simwright::core
