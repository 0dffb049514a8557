#include "steering/post_training/post_training_records.h"

#include <cstdio>
#include <sstream>

#include "core/files.h"

namespace simwright::steering {
namespace {

constexpr char kRoundsHeader[] =
    "round,reward,least,largest,objects,most_objects,ratio,data_loss\n";
constexpr char kCheckpointsHeader[] = "round,reward,accuracy\n";

// Calls read(line) for each line after the header of a file, if it exists.
template <typename Read>
void ForEachRecord(const std::filesystem::path& path, const Read& read) {
  if (!std::filesystem::exists(path)) return;
  std::istringstream text(core::ReadFile(path));
  std::string line;
  std::getline(text, line);
  while (std::getline(text, line)) read(line);
}

}  // namespace

std::string RoundsText(const std::vector<RoundRecord>& rounds) {
  std::string text = kRoundsHeader;
  for (const RoundRecord& one : rounds) {
    char line[224];
    std::snprintf(line, sizeof line, "%d,%.6g,%.6g,%.6g,%.6g,%d,%.6g,%.6g\n", one.round, one.reward,
                  one.least, one.largest, one.objects, one.most_objects, one.ratio, one.data_loss);
    text += line;
  }
  return text;
}

std::vector<RoundRecord> ReadRounds(const std::filesystem::path& path, int round) {
  std::vector<RoundRecord> rounds;
  ForEachRecord(path, [&](const std::string& line) {
    RoundRecord one;
    const int read = std::sscanf(line.c_str(), "%d,%lf,%lf,%lf,%lf,%d,%lf,%lf", &one.round,
                                 &one.reward, &one.least, &one.largest, &one.objects,
                                 &one.most_objects, &one.ratio, &one.data_loss);
    if (read == 8 && one.round <= round) rounds.push_back(one);
  });
  return rounds;
}

std::string CheckpointsText(const std::vector<Checkpoint>& checkpoints) {
  std::string text = kCheckpointsHeader;
  for (const Checkpoint& one : checkpoints) {
    char line[96];
    std::snprintf(line, sizeof line, "%d,%.6g,%.6g\n", one.round, one.score.reward,
                  one.score.accuracy);
    text += line;
  }
  return text;
}

std::vector<Checkpoint> ReadCheckpoints(const std::filesystem::path& path, int round) {
  std::vector<Checkpoint> checkpoints;
  ForEachRecord(path, [&](const std::string& line) {
    Checkpoint one;
    const int read =
        std::sscanf(line.c_str(), "%d,%lf,%lf", &one.round, &one.score.reward, &one.score.accuracy);
    if (read != 3 || one.round > round) return;
    one.weights = path.parent_path() / CheckpointName(one.round);
    checkpoints.push_back(one);
  });
  return checkpoints;
}

std::string CheckpointName(int round) {
  char name[40];
  std::snprintf(name, sizeof name, "checkpoint_%06d.pt", round);
  return name;
}

}  // namespace simwright::steering
