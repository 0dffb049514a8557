#include "workflows/skills/rollout_pictures.h"

#include <algorithm>
#include <cmath>

#include "core/camera.h"
#include "core/json.h"
#include "core/progress.h"
#include "render/forward.h"
#include "workflows/skills/posed_scene.h"
#include "workflows/skills/skill_motion.h"

namespace simwright::workflows {
namespace {

constexpr int kFrames = 12, kColumns = 6;
constexpr int kSize = 320;           // pixels a side
constexpr double kAzimuth = -1.95;   // rad from +x: objects face the robot
constexpr double kElevation = 0.45;  // rad
constexpr double kFov = 0.5;         // rad

const skills::SkillVariant& VariantOf(const RunSkill& skill, const RecordedSubtask& subtask) {
  return skill.evaluated->variants[static_cast<size_t>(subtask.start.variant)];
}

// Returns the moments of a subtask to render.
std::vector<const RecordedMoment*> Frames(const RecordedSubtask& subtask) {
  std::vector<const RecordedMoment*> frames;
  const auto last = static_cast<double>(subtask.moments.size() - 1);
  for (int i = 0; i < kFrames; ++i) {
    frames.push_back(&subtask.moments[static_cast<size_t>(std::lround(last * i / (kFrames - 1)))]);
  }
  return frames;
}

core::Camera CameraFor(const Eigen::AlignedBox3d& bounds) {
  const double radius = 0.5 * bounds.diagonal().norm();
  return core::OrbitCamera(bounds.center(), 0.85 * radius / std::sin(0.5 * kFov), kElevation,
                           kAzimuth, kFov, kSize, kSize);
}

core::Image Picture(const PosedScene& posed, const RecordedMoment& moment,
                    const core::Camera& camera) {
  render::Scene scene;
  posed.Place(moment, &scene);
  render::ForwardOptions options;
  options.samples_per_side = 2;
  options.shaded = true;
  options.occlusion_rays = 8;
  options.occlusion_reach = 0.02f;  // the floor is large
  const Eigen::Vector3f right = camera.world_from_camera.linear().col(0).cast<float>();
  const Eigen::Vector3f back = -camera.world_from_camera.linear().col(2).cast<float>();
  options.light = render::SphericalHarmonicsLight::Studio(
      (-0.5f * right + 0.6f * back + 0.7f * Eigen::Vector3f::UnitZ()).normalized());
  return render::RenderForward(scene, camera, options).color;
}

// Rounds to a hundredth of a millimetre or milliradian, the resolution of a picture.
double Rounded(double value) {
  return std::round(value * 1e5) / 1e5;
}

core::Json MomentJson(const RecordedMoment& moment, const skills::SkillVariant& variant) {
  core::Json line;
  for (const double joint : moment.arm) line["q"].push_back(Rounded(joint));
  line["q"].push_back(Rounded(moment.leader));
  line["things"] = core::Json::array();
  for (const int object : variant.placed) {
    const auto t = static_cast<size_t>(object);
    const Eigen::Isometry3d& pose = moment.state.roots[t];
    const Eigen::Quaterniond turn(pose.linear());
    core::Json numbers;
    for (const double number : {pose.translation().x(), pose.translation().y(),
                                pose.translation().z(), turn.w(), turn.x(), turn.y(), turn.z()}) {
      numbers.push_back(Rounded(number));
    }
    for (const double joint : moment.state.joints[t]) numbers.push_back(Rounded(joint));
    line["things"].push_back(numbers);
  }
  return line;
}

core::Json HeadJson(const SkillRun& run, const std::vector<RunSkill>& skills,
                    const ChainRecording& recording) {
  const RecordedSubtask& first = recording.subtasks.front();
  const skills::SkillVariant& variant = VariantOf(skills.front(), first);
  core::Json head = {{"format", 1},
                     {"robot", run.robot},
                     {"task", run.set.tasks[static_cast<size_t>(first.start.variant)].name},
                     {"episode", recording.episode},
                     {"success", recording.success},
                     {"rate", skills.front().evaluated->options.control_rate},
                     {"joints", MotionJointsOf(*skills.front().evaluated->robot).names},
                     {"things", core::Json::array()}};
  for (const int object : variant.placed) {
    const tasks::ArticulatedObject& known = variant.model.objects[static_cast<size_t>(object)];
    core::Json joints = core::Json::array();
    for (const tasks::ObjectJoint& joint : known.joints) joints.push_back(joint.name);
    head["things"].push_back({{"name", known.name}, {"joints", joints}});
  }
  for (size_t k = 0; k < recording.subtasks.size(); ++k) {
    head["subtasks"].push_back(
        {{"name", skills[k].name}, {"lines", recording.subtasks[k].moments.size()}});
  }
  return head;
}

}  // namespace

core::Image RolloutStrip(const std::vector<RunSkill>& skills, const ChainRecording& recording) {
  const skills::SkillVariant& variant = VariantOf(skills.front(), recording.subtasks.front());
  const PosedScene posed(*skills.front().evaluated->robot, variant);
  std::vector<const RecordedMoment*> frames;
  Eigen::AlignedBox3d bounds;
  for (const RecordedSubtask& subtask : recording.subtasks) {
    for (const RecordedMoment* moment : Frames(subtask)) {
      frames.push_back(moment);
      bounds.extend(posed.Bounds(*moment));
    }
  }
  const core::Camera camera = CameraFor(bounds);
  std::vector<core::Image> pictures;
  for (const RecordedMoment* moment : frames) {
    core::CheckCancelled();
    pictures.push_back(Picture(posed, *moment, camera));
  }
  return core::ContactSheet(pictures, kColumns);
}

std::string RolloutPoses(const SkillRun& run, const std::vector<RunSkill>& skills,
                         const ChainRecording& recording) {
  std::string text = core::JsonLine(HeadJson(run, skills, recording)) + "\n";
  for (size_t k = 0; k < recording.subtasks.size(); ++k) {
    const RecordedSubtask& subtask = recording.subtasks[k];
    for (const RecordedMoment& moment : subtask.moments) {
      text += core::JsonLine(MomentJson(moment, VariantOf(skills[k], subtask))) + "\n";
    }
  }
  return text;
}

}  // namespace simwright::workflows
