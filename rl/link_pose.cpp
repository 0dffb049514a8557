#include "rl/link_pose.h"

namespace simwright::rl {

Eigen::Isometry3d WorldFromLink(const tasks::SceneModel& model, const tasks::SceneState& state,
                                int thing, int link) {
  const auto t = static_cast<size_t>(thing);
  return state.roots[t] *
         tasks::LinkPosesOf(model.things[t], state.joints[t])[static_cast<size_t>(link)];
}

}  // namespace simwright::rl
