#include <algorithm>
#include <cstdio>
#include <map>

#include "core/json.h"
#include "workflows/scenes/scene_certification.h"

namespace simwright::workflows {
namespace {

using certificate::Certificate;
using certificate::Verdict;

core::OrderedJson PoseJson(const Eigen::Isometry3d& pose) {
  const Eigen::Quaterniond turn(pose.linear());
  const Eigen::Vector3d& at = pose.translation();
  core::OrderedJson json;
  json["translation"] = {at.x(), at.y(), at.z()};
  json["quaternion_wxyz"] = {turn.w(), turn.x(), turn.y(), turn.z()};
  return json;
}

core::OrderedJson PlanJson(const Certificate& certificate) {
  const certificate::MotionPlan& plan = *certificate.plan;
  core::OrderedJson json;
  json["grasp"] = PoseJson(plan.grasp.body_from_tool);
  json["grasp_width_m"] = plan.grasp.width;
  json["length_rad"] = plan.Length();
  json["phases"] = core::OrderedJson::array();
  for (size_t i = 0; i < plan.segments.size(); ++i) {
    const certificate::PlanSegment& segment = plan.segments[i];
    core::OrderedJson one;
    one["phase"] = certificate::PhaseName(segment.phase);
    if (i < certificate.phases.size()) one["end_s"] = certificate.phases[i].end;
    one["gripper"] = segment.leader;
    one["waypoints"] = core::OrderedJson::array();
    for (const robot::JointVector& waypoint : segment.waypoints) {
      one["waypoints"].push_back(std::vector<double>(waypoint.begin(), waypoint.end()));
    }
    json["phases"].push_back(std::move(one));
  }
  return json;
}

core::OrderedJson SearchJson(const Certificate& certificate) {
  const certificate::SearchCounts& counts = certificate.counts;
  core::OrderedJson json;
  json["grasps"] = counts.grasps;
  json["rejected_by_gripper"] = counts.gripper_rejected;
  json["tried_with_arm"] = counts.tried;
  json["unreachable"] = counts.unreachable;
  json["rejected_by_arm"] = counts.arm_rejected;
  json["rejected_by_path"] = counts.path_rejected;
  json["tree_searches"] = counts.tree_searches;
  json["replays"] = certificate.proofs;
  return json;
}

core::OrderedJson ProofJson(const certificate::Proof& proof) {
  core::OrderedJson json;
  json["success"] = proof.success;
  if (!proof.failure.empty()) json["failure"] = proof.failure;
  json["seconds"] = proof.seconds;
  json["others_moved_mm"] = 1e3 * proof.others_moved;
  json["moved_most"] = proof.moved_most;
  json["slip_mm"] = 1e3 * proof.slip;
  json["held"] = proof.held;
  json["free_bodies"] = proof.free_bodies;
  return json;
}

core::OrderedJson SceneJson(const CertifiedScene& scene, bool timed) {
  const Certificate& certificate = scene.certificate;
  core::OrderedJson json;
  json["scene"] = scene.name;
  json["instances"] = scene.instances;
  if (scene.instances == 0) {
    json["verdict"] = "no-such-object";
    json["reason"] = certificate.reason;
    return json;
  }
  json["object"] = scene.target;
  json["solvable"] = certificate.solvable();
  json["verdict"] = certificate::VerdictName(certificate.verdict);
  if (!certificate.reason.empty()) json["reason"] = certificate.reason;
  if (certificate.verdict == Verdict::kBlocked) {
    json["blockers"] = certificate.blockers;
    json["blockers_verified"] = certificate.blockers_verified;
  }
  json["difficulty"] = certificate.Difficulty();
  json["world_from_robot"] = PoseJson(scene.world_from_robot);
  json["search"] = SearchJson(certificate);
  if (certificate.proofs > 0) json["proof"] = ProofJson(certificate.proof);
  if (certificate.solvable()) {
    json["trajectory"] = scene.trajectory;
    json["plan"] = PlanJson(certificate);
  }
  if (timed) json["seconds"] = scene.seconds;
  return json;
}

}  // namespace

int SceneCertificationReport::SolvableCount() const {
  return static_cast<int>(std::count_if(scenes.begin(), scenes.end(), [](const auto& scene) {
    return scene.certificate.solvable();
  }));
}

double SceneCertificationReport::MedianSeconds() const {
  std::vector<double> seconds;
  for (const CertifiedScene& scene : scenes) {
    if (scene.instances > 0) seconds.push_back(scene.seconds);
  }
  if (seconds.empty()) return 0.0;
  const auto middle = seconds.begin() + static_cast<std::ptrdiff_t>(seconds.size() / 2);
  std::nth_element(seconds.begin(), middle, seconds.end());
  return *middle;
}

std::string CertificationTable(const SceneCertificationReport& report) {
  int plans = 0, proved = 0, blocked = 0, verified = 0;
  std::map<std::string, int> reasons;
  for (const CertifiedScene& scene : report.scenes) {
    const Certificate& certificate = scene.certificate;
    plans += certificate.proofs;
    proved += certificate.solvable();
    if (scene.instances == 0) {
      ++reasons["no such object"];
    } else if (!certificate.solvable()) {
      ++reasons[certificate::VerdictName(certificate.verdict)];
    }
    if (certificate.verdict != Verdict::kBlocked || scene.instances == 0) continue;
    ++blocked;
    verified += certificate.blockers_verified;
  }
  std::string text = report.output.string() + ": " + report.task + "\n";
  char line[256];
  const auto count = static_cast<int>(report.scenes.size());
  if (count <= 10) {
    for (const CertifiedScene& scene : report.scenes) {
      std::snprintf(line, sizeof line, "%s: ", scene.name.c_str());
      text += line;
      if (scene.certificate.solvable()) {
        std::snprintf(line, sizeof line, "solvable with %s in %.1f s, difficulty %.2f\n",
                      scene.target.c_str(), scene.certificate.trajectory.times.back(),
                      scene.certificate.Difficulty());
        text += line;
      } else {
        text += (scene.target.empty() ? "" : scene.target + " ") + scene.certificate.reason +
                (scene.certificate.blockers_verified ? " (solvable without)" : "") + "\n";
      }
    }
  }
  std::snprintf(line, sizeof line, "%d of %d are solvable (%.0f %%)\n", report.SolvableCount(),
                count, 100.0 * report.SolvableCount() / count);
  text += line;
  for (const auto& [reason, number] : reasons) {
    std::snprintf(line, sizeof line, "  %s: %d\n", reason.c_str(), number);
    text += line;
  }
  if (blocked > 0) {
    std::snprintf(line, sizeof line,
                  "%d of %d named blockers are verified: without them the task is solvable\n",
                  verified, blocked);
    text += line;
  }
  std::snprintf(line, sizeof line,
                "%d of %d replays of planned trajectories succeed\n"
                "%.2f s each in the median, %.1f s in total\n",
                proved, plans, report.MedianSeconds(), report.seconds);
  return text + line;
}

std::string CertificationJson(const SceneCertificationReport& report, bool timed) {
  core::OrderedJson json;
  json["format"] = 1;
  json["task"] = report.task;
  json["robot"] = "panda";
  json["solvable"] = report.SolvableCount();
  json["scenes"] = core::OrderedJson::array();
  for (const CertifiedScene& scene : report.scenes)
    json["scenes"].push_back(SceneJson(scene, timed));
  if (timed) {
    json["median_seconds"] = report.MedianSeconds();
    json["seconds"] = report.seconds;
  }
  return core::JsonText(json);
}

}  // namespace simwright::workflows
