#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "core/progress.h"

namespace simwright::workflows {

struct PickTestRequest {
  std::vector<std::filesystem::path> assets;  // folders of rigid assets with a grasps.json
  int poses = 4;  // of each object on the table, at random places and yaws
  std::uint64_t seed = 1;
};

// The picks of one object by the Panda: of `poses`, those that succeed with the first plan. A pick
// is planned among table and object, retimed, and replayed in Bullet with contact forces alone, at
// the low end of the object's friction. It lifts by 12 cm, and succeeds if both fingers hold the
// object and its lowest point is 5 cm higher.
struct PickTestRow {
  std::string asset;
  int poses = 0;
  int with_proved = 0;   // grasps of grasps.json
  int with_sampled = 0;  // antipodal grasps that the planner samples itself
  // Successes of `poses` episodes of the scripted expert of skills (skills/scripted_expert.h),
  // which picks the object up from the floor to a goal above it, with the randomization of an
  // evaluation.
  int expert_proved = 0;      // by the grasps of grasps.json
  int expert_from_above = 0;  // across the object's thin side, from above
  std::string failure;        // of the last failed pick with proved grasps; or empty
};

// Plans and replays the picks, with and without proved grasps, then runs the expert. Throws
// core::Error if an asset has no grasps.json.
std::vector<PickTestRow> RunPickTest(const PickTestRequest& request, core::Progress* progress);

std::string PickTestTable(const std::vector<PickTestRow>& rows);
std::string PickTestJson(const std::vector<PickTestRow>& rows);

}  // namespace simwright::workflows
