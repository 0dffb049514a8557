#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "core/hdf5_array.h"

namespace simwright::robot {

// The observations of N steps, by key; the first index of each array is the step. A key is in one
// of the two maps only.
struct StepObservations {
  std::map<std::string, core::Hdf5Array<float>> numbers;        // (N x ...)
  std::map<std::string, core::Hdf5Array<std::uint8_t>> images;  // (N x height x width x channels)
};

// One episode of N steps.
struct Demonstration {
  core::Hdf5Array<double> actions;  // (N x A), in [-1, 1]
  core::Hdf5Array<double> states;   // (N x D): states that restore the simulation
  std::vector<double> rewards;      // (N)
  std::vector<std::uint8_t> dones;  // (N) 1 where the task succeeded or the episode ended
  StepObservations observations;    // before each action
  StepObservations next_observations;

  std::size_t size() const { return rewards.size(); }
};

struct DemonstrationSet {
  std::string env_name;           // the environment's name, as a learner would create it
  int env_type = 2;               // robomimic's environment type; 2 is a gym environment
  std::string env_version;        // the version of the generating program; may be empty
  std::string env_kwargs = "{}";  // JSON object
  std::vector<Demonstration> demonstrations;
  std::map<std::string, std::vector<std::size_t>> filters;  // e.g. "train": demonstration indices
  std::vector<std::string> metadata;                        // one per demonstration, or empty
};

// Writes robomimic's HDF5 file: a group /data with attributes `total` and `env_args`, groups
// demo_<i> with the attribute `num_samples`, and compressed datasets actions, states, rewards,
// dones, obs/<key>, next_obs/<key>; /mask/<filter> with the names of its demonstrations;
// /simwright/notes, which robomimic ignores (its tools print env_args in full).
// Throws core::Error, naming the demonstration and the dataset, if: there is no demonstration, or
// one without steps; an array has another length, or its values do not match its shape; a number is
// not finite; an action is outside [-1, 1]; a key contains '/'; a filter names a missing
// demonstration; the kwargs are not a JSON object; the number of metadata texts differs from that
// of the demonstrations; the file cannot be written.
void WriteDemonstrations(const std::filesystem::path& path, const DemonstrationSet& set);

// Reads files of WriteDemonstrations and robomimic's own files with states, rewards and dones. The
// demonstrations are sorted by number; the filters index this order. Throws core::Error as above,
// or if the file is not a demonstration file.
DemonstrationSet ReadDemonstrations(const std::filesystem::path& path);

}  // namespace simwright::robot
