#include "skills/start_pool.h"

#include <cmath>

#include <nlohmann/json.hpp>

#include "core/error.h"
#include "core/files.h"

namespace simwright::skills {
namespace {

using nlohmann::json;

constexpr size_t kMostStarts = 100000;
constexpr size_t kMostWaypoints = 16;
constexpr double kLongestRetreat = 10.0;    // m
constexpr double kLargestFriction = 100.0;  // coefficient of friction

json PoseJson(const Eigen::Isometry3d& pose) {
  json numbers = json::array();
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 4; ++column) numbers.push_back(pose.matrix()(row, column));
  }
  return numbers;
}

std::vector<double> Numbers(const json& list, size_t count) {
  const auto numbers = list.get<std::vector<double>>();
  if (numbers.size() != count) throw std::invalid_argument("a list of another length");
  for (const double number : numbers) {
    if (!std::isfinite(number)) throw std::invalid_argument("a number that is not finite");
  }
  return numbers;
}

std::vector<double> Factors(const json& list, size_t count) {
  std::vector<double> factors = Numbers(list, count);
  for (const double factor : factors) {
    if (!(factor > 0.0)) throw std::invalid_argument("a factor that is not positive");
  }
  return factors;
}

Eigen::Isometry3d PoseFrom(const json& list) {
  const std::vector<double> numbers = Numbers(list, 12);
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 4; ++column) {
      pose.matrix()(row, column) = numbers[static_cast<size_t>(4 * row + column)];
    }
  }
  const Eigen::Matrix3d rotation = pose.linear();
  if (!(rotation.transpose() * rotation).isIdentity(1e-6)) {
    throw std::invalid_argument("an invalid rotation");
  }
  return pose;
}

std::vector<double> List(const robot::JointVector& configuration) {
  return {configuration.data(), configuration.data() + configuration.size()};
}

robot::JointVector ConfigurationFrom(const json& list, int size) {
  const std::vector<double> numbers = Numbers(list, static_cast<size_t>(size));
  return Eigen::Map<const Eigen::VectorXd>(numbers.data(), size);
}

StartState StartFrom(const json& text, const Skill& skill) {
  StartState start;
  start.variant = text.at("variant").get<int>();
  if (start.variant < 0 || start.variant >= static_cast<int>(skill.variants.size())) {
    throw std::invalid_argument("a variant that the skill does not have");
  }
  const SkillVariant& variant = skill.variants[static_cast<size_t>(start.variant)];
  const size_t objects = variant.model.objects.size();
  start.state = variant.start;
  const json& roots = text.at("roots");
  const json& joints = text.at("joints");
  if (roots.size() != objects || joints.size() != objects) {
    throw std::invalid_argument("another number of objects");
  }
  for (size_t i = 0; i < objects; ++i) {
    start.state.roots[i] = PoseFrom(roots[i]);
    start.state.joints[i] = Numbers(joints[i], variant.model.objects[i].joints.size());
  }
  const std::vector<double> goal = Numbers(text.at("goal"), 3);
  start.state.goal = Eigen::Vector3d(goal[0], goal[1], goal[2]);
  start.arm = ConfigurationFrom(text.at("arm"), skill.robot->arm.size());
  start.grasp_configuration = ConfigurationFrom(text.at("at_work"), skill.robot->arm.size());
  start.leader = text.at("leader").get<double>();
  if (text.contains("closed_to")) start.closed_to = text["closed_to"].get<double>();
  start.pitch = text.at("pitch").get<double>();
  if (text.contains("withdraw")) {
    const std::vector<double> displacement = Numbers(text["withdraw"], 3);
    start.retreat = Eigen::Vector3d(displacement[0], displacement[1], displacement[2]);
    if (start.retreat.norm() > kLongestRetreat) {
      throw std::invalid_argument("a retreat that is too long");
    }
  }
  if (text.contains("via")) {
    const json& waypoints = text["via"];
    if (!waypoints.is_array() || waypoints.size() > kMostWaypoints) {
      throw std::invalid_argument("invalid or too many waypoints");
    }
    for (const json& configuration : waypoints) {
      start.waypoints.push_back(ConfigurationFrom(configuration, skill.robot->arm.size()));
    }
  }
  start.held = text.at("held").get<int>();
  if (start.held < -1 || start.held >= static_cast<int>(objects) ||
      (start.held >= 0 && variant.fixed[static_cast<size_t>(start.held)])) {
    throw std::invalid_argument("an object in the gripper that cannot be grasped");
  }
  start.mass = Factors(text.at("mass"), objects);
  start.friction = Factors(text.at("friction"), objects);
  start.joint = Factors(text.at("joint"), objects);
  start.delay = text.at("delay").get<int>();
  if (start.delay < 0 || start.delay > 1000 ||
      !std::isfinite(start.leader + start.pitch + start.closed_to.value_or(0.0))) {
    throw std::invalid_argument("an invalid delay or position");
  }
  if (text.contains("finger_friction")) {
    start.finger_friction = text["finger_friction"].get<double>();
    if (!(*start.finger_friction > 0.0) || *start.finger_friction > kLargestFriction) {
      throw std::invalid_argument("an invalid finger friction");
    }
  }
  return start;
}

}  // namespace

std::string StartText(const StartState& start) {
  json text;
  text["variant"] = start.variant;
  for (const Eigen::Isometry3d& root : start.state.roots) text["roots"].push_back(PoseJson(root));
  text["joints"] = start.state.joints;
  text["goal"] = {start.state.goal.x(), start.state.goal.y(), start.state.goal.z()};
  text["arm"] = List(start.arm);
  text["at_work"] = List(start.grasp_configuration);
  text["leader"] = start.leader;
  if (start.closed_to) text["closed_to"] = *start.closed_to;
  text["pitch"] = start.pitch;
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
  return text.dump();
}

StartState ParseStart(std::string_view text, const Skill& skill, const std::string& where) {
  try {
    return StartFrom(json::parse(text), skill);
  } catch (const json::exception&) {
    throw core::Error("is not a start state", where, "let the training write it again");
  } catch (const std::invalid_argument& error) {
    throw core::Error(std::string("the start state has ") + error.what(), where,
                      "let the training write it again");
  }
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
