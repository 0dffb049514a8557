#include "transfer/transfer_task.h"

#include <algorithm>
#include <optional>
#include <utility>

#include "core/error.h"
#include "robot/robot_model.h"
#include "skills/skill_chain.h"
#include "skills/start_pool.h"
#include "workflows/grasps/asset_grasps.h"
#include "workflows/skills/trajectory_replay.h"

namespace simwright::transfer {
namespace {

workflows::SkillRun Nominal(const workflows::SkillRun& run) {
  if (run.set.tasks.size() != 1) {
    throw core::Error("trains " + std::to_string(run.set.tasks.size()) +
                          " tasks; the transfer check needs a run of one",
                      run.folder.string(), "train a single --task");
  }
  workflows::SkillRun nominal = run;
  nominal.randomized = false;
  for (const tasks::TaskAsset& asset : run.set.assets) {
    nominal.options.placement_ranges.emplace(asset.name, skills::PlacementRange());
  }
  return nominal;
}

// Returns the world that the task of `run` describes.
TransferWorld DescribedWorld(const workflows::SkillRun& run) {
  const tasks::Task& task = run.set.tasks.front();
  TransferWorld world;
  core::Findings unread;
  for (const tasks::AssetPlacement& placement : task.subtasks.front().start.placements) {
    const auto asset =
        std::find_if(run.set.assets.begin(), run.set.assets.end(),
                     [&](const tasks::TaskAsset& one) { return one.name == placement.asset; });
    if (asset == run.set.assets.end()) continue;
    TransferObject& object = world.objects.emplace_back();
    object.model = assets::ReadSemanticModel(asset->path);
    object.model.name = asset->name;
    object.world_from_asset = placement.world_from_asset;
    object.fixed = placement.fixed;
    if (run.proved_grasps) {
      object.grasps =
          workflows::GraspsForRobot(asset->path, workflows::RobotOf(run.robot), &unread);
    }
  }
  return world;
}

// Moves the placements of `start` with the objects of `world`, adds the objects that it lacks, and
// removes those that the world lacks.
void Place(const TransferWorld& described, const TransferWorld& world, tasks::InitialState* start) {
  std::erase_if(start->placements, [&](const tasks::AssetPlacement& place) {
    return std::none_of(
        world.objects.begin(), world.objects.end(),
        [&](const TransferObject& object) { return object.model.name == place.asset; });
  });
  for (const TransferObject& object : world.objects) {
    const auto place = std::find_if(
        start->placements.begin(), start->placements.end(),
        [&](const tasks::AssetPlacement& one) { return one.asset == object.model.name; });
    if (place == start->placements.end()) {
      start->placements.push_back({object.model.name, object.world_from_asset, object.fixed});
      continue;
    }
    for (const TransferObject& other : described.objects) {
      if (other.model.name != object.model.name) continue;
      place->world_from_asset =
          object.world_from_asset * other.world_from_asset.inverse() * place->world_from_asset;
    }
  }
}

// Sets the factors of the bodies of `start`, a start of `variant`, to those of `world`.
void SetBodies(const skills::SkillVariant& variant, const TransferWorld& world,
               skills::StartState* start) {
  const size_t count = variant.model.objects.size();
  start->mass.assign(count, 1.0);
  start->friction.assign(count, 1.0);
  start->joint.assign(count, 1.0);
  for (const TransferObject& object : world.objects) {
    const int index = variant.model.Find(object.model.name);
    if (index < 0) continue;
    start->mass[static_cast<size_t>(index)] = object.mass;
    start->friction[static_cast<size_t>(index)] = object.friction;
  }
  start->finger_friction = world.finger_friction;
  start->delay = 0;
}

}  // namespace

TransferTask::TransferTask(const workflows::SkillRun& run)
    : run_(Nominal(run)),
      skills_(workflows::PrepareSkills(run_)),
      fine_skills_(workflows::PrepareSkills(workflows::AtPhysicsRate(run_))),
      described_(DescribedWorld(run_)) {}

std::vector<workflows::RunSkill> TransferTask::SkillsIn(
    const TransferWorld& world, const std::vector<workflows::RunSkill>& skills) const {
  std::vector<workflows::RunSkill> other = skills;
  const std::vector<tasks::Subtask>& subtasks = task().subtasks;
  for (size_t k = 0; k < skills.size(); ++k) {
    skills::SkillSubtask one;
    one.subtask = subtasks[k];
    Place(described_, world, &one.subtask.start);
    if (k + 1 < subtasks.size()) {
      one.next = subtasks[k + 1];
      Place(described_, world, &one.next->start);
    }
    for (const TransferObject& object : world.objects) {
      one.assets.push_back(object.model);
      if (!object.grasps.empty()) one.grasps[object.model.name] = object.grasps;
    }
    other[k].skill = other[k].evaluated = skills::InScenes(*skills[k].evaluated, {one});
  }
  return other;
}

bool TransferTask::Replays(const TransferWorld& world, const TransferMotion& motion) const {
  skills::StartState start =
      skills::ParseStart(motion.start, *skills_.front().evaluated, motion.where + ", note 'start'");
  const std::vector<workflows::RunSkill> skills = SkillsIn(world, fine_skills_);
  const skills::SkillVariant& variant = skills.front().evaluated->variants.front();
  start.variant = 0;
  start.state = variant.start;
  start.grasp = start.held = -1;
  start.closed_to.reset();
  SetBodies(variant, world, &start);
  const std::vector<bool> successes =
      workflows::ReplayTrajectoryFrom(skills, motion.trajectory, motion.times, start, motion.where);
  return successes.size() == skills.size() && successes.back();
}

bool TransferTask::Acts(const TransferWorld& world, const std::vector<const rl::Policy*>& policies,
                        core::Rng& rng) const {
  const std::vector<workflows::RunSkill> skills = SkillsIn(world, skills_);
  skills::StartState start = skills::SampleStart(*skills.front().evaluated, rng);
  SetBodies(skills.front().evaluated->variants.front(), world, &start);
  std::vector<skills::ChainLink> links;
  for (size_t k = 0; k < skills.size(); ++k) {
    links.push_back({skills[k].evaluated.get(), policies[k]});
  }
  return skills::RunChain(links, start, rng).success;
}

}  // namespace simwright::transfer
