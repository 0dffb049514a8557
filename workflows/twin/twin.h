#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/finding.h"
#include "core/progress.h"
#include "llm/chat_model.h"
#include "workflows/twin/twin_record.h"

namespace simwright::workflows {

// The numbers of the camera that the user knows; 0: unknown. Angles in degrees.
struct TwinCameraFlags {
  double fov = 0.0;        // horizontal field of view
  double elevation = 0.0;  // of the optical axis below the horizon
  double height = 0.0;     // m, above the table
  bool upright = false;    // the photo is not rolled

  bool StatesPose() const { return elevation != 0.0 || height != 0.0 || upright; }
  // Returns false, with the reason, for a value outside of what a photo of a table has.
  bool IsValid(std::string* error) const;
};

// A photo of the table with what belongs to it.
struct TwinView {
  std::filesystem::path photo;
  std::filesystem::path depth;  // of the photo's pixels, 16 bits; empty: none
  // The user's boxes, masks and categories (docs/twin.md) in place of the detector; empty: none.
  std::filesystem::path objects;
};

struct TwinRequest : TwinView {
  std::vector<TwinView> more;        // photos of the same table
  double depth_unit = 1e-3;          // m, of one step of the depth
  std::filesystem::path intrinsics;  // calibration (twin/camera_intrinsics.h); empty: none
  std::filesystem::path detector;    // weights; empty: the shipped ones
  llm::ChatModel* model = nullptr;   // names the objects and their boxes; null: the detector
  // Asset folders, or folders of them, of which some may stand on the table; empty: none.
  std::vector<std::filesystem::path> assets;
  bool free_form = false;  // reconstructs doubtful objects as `lift` does
  TwinCameraFlags camera;
  int most_objects = 25;  // the largest detections are kept
  std::uint64_t seed = 1;
  std::filesystem::path output;
  bool force = false;
};

struct TwinOutcome {
  std::filesystem::path folder, page;
  TwinRecord record;
  core::Findings findings;
  double seconds = 0.0;
};

// Rebuilds the table that a photo, or several (twin/table_merging.h), show: a folder with an asset
// for each object, twin.json with their poses and uncertainties (which the commands of `scene`
// read), twin.png and index.html. Throws core::Error for an unreadable or dark photo, one without
// an object on a table, a depth without a table, damaged boxes or weights, and an output that
// exists; throws core::Cancelled and what the model throws.
TwinOutcome MakeTwin(const TwinRequest& request, core::Progress* progress);

// Formats the outcome for a terminal: a line for each object.
std::string TwinTable(const TwinOutcome& outcome);

}  // namespace simwright::workflows
