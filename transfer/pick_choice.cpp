#include "transfer/pick_choice.h"

#include <algorithm>
#include <utility>

#include "robot/panda_model.h"

namespace simwright::transfer {
namespace {

constexpr double kLeastError = 1e-4;  // m: smaller errors make no difference

}  // namespace

double GripRoom(const workflows::TwinObject& object) {
  const double opening = robot::Panda(false).gripper.MaxOpening();
  const double room = 0.5 * (opening - object.size.head<2>().minCoeff());
  return room / std::max(kLeastError, object.position_error);
}

std::vector<std::string> SurestPicks(const tasks::TaskSet& set,
                                     const workflows::TwinRecord& record) {
  std::vector<std::pair<double, std::string>> picks;
  for (const tasks::Task& task : set.tasks) {
    if (!task.name.starts_with("pick_up_") || task.subtasks.size() != 1) continue;
    for (const workflows::TwinObject& object : record.objects) {
      if (object.name != task.assets.front()) continue;
      picks.emplace_back(-GripRoom(object), task.name);
    }
  }
  std::sort(picks.begin(), picks.end());
  std::vector<std::string> names;
  for (auto& [room, name] : picks) names.push_back(std::move(name));
  return names;
}

}  // namespace simwright::transfer
