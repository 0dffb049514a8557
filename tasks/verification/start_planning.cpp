#include "tasks/verification/start_planning.h"

#include <algorithm>
#include <cctype>
#include <set>

#include "tasks/layout.h"

namespace simwright::tasks {
namespace {

constexpr std::size_t kMaxObjects = 8;
constexpr double kGoalAside = 0.12;  // m
constexpr double kGoalAbove = 0.15;  // m

std::string Lower(const std::string& text) {
  std::string lower = text;
  for (char& c : lower) {
    c = c == '_' || c == '-' ? ' ' : static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  }
  return lower;
}

// Returns the joints whose state the program reads; if there are none, the joints that move the
// links it reads.
std::set<std::pair<int, int>> JointsRead(const WorldModel& model,
                                         const std::vector<reward::RewardSlot>& slots) {
  std::set<std::pair<int, int>> states, above;
  for (const reward::RewardSlot& slot : slots) {
    const int object = model.Find(slot.asset);
    if (object < 0 || slot.part.empty()) continue;
    const ArticulatedObject& known = model.objects[static_cast<std::size_t>(object)];
    const int joint = known.FindJoint(slot.part);
    if (joint >= 0) states.insert({object, joint});
    for (int at = known.FindLink(slot.part); at > 0; at = known.kinematics->ParentLink(at)) {
      const int moved_by = known.links[static_cast<std::size_t>(at)].joint;
      if (moved_by >= 0) above.insert({object, moved_by});
    }
  }
  return states.empty() ? above : states;
}

// Returns the object that the title takes `object` out of: the microwave in "take the cup out of
// the microwave". -1: none.
int TakenOutOf(const WorldModel& model, const std::string& title, int object) {
  for (const char* words : {"out of ", "from inside ", "from "}) {
    const std::size_t at = title.find(words);
    if (at == std::string::npos) continue;
    const std::string rest = title.substr(at);
    for (std::size_t other = 0; other < model.objects.size(); ++other) {
      const ArticulatedObject& known = model.objects[other];
      if (static_cast<int>(other) == object || known.receptacles.empty()) continue;
      const bool named =
          rest.find(Lower(known.name)) != std::string::npos ||
          (!known.category.empty() && rest.find(Lower(known.category)) != std::string::npos);
      if (named) return static_cast<int>(other);
    }
  }
  return -1;
}

}  // namespace

std::optional<InitialState> PlanStart(const WorldModel& model,
                                      const std::vector<reward::RewardSlot>& slots,
                                      const std::vector<std::string>& assets,
                                      const std::string& title, TitleDirection direction,
                                      core::Rng& rng) {
  LayoutRequest request;
  const auto want = [&](const std::string& name) {
    const int object = model.Find(name);
    const bool known =
        std::find(request.objects.begin(), request.objects.end(), object) != request.objects.end();
    if (object >= 0 && !known && request.objects.size() < kMaxObjects)
      request.objects.push_back(object);
  };
  for (const reward::RewardSlot& slot : slots) want(slot.asset);
  for (const std::string& asset : assets) want(asset);
  for (const auto& [object, joint] : JointsRead(model, slots)) {
    request.operated.emplace_back(object, joint);
    const ArticulatedObject& known = model.objects[static_cast<std::size_t>(object)];
    const ObjectJoint& moved = known.joints[static_cast<std::size_t>(joint)];
    if (direction == TitleDirection::kBack) {
      request.joints.push_back({known.name, moved.name, moved.joint_target()});
    }
  }
  const std::string text = Lower(title);
  for (int object : request.objects) {
    if (model.objects[static_cast<std::size_t>(object)].articulated()) continue;
    const int holder = TakenOutOf(model, text, object);
    const bool placed =
        std::find(request.objects.begin(), request.objects.end(), holder) != request.objects.end();
    if (placed) request.supports.push_back({object, holder, 0});
  }
  return PlanLayout(model, request, rng);
}

Eigen::Vector3d PlanGoal(const WorldModel& model, const WorldState& start,
                         const std::vector<reward::RewardSlot>& slots) {
  for (const reward::RewardSlot& slot : slots) {
    const int object = model.Find(slot.asset);
    if (object < 0 || model.objects[static_cast<std::size_t>(object)].articulated()) continue;
    return WorldAabb(model, start, object).center() + Eigen::Vector3d(0, kGoalAside, kGoalAbove);
  }
  for (const auto& [object, joint] : JointsRead(model, slots)) {
    const auto t = static_cast<std::size_t>(object), j = static_cast<std::size_t>(joint);
    WorldState end = start;
    end.joints[t][j] = model.objects[t].joints[j].far();
    return LinkPosition(model, end, object, model.objects[t].joints[j].grasp_link);
  }
  return start.gripper.translation() + Eigen::Vector3d(0, kGoalAside, 0);
}

InitialState StartOfNextSubtask(const WorldModel& model, const WorldState& state,
                                const InitialState& before) {
  InitialState start;
  start.world_from_robot = before.world_from_robot;
  for (const AssetPlacement& placement : before.placements) {
    const auto object = static_cast<std::size_t>(model.Find(placement.asset));
    start.placements.push_back({placement.asset, state.roots[object], placement.fixed});
    const ArticulatedObject& known = model.objects[object];
    for (std::size_t j = 0; j < known.joints.size(); ++j) {
      if (state.joints[object][j] == known.joints[j].rest()) continue;
      start.joints.push_back({known.name, known.joints[j].name, state.joints[object][j]});
    }
  }
  if (state.grasped && state.touched >= 0 &&
      !model.objects[static_cast<std::size_t>(state.touched)].articulated()) {
    start.held = model.objects[static_cast<std::size_t>(state.touched)].name;
  }
  return start;
}

}  // namespace simwright::tasks
