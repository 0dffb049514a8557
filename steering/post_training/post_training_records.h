#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "steering/post_training/post_training.h"

namespace simwright::steering {

// Format and read the records as CSV. Reading leaves out what is later than `round`, and lines that
// are not whole.
std::string RoundsText(const std::vector<RoundRecord>& rounds);
std::vector<RoundRecord> ReadRounds(const std::filesystem::path& path, int round);
std::string CheckpointsText(const std::vector<Checkpoint>& checkpoints);
// The weights are those in the folder of the file.
std::vector<Checkpoint> ReadCheckpoints(const std::filesystem::path& path, int round);

// Returns the file name of a checkpoint's weights: "checkpoint_000040.pt".
std::string CheckpointName(int round);

}  // namespace simwright::steering
