#include "manipulation/link_pose.h"

namespace simwright::manipulation {

Eigen::Isometry3d WorldFromLink(const tasks::WorldModel& model, const tasks::WorldState& state,
                                int object, int link) {
  const auto t = static_cast<size_t>(object);
  return state.roots[t] *
         tasks::LinkPosesOf(model.objects[t], state.joints[t])[static_cast<size_t>(link)];
}

}  // namespace simwright::manipulation
