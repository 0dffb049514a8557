// Reward programs against Python: every program of corpus/ runs here and under python3-torch on the
// same random states.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>
#include <random>
#include <sstream>

#include "core/files.h"
#include "reward/reward_program.h"
#include "tests/reward/sample_scene.h"
#include "tests/sanitized.h"

namespace simwright::reward {
namespace {
namespace fs = std::filesystem;

constexpr int kEnvironments = 1037;  // several chunks, and not a multiple of any vector width
constexpr const char* kPython = "/usr/bin/python3";

struct CorpusRun {
  fs::path file;
  std::string source;
  RewardProgram program;
  std::vector<std::vector<float>> inputs;
};

bool IsQuaternion(const RewardSlot& slot) {
  return slot.width == 4 && (slot.part.find("rot") != std::string::npos ||
                             slot.part.find("quat") != std::string::npos ||
                             RewardInputName(slot.input).find("orient") != std::string::npos);
}

// Returns numbers in [-1, 1), flags, unit quaternions, or boxes with ordered corners.
std::vector<float> RandomInput(const RewardSlot& slot, std::mt19937* generator) {
  std::uniform_real_distribution<float> uniform(-1.0f, 1.0f);
  if (slot.uniform) return {static_cast<float>(2 + (*generator)() % 4)};
  std::vector<float> values(static_cast<std::size_t>(kEnvironments) * slot.width);
  for (float& value : values) value = uniform(*generator);
  const bool flag = slot.flags || slot.input == RewardInput::kGripperContact ||
                    slot.input == RewardInput::kGrasped;
  for (int i = 0; i < kEnvironments; ++i) {
    float* row = &values[static_cast<std::size_t>(i) * slot.width];
    for (int k = 0; flag && k < slot.width; ++k) row[k] = row[k] > 0.0f ? 1.0f : 0.0f;
    if (slot.width == 6) {
      for (int k = 0; k < 3; ++k) row[3 + k] = row[k] + std::fabs(row[3 + k]) * 1.5f;
    }
    if (!IsQuaternion(slot)) continue;
    const float length =
        std::sqrt(row[0] * row[0] + row[1] * row[1] + row[2] * row[2] + row[3] * row[3]);
    for (int k = 0; k < 4; ++k) row[k] /= length;
  }
  return values;
}

// "[N, 4, 3]" gives "4,3".
std::string TrailingSizes(const std::string& shape) {
  std::string sizes;
  for (const char c : shape) {
    if (std::isdigit(static_cast<unsigned char>(c)) || c == ',') sizes += c;
  }
  if (!sizes.empty() && sizes[0] == ',') sizes.erase(0, 1);
  return sizes.empty() ? "-" : sizes;
}

void WriteManifest(const std::vector<CorpusRun>& runs, const fs::path& path) {
  std::ofstream out(path);
  out.precision(9);
  const auto word = [](const std::string& text) { return text.empty() ? std::string("-") : text; };
  for (const CorpusRun& run : runs) {
    const bool each = run.source.starts_with("# each:");
    out << "program " << run.file.string() << ' ' << run.program.entry() << ' '
        << (each ? "each" : "all") << ' ' << kEnvironments << '\n';
    for (std::size_t i = 0; i < run.inputs.size(); ++i) {
      const RewardSlot& slot = run.program.slots()[i];
      out << "slot " << RewardInputName(slot.input) << ' ' << word(slot.asset) << ' '
          << word(slot.part) << ' '
          << (slot.uniform ? "shared"
              : slot.flags ? "flags"
                           : "numbers")
          << ' ' << TrailingSizes(slot.shape);
      for (const float value : run.inputs[i]) out << ' ' << value;
      out << '\n';
    }
  }
}

using Results = std::map<std::string, std::vector<double>>;

std::map<std::string, Results> ReadResults(const fs::path& path) {
  std::map<std::string, Results> all;
  std::ifstream in(path);
  std::string line, program;
  while (std::getline(in, line)) {
    std::istringstream words(line);
    std::string name;
    words >> name;
    if (name == "program") {
      words >> program;
      continue;
    }
    for (std::string value; words >> value;) {
      all[program][name].push_back(std::strtod(value.c_str(), nullptr));
    }
  }
  return all;
}

// Returns the largest difference, relative where the reference exceeds 1.
double LargestError(const std::vector<double>& truth, const std::vector<float>& ours) {
  double worst = truth.size() == ours.size() ? 0.0 : INFINITY;
  for (std::size_t i = 0; i < std::min(truth.size(), ours.size()); ++i) {
    if (std::isnan(truth[i]) && std::isnan(ours[i])) continue;
    if (truth[i] == ours[i]) continue;  // infinities
    const double error = std::fabs(truth[i] - ours[i]) / std::max(1.0, std::fabs(truth[i]));
    worst = std::isnan(error) ? INFINITY : std::max(worst, error);
  }
  return worst;
}

Results RunHere(const CorpusRun& run, bool columns) {
  RewardWorkspace workspace(run.program, kEnvironments);
  std::vector<RewardBinding> bindings;
  std::vector<std::vector<float>> turned;
  for (std::size_t i = 0; i < run.inputs.size(); ++i) {
    const int width = run.program.slots()[i].width;
    turned.emplace_back(run.inputs[i].size());
    for (std::size_t e = 0; e < run.inputs[i].size() / width; ++e) {
      for (int k = 0; k < width; ++k) {
        turned[i][k * (run.inputs[i].size() / width) + e] = run.inputs[i][e * width + k];
      }
    }
  }
  for (std::size_t i = 0; i < run.inputs.size(); ++i) {
    const bool turn = columns && !run.program.slots()[i].uniform;
    bindings.push_back(turn ? RewardBinding{turned[i].data(), 1, kEnvironments}
                            : RewardBinding{run.inputs[i].data()});
  }
  std::vector<float> reward(kEnvironments);
  std::vector<std::uint8_t> success(kEnvironments);
  std::vector<std::vector<float>> components;
  std::vector<float*> pointers;
  for (const RewardComponent& component : run.program.components()) {
    components.emplace_back(static_cast<std::size_t>(kEnvironments) * component.width);
  }
  for (auto& component : components) pointers.push_back(component.data());
  run.program.Run(bindings, kEnvironments, &workspace, reward.data(), success.data(), pointers);
  Results results;
  results["reward"].assign(reward.begin(), reward.end());
  if (run.program.has_success()) results["success"].assign(success.begin(), success.end());
  for (std::size_t i = 0; i < components.size(); ++i) {
    std::string name = "component:" + run.program.components()[i].name;
    std::replace(name.begin(), name.end(), ' ', '~');  // results.txt is separated by blanks
    results[name].assign(components[i].begin(), components[i].end());
  }
  return results;
}

std::vector<CorpusRun> Programs() {
  std::vector<fs::path> files;
  for (const auto& entry : fs::directory_iterator(fs::path(SIMWRIGHT_TEST_DATA) / "corpus")) {
    if (entry.path().extension() == ".py") files.push_back(entry.path());
  }
  std::sort(files.begin(), files.end());
  const RewardScene scene = SampleScene();
  std::vector<CorpusRun> runs;
  for (const fs::path& file : files) {
    std::mt19937 generator(7);  // each program's numbers are independent of the others
    const std::string source = core::ReadFile(file);
    const CompileOutcome outcome = CompileReward(source, &scene);
    for (const core::Finding& finding : outcome.findings) {
      EXPECT_NE(finding.severity, core::Severity::kError)
          << file.filename() << ":" << RenderFinding(finding, source);
    }
    if (!outcome.program.has_value()) continue;
    runs.push_back({file, source, *outcome.program, {}});
    for (const RewardSlot& slot : outcome.program->slots()) {
      runs.back().inputs.push_back(RandomInput(slot, &generator));
    }
  }
  EXPECT_EQ(runs.size(), files.size());
  EXPECT_GE(runs.size(), 34u);
  return runs;
}

TEST(RewardCorpus, GivesTheNumbersOfPython) {
  SKIP_UNDER_SANITIZERS();
  const std::vector<CorpusRun> runs = Programs();
  const core::TemporaryFolder temporary;
  const fs::path& folder = temporary.path();
  WriteManifest(runs, folder / "manifest.txt");
  const std::string command = std::string(kPython) + " '" + SIMWRIGHT_TEST_DATA +
                              "/run_corpus.py' '" + folder.string() + "'";
  ASSERT_EQ(std::system(command.c_str()), 0) << "python3-torch is missing? " << command;
  std::map<std::string, Results> truths = ReadResults(folder / "results.txt");
  for (const CorpusRun& run : runs) {
    const Results& truth = truths[run.file.string()];
    for (const bool columns : {false, true}) {
      const Results ours = RunHere(run, columns);
      EXPECT_EQ(truth.size(), ours.size()) << run.file.filename();
      for (const auto& [name, values] : truth) {
        ASSERT_TRUE(ours.contains(name)) << run.file.filename() << " lacks " << name;
        const std::vector<double>& other = ours.at(name);
        EXPECT_LE(LargestError(values, std::vector<float>(other.begin(), other.end())), 1e-5)
            << run.file.filename() << ": " << name;
      }
    }
  }
}

}  // namespace
}  // namespace simwright::reward
