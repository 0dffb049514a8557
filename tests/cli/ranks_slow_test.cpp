// Ranks of mpirun and tasks of a Slurm array share the work of one command: results as of one
// process, nothing made twice, one report, and a killed rank loses little.
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "core/content_hash.h"
#include "core/files.h"
#include "core/json.h"
#include "tests/workflows/program.h"
#include "tests/workflows/running_program.h"

namespace simwright {
namespace {
namespace fs = std::filesystem;

// The tests may run as root, and on fewer processors than ranks.
std::string Mpirun(int ranks) {
  return "OMPI_MCA_btl_vader_single_copy_mechanism=none "
         "mpirun --allow-run-as-root --oversubscribe --bind-to none -n " +
         std::to_string(ranks) + " ";
}

Outcome RunRanks(int ranks, const std::string& arguments) {
  return RunShell(Mpirun(ranks) + SIMWRIGHT_PROGRAM + " " + arguments + " 2>&1");
}

bool HasMpirun() {
  return RunShell("command -v mpirun >/dev/null").code == 0;
}

// Returns the lines of `text` that contain `words`.
std::vector<std::string> LinesWith(const std::string& text, const std::string& words) {
  std::istringstream in(text);
  std::vector<std::string> lines;
  for (std::string line; std::getline(in, line);) {
    if (line.find(words) != std::string::npos) lines.push_back(line);
  }
  return lines;
}

// Returns what follows `words` in each line that contains them, and how often.
std::map<std::string, int> NamesAfter(const std::string& text, const std::string& words) {
  std::map<std::string, int> names;
  for (const std::string& line : LinesWith(text, words)) {
    std::istringstream rest(line.substr(line.find(words) + words.size()));
    std::string name;
    rest >> name;
    ++names[name];
  }
  return names;
}

std::string Contents(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

// Returns the process of a rank whose command line contains `argument`; 0 if there is none.
pid_t ProcessOfRank(int rank, const std::string& argument) {
  const std::string variable = "OMPI_COMM_WORLD_RANK=" + std::to_string(rank);
  for (const auto& entry : fs::directory_iterator("/proc")) {
    const std::string number = entry.path().filename();
    if (number.find_first_not_of("0123456789") != std::string::npos) continue;
    const std::string environment = Contents(entry.path() / "environ");
    if (environment.find(variable + '\0') == std::string::npos) continue;
    if (Contents(entry.path() / "cmdline").find(argument) == std::string::npos) continue;
    return std::stoi(number);
  }
  return 0;
}

// Runs the command on two ranks, kills rank 1 once `begun` holds, and returns what became of it.
Outcome KillARank(const std::string& arguments, const std::string& argument, const fs::path& log,
                  const std::function<bool()>& begun) {
  Outcome outcome;
  const pid_t launcher = fork();
  if (launcher == 0) {
    const std::string command = "exec env " + Mpirun(2) + SIMWRIGHT_PROGRAM + " " + arguments +
                                " >" + log.string() + " 2>&1";
    execl("/bin/sh", "sh", "-c", command.c_str(), nullptr);
    _exit(127);
  }
  int status = 0;
  pid_t rank = 0;
  bool ended = false;
  for (int i = 0; i < 12000 && !ended; ++i) {
    if (rank == 0 && begun() && (rank = ProcessOfRank(1, argument)) != 0) kill(rank, SIGKILL);
    std::this_thread::sleep_for(std::chrono::milliseconds(25));
    ended = waitpid(launcher, &status, WNOHANG) != 0;
  }
  EXPECT_NE(rank, 0) << "it ended before it could be killed";
  EXPECT_TRUE(ended) << "the launcher does not end";
  if (!ended) {
    kill(launcher, SIGTERM);
    waitpid(launcher, &status, 0);
  }
  outcome.code = WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status);
  outcome.text = Contents(log);
  return outcome;
}

class Ranks : public testing::Test {
 protected:
  void SetUp() override {
    if (!HasMpirun()) GTEST_SKIP() << "there is no mpirun (apt-get install openmpi-bin)";
  }
  std::string Path(const std::string& name) const { return (folder_.path() / name).string(); }

  core::TemporaryFolder folder_;
};

constexpr int kShards = 10;

// A small dataset, alone or as ranks.
std::string Generate(const std::string& output, const std::string& assets = "") {
  return "scene generate --type living_room_shelf --count 20 --part 2 --log-level info -o " +
         output + (assets.empty() ? "" : " --assets " + assets);
}

// A dataset by one process, to compare with.
class SceneRanks : public Ranks {
 protected:
  // One test runs all checks, because separate processes would each make all assets again.
  void SharesShards(int ranks);
  void SharesShardsOfAnArray();
  void CompletesWhatAKilledRankLeft();

  // Expects that each shard was written once.
  static void ExpectShards(const std::string& text) {
    const auto shards = NamesAfter(text, "wrote shard ");
    EXPECT_EQ(shards.size(), static_cast<size_t>(kShards)) << text;
    for (const auto& [shard, times] : shards) EXPECT_EQ(times, 1) << shard;
  }
  // The assets come from the first dataset, which is faster.
  std::string GenerateLater(const std::string& name) const {
    return Generate(Path(name), Path("made") + "/assets");
  }

