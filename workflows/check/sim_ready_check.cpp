#include "workflows/check/sim_ready_check.h"

#include <algorithm>
#include <map>
#include <string>
#include <utility>

#include "assets/articulated_folder.h"
#include "assets/asset_folder.h"
#include "core/error.h"
#include "manipulation/grasp_proof.h"
#include "manipulation/parallel_gripper.h"
#include "sim/grasp_trial.h"
#include "validation/check.h"
#include "validation/check_results.h"
#include "validation/sim_ready_exam.h"
#include "workflows/grasps/grasp_making.h"

namespace simwright::workflows {
namespace fs = std::filesystem;
namespace {

constexpr int kGrasps = 4;  // proved and tried again with a release
constexpr int kTriesPerGrasp = 40;
constexpr int kGraspCandidates = 400;
constexpr int kSurfaceSamples = 4000;
constexpr std::uint64_t kGraspSeed = 1;

// Returns "; most often: REASON" of the failures by reason; empty without any.
std::string MostFrequent(const std::map<std::string, int>& failures) {
  const auto most =
      std::max_element(failures.begin(), failures.end(),
                       [](const auto& a, const auto& b) { return a.second < b.second; });
  return most == failures.end() ? "" : "; most often: " + most->first;
}

// Adds grasp-bullet and grasp-mujoco: grasps that hold in Bullet are tried in both engines, and the
// object must fall when the fingers open. An object that the gripper cannot hold (too wide, too
// thin, too heavy) is not examined.
void AddGraspRows(const assets::Asset& asset, validation::CheckResults* results) {
  const manipulation::ParallelGripper gripper = manipulation::ReadGripper("panda");
  const manipulation::GraspObject object = GraspObjectOf(asset);
  manipulation::GraspProofOptions options;
  options.count = kGrasps;
  options.tries_per_grasp = kTriesPerGrasp;
  options.sampler.candidates = kGraspCandidates;
  options.sampler.samples = kSurfaceSamples;
  manipulation::ProvedGrasps proved;
  try {
    proved = manipulation::ProveGrasps(object, gripper.model, options, kGraspSeed);
  } catch (const core::Error& error) {
    results->Report("grasp", 0.0, "not examined: " + std::string(error.what()));
    return;
  }
  const std::pair<const char*, sim::GraspEngine> engines[] = {
      {"bullet", sim::GraspEngine::kBullet}, {"mujoco", sim::GraspEngine::kMujoco}};
  for (const auto& [name, engine] : engines) {
    sim::GraspTrialOptions trial = options.trial;
    trial.friction = proved.friction;
    trial.release = true;
    const sim::GraspTrials trials(engine, gripper.model, object.body, trial);
    int held = 0;
    std::string reason = "of " + std::to_string(proved.tried) + " candidates " +
                         std::to_string(proved.held_in_bullet) + " held in Bullet and " +
                         std::to_string(proved.held_in_both) + " of these in MuJoCo" +
                         MostFrequent(proved.failures);
    for (const manipulation::Grasp& grasp : proved.grasps) {
      const sim::GraspTrialResult result =
          trials.Run({grasp.object_from_tool, grasp.opening, std::nullopt});
      held += result.held && result.released;
      if (!result.reason.empty()) reason = "the last one: " + result.reason;
    }
    // A load that one hand cannot hold is no fault of the asset, as long as the engines agree.
    const core::Severity none_held =
        proved.held_in_bullet == 0 ? core::Severity::kWarning : core::Severity::kError;
    results->Add(std::string("grasp-") + name, held > 0 ? core::Severity::kInfo : none_held, held,
                 "of " + std::to_string(proved.grasps.size()) +
                     " grasps close, lift 20 cm, shake, hold 2 s and release, at least 1" +
                     (held > 0 ? "" : "; " + reason));
  }
}

}  // namespace

validation::CheckReport CheckSimReady(const fs::path& folder,
                                      const validation::CheckLimits& limits) {
  validation::CheckReport report = validation::CheckAsset(folder, limits);
  if (assets::IsArticulatedAssetFolder(folder)) return report;
  validation::CheckResults results(folder.filename().string());
  const assets::Asset asset = assets::ReadAsset(folder);
  validation::AddSimReadyExam(asset, folder, limits, &results);
  AddGraspRows(asset, &results);
  for (core::Finding& row : results.Take()) report.results.push_back(std::move(row));
  return report;
}

}  // namespace simwright::workflows
