#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace simwright::scene {

// A line of a training log: mean losses over the updates since the previous line.
struct LossRecord {
  int step = 0;
  double total = 0.0, translation = 0.0, rotation = 0.0, classes = 0.0, cross_entropy = 0.0;
  double held_out = 0.0;  // total on held-out scenes, at fixed times and noise
};

// Returns the losses as a CSV table with a header.
std::string LossesText(const std::vector<LossRecord>& losses);

// Reads the losses of such a file up to `step`; returns none if there is no file. Damaged lines are
// skipped.
std::vector<LossRecord> ReadLosses(const std::filesystem::path& path, int step);

// Returns an SVG plot: the total and the held-out loss, and the errors in the noise of translations
// and rotations, where 1 is the error of a blind guess.
std::string LossCurves(const std::string& title, const std::vector<LossRecord>& losses);

}  // namespace simwright::scene