  std::string expected_;  // hash of the dataset
};

void SceneRanks::SharesShards(int ranks) {
  const std::string name = "ranks" + std::to_string(ranks);
  const Outcome outcome = RunRanks(ranks, GenerateLater(name));
  ASSERT_EQ(outcome.code, 0) << outcome.text;
  EXPECT_EQ(core::ContentHashOf(Path(name)), expected_) << ranks;
  ExpectShards(outcome.text);
  EXPECT_EQ(LinesWith(outcome.text, "20 scenes of").size(), 1u) << outcome.text;
  EXPECT_EQ(LinesWith(outcome.text, "assets-used").size(), 1u) << outcome.text;
  EXPECT_EQ(LinesWith(outcome.text, "scenes: ").size(), 1u) << outcome.text;
}

// Each of the tasks of an array ends for itself, and the last one reports.
void SceneRanks::SharesShardsOfAnArray() {
  const std::string script =
      std::string("SIMWRIGHT=") + SIMWRIGHT_PROGRAM + " SLURM_ARRAY_TASK_MIN=5 " +
      "SLURM_ARRAY_TASK_COUNT=2 SLURM_ARRAY_TASK_STEP=1 SLURM_CPUS_PER_TASK=1 " +
      "SLURM_ARRAY_TASK_ID=$task " + SIMWRIGHT_SOURCE_DIR +
      "/examples/slurm/scenes.sh living_room_shelf 20 " + Path("array") +
      " --part 2 --log-level info --assets " + Path("made") + "/assets >" + Path("log") +
      "_$task 2>&1";
  RunShell("for task in 5 6; do (" + script + ") & done; wait");
  const std::string logs = Contents(Path("log_5")) + Contents(Path("log_6"));
  ASSERT_TRUE(fs::exists(Path("array"))) << logs;
  EXPECT_EQ(core::ContentHashOf(Path("array")), expected_) << logs;
  ExpectShards(logs);
  EXPECT_GE(LinesWith(logs, "20 scenes of").size(), 1u) << logs;
}

void SceneRanks::CompletesWhatAKilledRankLeft() {
  const auto complete = [&] {
    std::set<std::string> names;
    if (!fs::exists(Path("killed"))) return names;
    for (const auto& entry : fs::directory_iterator(Path("killed"))) {
      const std::string name = entry.path().filename();
      if (name.starts_with("part_") && name.ends_with(".h5")) names.insert(name);
    }
    return names;
  };
  const std::string command = GenerateLater("killed");
  const Outcome killed =
      KillARank(command, Path("killed"), Path("log"), [&] { return complete().size() >= 2; });
  EXPECT_NE(killed.code, 0) << killed.text;
  const auto before = complete();
  ASSERT_GE(before.size(), 2u);
  const Outcome rerun = RunRanks(2, command);
  ASSERT_EQ(rerun.code, 0) << rerun.text;
  EXPECT_EQ(core::ContentHashOf(Path("killed")), expected_);
  // Rank 0, which mpirun asks to end, may have kept a part of its shard; the others are kept.
  const auto shards = NamesAfter(rerun.text, "wrote shard ");
  EXPECT_LE(shards.size(), kShards - before.size() + 1) << rerun.text;
}

TEST_F(SceneRanks, GenerateTheScenesOfOneProcess) {
  const Outcome alone = RunProgram(Generate(Path("made")));
  ASSERT_EQ(alone.code, 0) << alone.text;
  expected_ = core::ContentHashOf(Path("made"));
  SharesShards(2);
  SharesShards(4);
  SharesShardsOfAnArray();
  CompletesWhatAKilledRankLeft();
}

TEST_F(Ranks, PrintAnErrorOfAllOnce) {
  const Outcome outcome = RunRanks(3, "scene generate --type picnic -o " + Path("none"));
  EXPECT_NE(outcome.code, 0);
  EXPECT_EQ(LinesWith(outcome.text, "picnic").size(), 1u) << outcome.text;
  EXPECT_EQ(LinesWith(outcome.text, "rank 1").size(), 0u) << outcome.text;
  EXPECT_NE(RunRanks(2, "scene generate --tpye dimsum").code, 0);
}

constexpr char kFactoryPlan[] = R"({"tasks": 6, "seed": 3, "sources": [
  {"library": ["drawer_unit"], "count": 1},
  {"library": ["mug", "apple", "book", "toy_block"], "count": 7}]})";

