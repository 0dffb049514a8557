// The log: levels, the caller's own sink, one whole line per call from any thread, and stderr.
#include "core/log.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <ostream>
#include <regex>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "core/error.h"

namespace simwright::core {
namespace {

// Collects the lines of a test; afterwards the log is off and writes to stderr again.
class LogTest : public ::testing::Test {
 protected:
  void SetUp() override {
    SetLogSink([this](const LogLine& line) {
      lines_.push_back(std::string(NameOf(line.level)) + " " + std::string(line.module) + ": " +
                       std::string(line.text));
    });
  }
  void TearDown() override {
    SetLogLevel(LogLevel::kOff);
    SetLogSink({});
  }
  std::vector<std::string> lines_;
};

// Counts how often it is printed.
struct Printed {
  int* count;
};
std::ostream& operator<<(std::ostream& out, const Printed& printed) {
  ++*printed.count;
  return out << "printed";
}

TEST_F(LogTest, LinesFromTheLevelOnAreLogged) {
  const std::vector<LogLevel> levels = {LogLevel::kTrace, LogLevel::kDebug, LogLevel::kInfo,
                                        LogLevel::kWarn, LogLevel::kError};
  for (std::size_t least = 0; least <= levels.size(); ++least) {
    SetLogLevel(least < levels.size() ? levels[least] : LogLevel::kOff);
    lines_.clear();
    for (const LogLevel level : levels) {
      EXPECT_EQ(IsLogged(level), level >= CurrentLogLevel());
      Log(level, "core", "line");
    }
    EXPECT_EQ(lines_.size(), levels.size() - least);
  }
  EXPECT_FALSE(IsLogged(LogLevel::kOff));
}

TEST_F(LogTest, PiecesAreJoinedAndOnlyPrintedWhenLogged) {
  int count = 0;
  SetLogLevel(LogLevel::kInfo);
  Log(LogLevel::kDebug, "core", Printed{&count});
  EXPECT_EQ(count, 0);
  Log(LogLevel::kInfo, "assets", "read ", 3, " parts, ", 0.25, " kg, ", Printed{&count});
  EXPECT_EQ(count, 1);
  EXPECT_EQ(lines_, std::vector<std::string>{"info assets: read 3 parts, 0.25 kg, printed"});
}

TEST_F(LogTest, ALineStaysOneLine) {
  SetLogLevel(LogLevel::kTrace);
  Log(LogLevel::kError, "assets", "name\n\x1b[31mred\ttab {} {0} %s \xc3\xbc");
  EXPECT_EQ(lines_, std::vector<std::string>{"error assets: name  [31mred tab {} {0} %s \xc3\xbc"});
}

TEST_F(LogTest, NamesAndLevelsConvert) {
  for (const char* name : {"trace", "debug", "info", "warn", "error", "off"}) {
    EXPECT_STREQ(NameOf(LogLevelNamed(name)), name);
  }
  try {
    LogLevelNamed("loud");
    ADD_FAILURE();
  } catch (const Error& error) {
    EXPECT_STREQ(error.what(),
                 "loud: is not a log level (use trace, debug, info, warn, error or off)");
  }
}

TEST_F(LogTest, ThreadsWriteWholeLinesOneAtATime) {
  constexpr int kThreads = 4, kLines = 500;
  std::atomic<int> inside{0};
  int overlaps = 0;
  std::vector<std::string> texts;
  SetLogLevel(LogLevel::kInfo);
  SetLogSink([&](const LogLine& line) {
    if (++inside != 1) ++overlaps;
    texts.emplace_back(line.text);
    --inside;
  });
  std::vector<std::thread> threads;
  for (int t = 0; t < kThreads; ++t) {
    threads.emplace_back([t] {
      for (int i = 0; i < kLines; ++i) Log(LogLevel::kInfo, "core", "thread ", t, " line ", i);
    });
  }
  for (std::thread& thread : threads) thread.join();
  EXPECT_EQ(overlaps, 0);
  ASSERT_EQ(texts.size(), static_cast<std::size_t>(kThreads * kLines));
  for (int t = 0; t < kThreads; ++t) {
    const std::string last = "thread " + std::to_string(t) + " line " + std::to_string(kLines - 1);
    EXPECT_EQ(std::count(texts.begin(), texts.end(), last), 1);
  }
}

TEST_F(LogTest, AFaultOfTheSinkDoesNotReachTheCaller) {
  SetLogLevel(LogLevel::kInfo);
  SetLogSink([](const LogLine&) { throw std::runtime_error("the disk is full"); });
  ::testing::internal::CaptureStderr();
  EXPECT_NO_THROW(Log(LogLevel::kInfo, "core", "line"));
  EXPECT_NE(::testing::internal::GetCapturedStderr().find("the disk is full"), std::string::npos);
}

TEST_F(LogTest, WritesToStderrByDefault) {
  SetLogLevel(LogLevel::kWarn);
  ::testing::internal::CaptureStderr();
  SetLogSink({});
  Log(LogLevel::kInfo, "core", "not this one");
  Log(LogLevel::kWarn, "rl", "success ", 0.5);
  const std::string text = ::testing::internal::GetCapturedStderr();
  EXPECT_TRUE(std::regex_match(
      text,
      std::regex("\\[\\d\\d:\\d\\d:\\d\\d\\.\\d{3}\\] \\[warning\\] \\[rl\\] success 0\\.5\n")))
      << text;
}

}  // namespace
}  // namespace simwright::core
