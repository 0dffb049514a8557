#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "core/hdf5.h"

namespace simwright::robot {

// What is seen at each of N steps, by key; the first index of each array is the step. No key is in
// both.
struct StepObservations {
  std::map<std::string, core::Hdf5Array<float>> numbers;        // (N x ...)
  std::map<std::string, core::Hdf5Array<std::uint8_t>> images;  // (N x height x width x channels)
};

// One episode of N steps.
struct Demonstration {
  core::Hdf5Array<double> actions;  // (N x A), in [-1, 1]
  core::Hdf5Array<double> states;   // (N x D): what the simulation is restored from
  std::vector<double> rewards;      // (N)
  std::vector<std::uint8_t> dones;  // (N) 1 where the task was done, or the episode over
  StepObservations observations;    // before each action
  StepObservations next_observations;

  std::size_t size() const { return rewards.size(); }
};

struct DemonstrationSet {
  std::string env_name;           // of the environment, as a learner would make it
  int env_type = 2;               // robomimic's number of its kind; 2 is a gym environment
  std::string env_version;        // of what made it; may be empty
  std::string env_kwargs = "{}";  // JSON object
  std::vector<Demonstration> demonstrations;
  std::map<std::string, std::vector<std::size_t>> filters;  // e.g. "train": which demonstrations
  std::vector<std::string> notes;  // one of each demonstration, or none at all
};

// robomimic's HDF5 file: group /data with attributes `total` and `env_args`, groups demo_<i> with
// attribute `num_samples`, and datasets actions, states, rewards, dones, obs/<key>, next_obs/<key>,
// packed; /mask/<filter> with the names of its demonstrations; /simwright/notes, which robomimic
// passes over: its tools print env_args whole.
// Throws core::Error, naming demonstration and dataset: no demonstration, one without steps,
// arrays of another length or whose values are not the product of their shape, numbers that are
// not finite, an action outside [-1, 1], a key with '/', a filter of what is not there, kwargs
// that are no JSON object, notes of another number, a file that cannot be written.
void WriteDemonstrations(const std::filesystem::path& path, const DemonstrationSet& set);

// Reads what WriteDemonstrations wrote, and robomimic's own files that have states, rewards and
// dones; in the order of their numbers, so that filters count the places in that order. Throws
// core::Error as above, or where the file is no such file.
DemonstrationSet ReadDemonstrations(const std::filesystem::path& path);

}  // namespace simwright::robot
