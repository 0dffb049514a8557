// The files of a training, read back by this project and by others.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <limits>
#include <sstream>

#include "core/error.h"
#include "core/files.h"
#include "rl/crc32c.h"
#include "rl/event_file.h"
#include "rl/policy_file.h"
#include "rl/training_curves.h"
#include "rl/training_log.h"

namespace simwright::rl {
namespace {

TrainingRecord RecordAt(int iteration) {
  TrainingRecord record;
  double value = iteration;
  for (const TrainingColumn& column : kTrainingColumns) {
    record.*column.value = value;
    value = value / 3.0 + 0.1;
  }
  record.iteration = iteration;
  record.samples = 4096.0 * iteration;
  if (iteration < 3) record.mean_return = std::numeric_limits<double>::quiet_NaN();
  return record;
}

// Returns the output of `command`. Fails the test if it exits with anything but 0.
std::string OutputOf(const std::string& command) {
  std::string output;
  FILE* pipe = popen(command.c_str(), "r");
  if (pipe == nullptr) return output;
  char buffer[4096];
  while (const std::size_t count = fread(buffer, 1, sizeof(buffer), pipe)) {
    output.append(buffer, count);
  }
  EXPECT_EQ(pclose(pipe), 0) << command << "\n" << output;
  return output;
}

// RFC 3720, appendix B.4, and the check value of the CRC catalogue.
TEST(Crc32c, HasItsPublishedValues) {
  EXPECT_EQ(Crc32c("123456789"), 0xE3069283u);
  EXPECT_EQ(Crc32c(std::string(32, '\0')), 0x8A9136AAu);
  EXPECT_EQ(Crc32c(std::string(32, '\xFF')), 0x62A8AB43u);
  EXPECT_EQ(Crc32c(""), 0u);
}

TEST(EventFile, AnotherReaderFindsTheNumbersOfTheTable) {
  const core::TemporaryFolder folder;
  TrainingLog log(folder.path(), 0);
  for (int i = 1; i <= 5; ++i) log.Append(RecordAt(i));
  const std::string output = OutputOf("python3 " SIMWRIGHT_TEST_DATA "/read_events.py " +
                                      (folder.path() / "events.out.tfevents.0.simwright").string());
  std::istringstream lines(output);
  int step = 0, found = 0;
  std::string name;
  double value = 0.0;
  while (lines >> step >> name >> value) {
    for (const TrainingColumn& column : kTrainingColumns) {
      if (name != column.name) continue;
      EXPECT_EQ(static_cast<float>(value), static_cast<float>(RecordAt(step).*column.value));
      ++found;
    }
  }
  EXPECT_EQ(found, 5 * static_cast<int>(kTrainingColumns.size()) - 2);  // two means are unknown
}

TEST(EventFile, WhatIsDamagedOrLateIsCutOff) {
  const std::string start = EventFileStart(1.7e9), one = EventRecord(1.7e9, 1, {{"a", 1.0f}}),
                    big = EventRecord(1.7e9, 300, {{"a", 2.0f}});
  EXPECT_EQ(EventsUpTo(start + one + big, 300), (start + one + big).size());
  EXPECT_EQ(EventsUpTo(start + one + big, 299), (start + one).size());
  EXPECT_EQ(EventsUpTo(start + one + big.substr(0, big.size() - 1), 300), (start + one).size());
  std::string flipped = start + one + big;
  flipped[start.size() + 20] ^= 1;
  EXPECT_EQ(EventsUpTo(flipped, 300), start.size());
  EXPECT_EQ(EventsUpTo("no events at all, but a text", 300), 0u);
  EXPECT_EQ(EventsUpTo("", 300), 0u);
}

TEST(TrainingLog, GoesOnAfterTheCheckpointsRowAndKeepsEveryDigit) {
  const core::TemporaryFolder folder;
  {
    TrainingLog log(folder.path(), 0);
    for (int i = 1; i <= 6; ++i) log.Append(RecordAt(i));
  }
  const std::string whole = core::ReadFile(folder.path() / "training.csv");
  core::WriteFile(folder.path() / "training.csv", whole.substr(0, whole.size() - 30));  // torn
  TrainingLog log(folder.path(), 4);
  ASSERT_EQ(log.records().size(), 4u);
  log.Append(RecordAt(5));
  log.Append(RecordAt(6));
  EXPECT_EQ(core::ReadFile(folder.path() / "training.csv"), whole);
  const std::vector<TrainingRecord> read = ReadTrainingTable(folder.path() / "training.csv", 99);
  ASSERT_EQ(read.size(), 6u);
  EXPECT_EQ(read[3].kl, RecordAt(4).kl);
  EXPECT_TRUE(std::isnan(read[0].mean_return));
  const std::string events = core::ReadFile(folder.path() / "events.out.tfevents.0.simwright");
  EXPECT_EQ(EventsUpTo(events, 6), events.size());
  EXPECT_LT(EventsUpTo(events, 5), events.size());

  core::WriteFile(folder.path() / "training.csv", "a,b\n1,2\n");
  EXPECT_THROW(TrainingLog(folder.path(), 4), core::Error);
  EXPECT_THROW(TrainingLog(folder.path() / "none", 0), core::Error);
}

// Returns the numbers of points of the curves in a file, and their extent.
std::string PointsOf(const std::filesystem::path& svg) {
  return OutputOf(
      "python3 -c \"import sys,xml.etree.ElementTree as t; r=t.parse(sys.argv[1]).getroot(); "
      "p=[[float(q.split(',')[0]) for q in e.get('points').split()] for e in r.iter() "
      "if e.get('points')]; print(*[len(x) for x in p], *[round(max(x)-min(x)) for x in p])\" " +
      svg.string());
}

TEST(TrainingCurves, AreSoundXmlWithAPointARecord) {
  const core::TemporaryFolder folder;
  std::vector<TrainingRecord> records;
  for (int i = 1; i <= 40; ++i) {
    records.push_back(RecordAt(i));
    records.back().success = i / 40.0;
    records.back().success_low = i / 50.0;
    records.back().success_high = std::min(1.0, i / 35.0);
    records.back().mean_return = 100.0 - i;
  }
  core::WriteFile(folder.path() / "c.svg", TrainingCurves("open <the> door & more", records));
  // The band goes there and back; the panel is 660 pixels wide, the first record at a fortieth.
  EXPECT_EQ(PointsOf(folder.path() / "c.svg"), "80 40 40 644 644 644\n");
  for (const std::vector<TrainingRecord>& few :
       {std::vector<TrainingRecord>(), std::vector<TrainingRecord>{RecordAt(1)}}) {
    const std::string svg = TrainingCurves("none", few);
    EXPECT_EQ(svg.find("nan"), std::string::npos);
    EXPECT_EQ(svg.find("inf"), std::string::npos);
  }
}

// A training that ends at its first examination has a single record.
TEST(TrainingCurves, ALoneRecordIsAStrokeThatIsSeen) {
  const core::TemporaryFolder folder;
  TrainingRecord record = RecordAt(1);
  record.success = 0.9;
  record.success_low = 0.8;
  record.success_high = 1.0;
  record.mean_return = 174.2;
  core::WriteFile(folder.path() / "c.svg", TrainingCurves("one", {record}));
  EXPECT_EQ(PointsOf(folder.path() / "c.svg"), "4 2 2 12 12 12\n");
  const std::string svg = core::ReadFile(folder.path() / "c.svg");
  const size_t first = svg.find(">173<");
  EXPECT_NE(first, std::string::npos);  // numbers beside it that differ
  EXPECT_EQ(svg.find(">173<", first + 1), std::string::npos);
}

Policy SmallPolicy() {
  std::srand(3);
  std::vector<Mlp::Layer> layers = {
      {Eigen::MatrixXf::Random(6, 20), Eigen::RowVectorXf::Random(20)},
      {Eigen::MatrixXf::Random(20, 2), Eigen::RowVectorXf::Random(2)}};
  const ObservationScale scale(Eigen::RowVectorXf::Random(6), 30.0f * Eigen::RowVectorXf::Ones(6));
  return Policy(scale, Mlp(layers, Activation::kTanh), Eigen::RowVectorXf{{0.2f, 0.3f}},
                {{"task", "open_door"}, {"hash", "a=b"}});
}

TEST(PolicyFile, ActsAsWrittenAndKeepsItsFacts) {
  const core::TemporaryFolder folder;
  const std::filesystem::path path = folder.path() / "policy.pt";
  const Policy policy = SmallPolicy();
  const Rows observations = 0.1f * Rows::Random(50, 6);
  Rows expected, found;
  policy.Act(observations, &expected);
  WritePolicy(policy, path);
  const Policy whole = ReadPolicy(path);
  whole.Act(observations, &found);
  EXPECT_EQ((found - expected).cwiseAbs().maxCoeff(), 0.0f);
  EXPECT_EQ(whole.metadata(), policy.metadata());
  EXPECT_EQ(whole.std(), policy.std());
  const auto size = std::filesystem::file_size(path);
  WritePolicy(policy, path, Precision::kHalf);
  EXPECT_LT(std::filesystem::file_size(path), size);
  ReadPolicy(path).Act(observations, &found);
  EXPECT_LT((found - expected).cwiseAbs().maxCoeff(), 5e-3f);
  EXPECT_GT((found - expected).cwiseAbs().maxCoeff(), 0.0f);
  // Clamped, as in environments.
  EXPECT_EQ(expected.maxCoeff(), 1.0f);
}

TEST(PolicyFile, WhatIsNoPolicyIsRefusedInOneLine) {
  const core::TemporaryFolder folder;
  const std::filesystem::path path = folder.path() / "policy.pt";
  WritePolicy(SmallPolicy(), path);
  const std::string bytes = core::ReadFile(path);
  for (std::size_t length = 0; length < bytes.size(); length += 97) {
    core::WriteFile(path, bytes.substr(0, length));
    ASSERT_THROW(ReadPolicy(path), core::Error) << length;
  }
  for (std::size_t missing = 1; missing < 30; ++missing) {
    core::WriteFile(path, bytes.substr(0, bytes.size() - missing));
    ASSERT_THROW(ReadPolicy(path), core::Error) << missing;
  }
  core::WriteFile(path, bytes);
  std::string other = bytes;
  const std::string kind = "simwright policy 1";
  const std::size_t at = other.find(kind);
  ASSERT_NE(at, std::string::npos);
  other[at + kind.size() - 1] = '9';
  core::WriteFile(path, other);
  try {
    ReadPolicy(path);
    FAIL();
  } catch (const core::Error& error) {
    EXPECT_NE(std::string(error.what()).find("simwright policy 9"), std::string::npos);
  }
  EXPECT_THROW(ReadPolicy(folder.path() / "none.pt"), core::Error);
}

}  // namespace
}  // namespace simwright::rl
