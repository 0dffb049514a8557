#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace simwright::scene {

// A line of a training's losses: means over the updates since the one before.
struct LossRecord {
  int step = 0;
  double total = 0.0, translation = 0.0, rotation = 0.0, classes = 0.0, cross_entropy = 0.0;
  double held_out = 0.0;  // total, on held-out scenes at times and noise that are always the same
};

// As a table (CSV) with a header.
std::string LossesText(const std::vector<LossRecord>& losses);

// Those of such a file up to `step`; none where there is no file. Lines that are damaged are left
// out.
std::vector<LossRecord> ReadLosses(const std::filesystem::path& path, int step);

// A picture (SVG) of them: the total with the held-out one, and the errors in the noise of
// translations and rotations, 1 being a blind guess's.
std::string LossCurves(const std::string& title, const std::vector<LossRecord>& losses);

}  // namespace simwright::scene
