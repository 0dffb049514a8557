#include "robot/demonstration_file.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>
#include <numeric>
#include <sstream>

#include "core/error.h"
#include "core/files.h"
#include "core/hdf5.h"
#include "core/random.h"

namespace simwright::robot {
namespace {
namespace fs = std::filesystem;

constexpr const char* kDemonstrationFilePython = "/usr/bin/python3";

template <typename T>
core::Hdf5Array<T> Random(std::vector<std::size_t> shape, double low, double high, core::Rng& rng) {
  core::Hdf5Array<T> array{std::move(shape), {}};
  const std::size_t count =
      std::accumulate(array.shape.begin(), array.shape.end(), std::size_t{1}, std::multiplies<>());
  for (std::size_t i = 0; i < count; ++i) {
    array.values.push_back(static_cast<T>(core::Uniform(rng, low, high)));
  }
  return array;
}

// Returns twelve demonstrations, so that the order of their names differs from that of their
// numbers.
DemonstrationSet DemonstrationFileSample() {
  core::Rng rng(21);
  DemonstrationSet set;
  set.env_name = "microwave";
  set.env_kwargs = "{\"horizon\": 120}";
  for (std::size_t i = 0; i < 12; ++i) {
    const std::size_t steps = 5 + i;
    Demonstration demonstration;
    demonstration.actions = Random<double>({steps, 7}, -1.0, 1.0, rng);
    demonstration.states = Random<double>({steps, 20}, -5.0, 5.0, rng);
    demonstration.rewards = Random<double>({steps}, 0.0, 1.0, rng).values;
    demonstration.dones.assign(steps, 0);
    demonstration.dones.back() = 1;
    for (StepObservations* seen : {&demonstration.observations, &demonstration.next_observations}) {
      seen->numbers["pose"] = Random<float>({steps, 3}, -1.0, 1.0, rng);
      seen->images["eye"] = Random<std::uint8_t>({steps, 4, 6, 3}, 0.0, 255.9, rng);
    }
    set.demonstrations.push_back(demonstration);
  }
  set.filters = {{"train", {0, 2, 11}}, {"valid", {1}}};
  return set;
}

template <typename T>
void DemonstrationFileExpectSame(const core::Hdf5Array<T>& a, const core::Hdf5Array<T>& b) {
  EXPECT_EQ(a.shape, b.shape);
  EXPECT_EQ(a.values, b.values);
}

TEST(DemonstrationFile, ReadsBackEveryBit) {
  const core::TemporaryFolder folder;
  const DemonstrationSet set = DemonstrationFileSample();
  WriteDemonstrations(folder.path() / "a.hdf5", set);
  const DemonstrationSet read = ReadDemonstrations(folder.path() / "a.hdf5");
  EXPECT_EQ(read.env_name, "microwave");
  EXPECT_EQ(read.env_type, 2);
  EXPECT_EQ(read.env_kwargs, "{\"horizon\":120}");
  EXPECT_EQ(read.filters, set.filters);
  ASSERT_EQ(read.demonstrations.size(), set.demonstrations.size());
  for (std::size_t i = 0; i < set.demonstrations.size(); ++i) {
    const Demonstration& a = read.demonstrations[i];
    const Demonstration& b = set.demonstrations[i];
    DemonstrationFileExpectSame(a.actions, b.actions);
    DemonstrationFileExpectSame(a.states, b.states);
    EXPECT_EQ(a.rewards, b.rewards);
    EXPECT_EQ(a.dones, b.dones);
    DemonstrationFileExpectSame(a.observations.numbers.at("pose"),
                                b.observations.numbers.at("pose"));
    DemonstrationFileExpectSame(a.observations.images.at("eye"), b.observations.images.at("eye"));
    DemonstrationFileExpectSame(a.next_observations.numbers.at("pose"),
                                b.next_observations.numbers.at("pose"));
    DemonstrationFileExpectSame(a.next_observations.images.at("eye"),
                                b.next_observations.images.at("eye"));
  }
}

// h5py reads the same numbers, bit for bit, where robomimic expects them; files of h5py are
// readable here.
TEST(DemonstrationFile, PythonReadsAndWritesTheSame) {
  const core::TemporaryFolder folder;
  const DemonstrationSet set = DemonstrationFileSample();
  const fs::path ours = folder.path() / "ours.hdf5", theirs = folder.path() / "theirs.hdf5";
  const fs::path printed = folder.path() / "printed.txt";
  WriteDemonstrations(ours, set);
  const std::string command = std::string(kDemonstrationFilePython) + " '" + SIMWRIGHT_TEST_DATA +
                              "/read_demonstrations.py' '" + ours.string() + "' '" +
                              theirs.string() + "' > '" + printed.string() + "'";
  ASSERT_EQ(std::system(command.c_str()), 0) << "python3-h5py is missing? " << command;

  std::ifstream in(printed);
  std::string line;
  std::getline(in, line);
  EXPECT_EQ(line, "env microwave 2 120");
  std::getline(in, line);
  EXPECT_EQ(line, "total 126 12");
  for (std::size_t i = 0; i < set.demonstrations.size(); ++i) {
    const Demonstration& demonstration = set.demonstrations[i];
    const std::size_t steps = demonstration.size();
    std::getline(in, line);
    std::istringstream words(line);
    const auto next = [&] {
      std::string word;
      words >> word;
      return word;
    };
    const auto expect_number = [&](double expected) {
      EXPECT_EQ(std::strtod(next().c_str(), nullptr), expected);
    };
    EXPECT_EQ(next(), "demo_" + std::to_string(i));
    expect_number(static_cast<double>(steps));
    for (const double action : demonstration.actions.values) expect_number(action);
    const auto& states = demonstration.states.values;
    for (std::size_t k = states.size() - 20; k < states.size(); ++k) expect_number(states[k]);
    for (const double reward : demonstration.rewards) expect_number(reward);
    for (const std::uint8_t done : demonstration.dones) expect_number(done);
    expect_number(static_cast<double>(steps));
    expect_number(3);
    expect_number(demonstration.next_observations.numbers.at("pose").values.back());
    for (const std::size_t size : {steps, std::size_t{4}, std::size_t{6}, std::size_t{3}}) {
      expect_number(static_cast<double>(size));
    }
    const auto& eye = demonstration.observations.images.at("eye").values;
    expect_number(std::accumulate(eye.begin(), eye.begin() + 72, 0.0));
    EXPECT_EQ(next(), "");
  }
  std::getline(in, line);
  EXPECT_EQ(line, "train demo_0 demo_2 demo_11");
  std::getline(in, line);
  EXPECT_EQ(line, "valid demo_1");

  const DemonstrationSet read = ReadDemonstrations(theirs);
  EXPECT_EQ(read.env_name, "Lift");
  EXPECT_EQ(read.env_type, 1);
  ASSERT_EQ(read.demonstrations.size(), 3u);
  EXPECT_EQ(read.demonstrations[2].actions.values[0], 10.0 / 16.0);
  EXPECT_EQ(read.demonstrations[1].rewards, (std::vector<double>{0, 1, 2, 3}));
  EXPECT_EQ(read.demonstrations[1].dones, (std::vector<std::uint8_t>{0, 0, 0, 1}));
  EXPECT_EQ(read.filters.at("valid"), (std::vector<std::size_t>{2, 1}));
  EXPECT_EQ(read.filters.at("text"), (std::vector<std::size_t>{0}));
}

TEST(DemonstrationFile, RefusesWhatIsNotWhole) {
  const core::TemporaryFolder folder;
  const fs::path path = folder.path() / "a.hdf5";
  const DemonstrationSet whole = DemonstrationFileSample();
  const auto refuses = [&](const DemonstrationSet& set, const std::string& word) {
    try {
      WriteDemonstrations(path, set);
      ADD_FAILURE() << "written, but for " << word;
    } catch (const core::Error& error) {
      EXPECT_NE(std::string(error.what()).find(word), std::string::npos) << error.what();
    }
    EXPECT_TRUE(fs::is_empty(folder.path()));
  };
  DemonstrationSet set = whole;
  set.demonstrations.clear();
  refuses(set, "no demonstration");
  set = whole;
  set.demonstrations[3].actions.values[4] = 1.01;
  refuses(set, "demo_3/actions");
  set = whole;
  set.demonstrations[3].states.values[4] = std::nan("");
  refuses(set, "demo_3/states");
  set = whole;
  set.demonstrations[3].rewards.pop_back();
  refuses(set, "demo_3");
  set = whole;
  set.demonstrations[3].observations.numbers["pose"].shape[1] = 4;
  refuses(set, "demo_3/obs/pose");
  set = whole;
  set.demonstrations[3].next_observations.numbers["a/b"] = {};
  refuses(set, "'a/b'");
  set = whole;
  set.demonstrations[3] = {};
  refuses(set, "no step");
  set = whole;
  set.filters["test"] = {12};
  refuses(set, "demo_12");
  set = whole;
  set.env_kwargs = "[]";
  refuses(set, "env_kwargs");
}

TEST(DemonstrationFile, RefusesAFileThatIsAnother) {
  const core::TemporaryFolder folder;
  const fs::path path = folder.path() / "a.hdf5";
  {
    core::Hdf5Writer writer(path);
    writer.root().Create("data").SetAttribute("total", std::int64_t{0});
    writer.Commit();
  }
  EXPECT_THROW(ReadDemonstrations(path), core::Error);
  WriteDemonstrations(path, DemonstrationFileSample());
  const std::string bytes = core::ReadFile(path);
  core::WriteFile(path, bytes.substr(0, bytes.size() - 1000));
  EXPECT_THROW(ReadDemonstrations(path), core::Error);
  EXPECT_THROW(ReadDemonstrations(folder.path() / "missing.hdf5"), core::Error);
}

}  // namespace
}  // namespace simwright::robot
