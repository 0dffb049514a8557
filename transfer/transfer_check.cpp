#include "transfer/transfer_check.h"

#include <cstdio>
#include <utility>

#include "core/error.h"
#include "core/finding_json.h"
#include "core/json.h"
#include "rl/policy_file.h"
#include "rl/training.h"
#include "workflows/skills/motion_files.h"
#include "workflows/skills/skill_training.h"

namespace simwright::transfer {
namespace fs = std::filesystem;
namespace {

// The stream of a policy's planning is apart from that of the world.
constexpr std::uint64_t kPlanningSeed = 0x7031;

struct CheckedMotion {
  workflows::SkillRun run;
  TransferMotion motion;
};

CheckedMotion ReadCheckedMotion(const TransferRequest& request) {
  const std::string where = request.motion.string();
  CheckedMotion checked;
  checked.motion.trajectory = workflows::ReadMotion(request.motion);
  checked.motion.where = where;
  const workflows::SkillMetadata metadata =
      workflows::MetadataFrom(checked.motion.trajectory.metadata, where);
  const fs::path folder = request.run.empty() ? fs::path(metadata.run) : request.run;
  if (!fs::exists(folder)) {
    throw core::Error("the run does not exist", folder.string(), "give its folder with --run");
  }
  checked.run = workflows::ReadRun(folder);
  checked.motion.times = metadata.times;
  checked.motion.start = metadata.start;
  return checked;
}

TransferResult Measure(const WorldTrial& trial, const std::string& what, int worlds,
                       core::Progress* progress) {
  TransferResult result;
  progress->Stage(what + " in perturbed twins", worlds);
  result.rate = RateAt(trial, 1.0, worlds, progress);
  progress->Stage(what + ", other scales of the uncertainty");
  result.largest_scale = LargestScale(trial, result.rate, kHeldShare, progress);
  return result;
}

void AddTransferFindings(const std::string& what, const TransferResult& result,
                         const std::string& remedy, core::Findings* findings) {
  char sentence[200];
  if (result.largest_scale < 0.0) {
    findings->push_back({"transfer-not-in-twin", core::Severity::kWarning, what,
                         "it succeeds in less than 90 % of the worlds even without uncertainty",
                         result.rate.rate(), remedy});
  } else if (result.largest_scale < 1.0) {
    std::snprintf(sentence, sizeof sentence,
                  "it succeeds in 90 %% of the perturbed twins only up to %.2f times the twin's "
                  "uncertainty",
                  result.largest_scale);
    findings->push_back({"transfer-uncertain", core::Severity::kWarning, what, sentence,
                         result.largest_scale, remedy});
  }
}

std::string Row(const std::string& what, const TransferResult& result) {
  char line[240], held[80];
  if (result.largest_scale < 0.0) {
    std::snprintf(held, sizeof held, "less than 90 %% even without uncertainty");
  } else {
    std::snprintf(held, sizeof held, "90 %% hold up to %.2f times the uncertainty",
                  result.largest_scale);
  }
  std::snprintf(line, sizeof line, "%-8s %d of %d, %.1f %% (95 %%: %.1f to %.1f); %s\n",
                what.c_str(), result.rate.successes, result.rate.worlds, 100.0 * result.rate.rate(),
                100.0 * result.rate.interval.low, 100.0 * result.rate.interval.high, held);
  return line;
}

core::Json ResultJson(const TransferResult& result) {
  return {{"worlds", result.rate.worlds},      {"successes", result.rate.successes},
          {"rate", result.rate.rate()},        {"low", result.rate.interval.low},
          {"high", result.rate.interval.high}, {"largest_scale", result.largest_scale}};
}

}  // namespace

PhysicsRanges PhysicsRangesOf(const workflows::SkillRun& run) {
  PhysicsRanges ranges;
  ranges.mass = run.options.mass;
  ranges.friction = run.options.friction;
  ranges.finger_friction =
      run.options.finger_friction.value_or(workflows::TrainRequest().finger_friction);
  const robot::RobotModel& robot = workflows::RobotOf(run.robot);
  ranges.own_finger_friction =
      robot.urdf.links[static_cast<size_t>(robot.gripper.links.front())].friction;
  return ranges;
}

PerturbedTwin PerturbedTwinOf(const TransferTask& task, const workflows::TwinRecord& record,
                              const fs::path& where) {
  return PerturbedTwin(record, task.described(), PhysicsRangesOf(task.run()), where);
}

std::vector<rl::Policy> PoliciesOf(const TransferTask& task) {
  std::vector<rl::Policy> policies;
  for (const workflows::RunSkill& skill : task.skills()) {
    const fs::path file = skill.folder / rl::kPolicyFile;
    if (!fs::exists(file)) return {};
    policies.push_back(rl::ReadPolicy(file));
    skills::RequireFits(policies.back(), *skill.evaluated);
  }
  return policies;
}

TransferReport CheckTransfer(const TransferRequest& request, core::Progress* progress) {
  const workflows::TwinRecord record = workflows::ReadTwin(request.twin);
  const CheckedMotion checked = ReadCheckedMotion(request);
  const TransferTask task(checked.run);
  const workflows::SkillMetadata metadata =
      workflows::MetadataFrom(checked.motion.trajectory.metadata, checked.motion.where);
  workflows::RequireMatchingRun(metadata, checked.run, task.skills(), checked.motion.where);
  const PerturbedTwin twin = PerturbedTwinOf(task, record, request.twin);
  TransferReport report;
  report.task = task.task().name;
  report.motion = request.motion.string();
  report.replay = Measure(
      [&](double scale, std::uint64_t index) {
        return task.Replays(twin.World(scale, request.seed, index), checked.motion);
      },
      "replay", request.worlds, progress);
  AddTransferFindings("replay", report.replay,
                      "simwright export --twin chooses the motion that holds best; a known "
                      "--camera-height or a nearer photo makes the twin more certain",
                      &report.findings);
  const std::vector<rl::Policy> policies = PoliciesOf(task);
  if (policies.empty()) return report;
  std::vector<const rl::Policy*> acting;
  for (const rl::Policy& policy : policies) acting.push_back(&policy);
  report.policy = Measure(
      [&](double scale, std::uint64_t index) {
        core::Rng rng = core::StreamRng(request.seed ^ kPlanningSeed, index);
        return task.Acts(twin.World(scale, request.seed, index), acting, rng);
      },
      "policy", request.worlds, progress);
  AddTransferFindings("policy", *report.policy,
                      "train longer with simwright train --twin, or make the twin more certain",
                      &report.findings);
  return report;
}

std::string TransferTable(const TransferReport& report) {
  std::string table = report.task + ", " + report.motion + "\n" + Row("replay", report.replay);
  if (report.policy) table += Row("policy", *report.policy);
  return table;
}

std::string TransferJson(const TransferReport& report) {
  core::Json json = {{"task", report.task}, {"motion", report.motion}};
  json["replay"] = ResultJson(report.replay);
  if (report.policy) json["policy"] = ResultJson(*report.policy);
  json["findings"] = core::FindingsJson(report.findings);
  return core::JsonText(json);
}

}  // namespace simwright::transfer
