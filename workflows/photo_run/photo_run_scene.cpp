#include "workflows/photo_run/photo_run_scene.h"

#include <cstdio>
#include <vector>

#include "assets/articulated_folder.h"
#include "assets/semantic_model.h"
#include "core/error.h"
#include "core/files.h"
#include "library/articulated/articulated_kinds.h"
#include "robot/panda_model.h"
#include "tasks/articulated_object.h"
#include "tasks/rules/affordances.h"
#include "workflows/library/library.h"

namespace simwright::workflows {
namespace fs = std::filesystem;
namespace {

constexpr int kTries = 4;  // sizes tried per kind

tasks::ArticulatedObject ObjectIn(const fs::path& folder) {
  return tasks::MakeArticulatedObject(folder.filename().string(),
                                      assets::ReadSemanticModel(folder));
}

struct Candidate {
  const library::Kind* kind = nullptr;
  std::uint64_t seed = 1;
  std::string Name() const { return kind->name + "_" + std::to_string(seed); }
};

std::vector<Candidate> CandidatesOf(const std::string& kind, std::uint64_t seed) {
  const std::vector<std::string> kinds = kind == "any"
                                             ? std::vector<std::string>{"drawer_unit", "microwave"}
                                             : std::vector<std::string>{kind};
  std::vector<Candidate> candidates;
  for (const std::string& name : kinds) {
    for (int i = 0; i < kTries; ++i) {
      candidates.push_back({&library::KindNamed(name), seed + static_cast<std::uint64_t>(i)});
    }
  }
  return candidates;
}

// Returns true if `object` fits into a receptacle with a door.
bool Holds(const Candidate& candidate, const tasks::ArticulatedObject& object) {
  const core::TemporaryFolder temporary;
  const fs::path folder = temporary.path() / candidate.Name();
  fs::create_directories(folder);
  assets::WriteArticulatedAsset(candidate.kind->make({candidate.seed, candidate.Name()}), folder);
  const tasks::ArticulatedObject furniture = ObjectIn(folder);
  for (size_t c = 0; c < furniture.receptacles.size(); ++c) {
    if (furniture.receptacles[c].door < 0) continue;
    if (tasks::FitsInto(object, furniture, static_cast<int>(c))) return true;
  }
  return false;
}

// Makes a candidate. Returns false, with the reason in `refusal`, if it fails its check.
bool MakeFurniture(const Candidate& candidate, const fs::path& output, core::Progress* progress,
                   std::string* refusal) {
  LibraryOptions options;
  options.kind = candidate.kind->name;
  options.seed = candidate.seed;
  options.force = true;  // an interrupted run may have left one
  const LibraryOutcome made = MakeLibrary(options, output, progress).front();
  core::CheckCancelled();
  *refusal = made.refusal;
  return made.refusal.empty();
}

}  // namespace

void RequireLiftable(const fs::path& folder) {
  const tasks::ArticulatedObject object = ObjectIn(folder);
  if (tasks::CanBeLifted(object)) return;
  const double width = object.box.sizes().head<2>().minCoeff();
  char what[160], remedy[80];
  if (width > tasks::kMaxGraspWidth) {
    std::snprintf(what, sizeof(what),
                  "cannot be picked up: it is %.1f cm wide, and the gripper opens %.1f cm and "
                  "grasps up to %.1f cm",
                  100.0 * width, 100.0 * robot::Panda(false).gripper.MaxOpening(),
                  100.0 * tasks::kMaxGraspWidth);
    // Two millimetres below the graspable limit.
    std::snprintf(remedy, sizeof(remedy), "--force --height %.3f makes a smaller one",
                  object.height() * (tasks::kMaxGraspWidth - 0.002) / width);
  } else if (object.mass > tasks::kPayload) {
    std::snprintf(what, sizeof(what),
                  "cannot be picked up: it weighs %.1f kg, the arm lifts %.1f kg", object.mass,
                  tasks::kPayload);
    std::snprintf(remedy, sizeof(remedy), "--force and a smaller --height than %.3f",
                  object.height());
  } else {
    const Eigen::Vector3d size = 100.0 * object.box.sizes();
    std::snprintf(what, sizeof(what),
                  "cannot be picked up: it is %.1f x %.1f x %.1f cm, too long or too flat to grasp",
                  size.x(), size.y(), size.z());
    std::snprintf(remedy, sizeof(remedy), "choose another --task, or another --height than %.3f",
                  object.height());
  }
  throw core::Error(what, folder.string(), remedy);
}

Furniture MakeFurniture(const fs::path& folder, const std::string& kind, std::uint64_t seed,
                        const fs::path& output, core::Progress* progress) {
  const tasks::ArticulatedObject object = ObjectIn(folder);
  const std::vector<Candidate> candidates = CandidatesOf(kind, seed);
  std::string refusal;
  progress->Stage("furniture");
  for (const Candidate& candidate : candidates) {
    core::CheckCancelled();
    if (!Holds(candidate, object) || !MakeFurniture(candidate, output, progress, &refusal))
      continue;
    return {candidate.Name(), candidate.kind->name, true};
  }
  for (const Candidate& candidate : candidates) {
    if (!MakeFurniture(candidate, output, progress, &refusal)) continue;
    return {candidate.Name(), candidate.kind->name, false};
  }
  throw core::Error("no furniture could be made: " + refusal, output.string(),
                    "try another --seed");
}

}  // namespace simwright::workflows
