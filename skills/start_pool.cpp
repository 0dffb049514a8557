#include "skills/start_pool.h"

#include "core/files.h"
#include "core/json.h"

namespace simwright::skills {
namespace {

using core::Json;
using core::JsonField;

constexpr size_t kMostStarts = 100000;
constexpr size_t kMostWaypoints = 16;
constexpr double kLongestRetreat = 10.0;    // m
constexpr double kLargestFriction = 100.0;  // coefficient of friction
constexpr const char* kStartRemedy = "let the training write it again";

Json PoseJson(const Eigen::Isometry3d& pose) {
  Json numbers = Json::array();
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 4; ++column) numbers.push_back(pose.matrix()(row, column));
  }
  return numbers;
}

std::vector<double> Factors(const JsonField& list, size_t count) {
  std::vector<double> factors = list.Numbers(count);
  for (const double factor : factors) {
    if (!(factor > 0.0)) list.Fail("has a factor that is not above 0");
  }
  return factors;
}

Eigen::Isometry3d PoseFrom(const JsonField& list) {
  const std::vector<double> numbers = list.Numbers(12);
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 4; ++column) {
      pose.matrix()(row, column) = numbers[static_cast<size_t>(4 * row + column)];
    }
  }
  const Eigen::Matrix3d rotation = pose.linear();
  if (!(rotation.transpose() * rotation).isIdentity(1e-6)) list.Fail("is not a rotation");
  return pose;
}

std::vector<double> List(const robot::JointVector& configuration) {
  return {configuration.data(), configuration.data() + configuration.size()};
}

robot::JointVector ConfigurationFrom(const JsonField& list, int size) {
  const std::vector<double> numbers = list.Numbers(static_cast<size_t>(size));
  return Eigen::Map<const Eigen::VectorXd>(numbers.data(), size);
}

StartState StartFrom(const JsonField& text, const Skill& skill) {
  StartState start;
  start.variant = text["variant"].Int(0, static_cast<int>(skill.variants.size()) - 1);
  const SkillVariant& variant = skill.variants[static_cast<size_t>(start.variant)];
  const size_t objects = variant.model.objects.size();
  start.state = variant.start;
  const std::vector<JsonField> roots = text["roots"].Elements(objects);
  const std::vector<JsonField> joints = text["joints"].Elements(objects);
  for (size_t i = 0; i < objects; ++i) {
    start.state.roots[i] = PoseFrom(roots[i]);
    start.state.joints[i] = joints[i].Numbers(variant.model.objects[i].joints.size());
  }
  start.state.goal = text["goal"].Vector<3>();
  start.arm = ConfigurationFrom(text["arm"], skill.robot->arm.size());
  start.grasp_configuration = ConfigurationFrom(text["at_work"], skill.robot->arm.size());
  start.leader = text["leader"].Number();
  if (text.Has("closed_to")) start.closed_to = text["closed_to"].Number();
  start.pitch = text["pitch"].Number();
  if (text.Has("grasp")) {
    const size_t grasps = variant.target ? variant.target->grasps.size() : 0;
    start.grasp = text["grasp"].Int(0, static_cast<int>(grasps) - 1);
  }
  if (text.Has("withdraw")) {
    start.retreat = text["withdraw"].Vector<3>();
    if (start.retreat.norm() > kLongestRetreat) text["withdraw"].Fail("is too long");
  }
  if (text.Has("via")) {
    const std::vector<JsonField> waypoints = text["via"].Elements();
    if (waypoints.size() > kMostWaypoints) text["via"].Fail("has too many waypoints");
    for (const JsonField& configuration : waypoints) {
      start.waypoints.push_back(ConfigurationFrom(configuration, skill.robot->arm.size()));
    }
  }
  start.held = text["held"].Int(-1, static_cast<int>(objects) - 1);
  if (start.held >= 0 && variant.fixed[static_cast<size_t>(start.held)]) {
    text["held"].Fail("names an object that cannot be grasped");
  }
  start.mass = Factors(text["mass"], objects);
  start.friction = Factors(text["friction"], objects);
  start.joint = Factors(text["joint"], objects);
  start.delay = text["delay"].Int(0, 1000);
  if (text.Has("finger_friction")) {
    start.finger_friction = text["finger_friction"].PositiveNumber();
    if (*start.finger_friction > kLargestFriction) text["finger_friction"].Fail("is too large");
  }
  return start;
}

}  // namespace

std::string StartText(const StartState& start) {
  Json text;
  text["variant"] = start.variant;
  for (const Eigen::Isometry3d& root : start.state.roots) text["roots"].push_back(PoseJson(root));
  text["joints"] = start.state.joints;
  text["goal"] = {start.state.goal.x(), start.state.goal.y(), start.state.goal.z()};
  text["arm"] = List(start.arm);
  text["at_work"] = List(start.grasp_configuration);
  text["leader"] = start.leader;
  if (start.closed_to) text["closed_to"] = *start.closed_to;
  text["pitch"] = start.pitch;
  if (start.grasp >= 0) text["grasp"] = start.grasp;
  if (!start.retreat.isZero()) {
    text["withdraw"] = {start.retreat.x(), start.retreat.y(), start.retreat.z()};
  }
  for (const robot::JointVector& configuration : start.waypoints)
    text["via"].push_back(List(configuration));
  text["held"] = start.held;
  text["mass"] = start.mass;
  text["friction"] = start.friction;
  text["joint"] = start.joint;
  text["delay"] = start.delay;
  if (start.finger_friction) text["finger_friction"] = *start.finger_friction;
  return core::JsonLine(text);
}

StartState ParseStart(std::string_view text, const Skill& skill, const std::string& where) {
  const core::JsonDocument document(text, where, kStartRemedy);
  return StartFrom(document.root(), skill);
}

void WriteStarts(const std::vector<StartState>& starts, const std::filesystem::path& file) {
  std::string text;
  for (const StartState& start : starts) text += StartText(start) + "\n";
  core::WriteFile(file, text);
}

std::vector<StartState> ReadStarts(const std::filesystem::path& file, const Skill& skill) {
  const std::string text = core::ReadFile(file, 1ull << 30);
  std::vector<StartState> starts;
  size_t begin = 0;
  while (begin < text.size() && starts.size() < kMostStarts) {
    const size_t end = std::min(text.find('\n', begin), text.size());
    starts.push_back(ParseStart(std::string_view(text).substr(begin, end - begin), skill,
                                file.string() + ":" + std::to_string(starts.size() + 1)));
    begin = end + 1;
  }
  return starts;
}

}  // namespace simwright::skills