TEST_F(Ranks, ShareAFactoryAndOneFinishesWhatAKilledOneLeft) {
  core::WriteFile(Path("plan.json"), kFactoryPlan);
  const auto command = [&](const std::string& output) {
    return "factory " + Path("plan.json") + " --log-level info -o " + Path(output);
  };
  const Outcome whole = RunRanks(2, command("whole"));
  ASSERT_EQ(whole.code, 0) << whole.text;
  const auto made = NamesAfter(whole.text, "recorded ");
  EXPECT_EQ(made.size(), 9u) << whole.text;  // eight assets, one part of the tasks
  for (const auto& [name, times] : made) EXPECT_EQ(times, 1) << name;
  EXPECT_EQ(LinesWith(whole.text, "assets  8 of 8 made").size(), 1u) << whole.text;
  EXPECT_EQ(LinesWith(whole.text, "on 1 threads").size(), 1u) << whole.text;
  EXPECT_TRUE(fs::exists(Path("whole") + "/tasks.json"));

  const auto records = [&] {
    const fs::path done = fs::path(Path("killed")) / "done";
    if (!fs::exists(done)) return std::ptrdiff_t{0};
    return std::count_if(fs::directory_iterator(done), {},
                         [](const auto& entry) { return entry.path().extension() == ".json"; });
  };
  const Outcome killed =
      KillARank(command("killed"), Path("killed"), Path("log"), [&] { return records() >= 3; });
  EXPECT_NE(killed.code, 0) << killed.text;
  const auto before = records();
  ASSERT_GE(before, 3);
  const Outcome rerun = RunRanks(2, command("killed"));  // joins without --resume
  ASSERT_EQ(rerun.code, 0) << rerun.text;
  EXPECT_EQ(static_cast<std::ptrdiff_t>(NamesAfter(rerun.text, "recorded ").size()), 9 - before);
  EXPECT_TRUE(core::ReadFile(Path("killed") + "/tasks.json").size() > 100);
  // Assets are those of the other run.
  for (const auto& entry : fs::directory_iterator(fs::path(Path("whole")) / "assets")) {
    const fs::path same = fs::path(Path("killed")) / "assets" / entry.path().filename();
    EXPECT_EQ(core::ContentHashOf(entry.path()), core::ContentHashOf(same)) << same;
  }
}

constexpr const char* kRanksTin = R"(<robot name="tin"><link name="base">
  <contact><lateral_friction value="0.6"/></contact>
  <collision><origin xyz="0 0 0.04"/><geometry><box size="0.05 0.05 0.08"/></geometry></collision>
  <inertial><origin xyz="0 0 0.04"/><mass value="0.2"/>
    <inertia ixx="1.5e-4" iyy="1.5e-4" izz="8e-5" ixy="0" ixz="0" iyz="0"/></inertial>
</link></robot>
)";

TEST_F(Ranks, TrainTogetherAndResume) {
  fs::create_directories(Path("tin"));
  core::WriteFile(Path("tin/tin.urdf"), kRanksTin);
  ASSERT_EQ(RunProgram("tasks " + Path("tin") + " -o " + Path("tasks.json")).code, 0);
  const auto command = [&](const std::string& run, int samples) {
    return "train " + Path("tasks.json") +
           " --task pick_up_tin --envs 8 --episodes 6 --imitate 0 --steps " +
           std::to_string(samples) + " -o " + Path(run);
  };
  const Outcome trained = RunRanks(2, command("run", 2048));
  if (trained.text.find("built without MPI") != std::string::npos) {
    EXPECT_EQ(LinesWith(trained.text, "error: ").size(), 1u) << trained.text;
    GTEST_SKIP() << "the program was built without MPI";
  }
  ASSERT_EQ(trained.code, 0) << trained.text;
  EXPECT_EQ(LinesWith(trained.text, "success: ").size(), 1u) << trained.text;
  const core::Json report = core::ParseJson(core::ReadFile(Path("run/report.json")), "report.json");
  EXPECT_EQ(report["subtasks"][0]["samples"], 2048);  // of both ranks
  EXPECT_EQ(report["subtasks"][0]["own_starts"]["episodes"], 6);
  EXPECT_EQ(RunProgram("rollout " + Path("run") + " --episodes 2 --quiet").code, 0);
  const Outcome more = RunRanks(9, command("more", 2048));  // than environments
  EXPECT_NE(more.code, 0);
  EXPECT_NE(more.text.find("more ranks than environments"), std::string::npos) << more.text;

  const std::string table = Path("killed/1_pick_up_tin/training.csv");
  const Outcome killed = KillARank(command("killed", 200000), Path("killed"), Path("log"), [&] {
    const std::string text = Contents(table);
    return std::count(text.begin(), text.end(), '\n') >= 27;  // a checkpoint after 25
  });
  EXPECT_NE(killed.code, 0) << killed.text;
  ASSERT_TRUE(fs::exists(Path("killed/1_pick_up_tin/checkpoint.pt")));
  // One iteration is 512 decisions: 25 of the first run, and three more.
  const Outcome resumed = RunRanks(2, command("killed", 28 * 512) + " --resume");
  ASSERT_EQ(resumed.code, 0) << resumed.text;
  const std::string rows = Contents(table);
  EXPECT_EQ(std::count(rows.begin(), rows.end(), '\n'), 29) << rows;
}

}  // namespace
}  // namespace simwright
