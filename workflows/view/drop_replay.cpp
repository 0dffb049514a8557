#include "workflows/view/drop_replay.h"

#include <cmath>

#include "core/error.h"
#include "core/progress.h"
#include "sim/world.h"

namespace simwright::workflows {
namespace {

constexpr double kFloorBound = 1.0;  // m, height of the floor's AABB: a body falls less in a step

sim::WorldOptions OptionsOf(const DropOptions& options) {
  sim::WorldOptions world;
  world.time_step = options.time_step;
  world.full_warm_start = true;
  world.floor_reach = kFloorBound;
  return world;
}

}  // namespace

bool DropOptions::IsValid(std::string* error) const {
  if (!(height >= 0.0 && height <= 10.0)) {
    *error = "the height of a drop must be from 0 to 10 m";
  } else if (!(seconds > 0.0 && seconds <= 60.0)) {
    *error = "a drop must last from 0 to 60 s";
  } else if (!(time_step > 0.0 && time_step <= 0.01)) {
    *error = "the time step of a drop must be from 0 to 0.01 s";
  } else if (steps_per_frame < 1) {
    *error = "a frame of a drop must have at least one step";
  } else {
    return true;
  }
  return false;
}

viewer::Timeline DropReplay(const std::vector<DroppedBody>& bodies, const DropOptions& options) {
  std::string fault;
  if (!options.IsValid(&fault)) throw core::Error(fault);
  sim::World world(OptionsOf(options));
  viewer::Timeline timeline;
  timeline.name = "drop";
  timeline.rate = 1.0 / (options.time_step * options.steps_per_frame);
  std::vector<std::size_t> free;  // indices into `bodies`
  std::vector<int> indices;       // in the world
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    const DroppedBody& body = bodies[i];
    if (body.fixed) {
      world.AddFixed(*body.body, body.world_from_body);
      continue;
    }
    Eigen::Isometry3d raised = body.world_from_body;
    raised.translation().z() += options.height;
    indices.push_back(world.Add(*body.body, raised));
    timeline.tracks.push_back({static_cast<int>(i), timeline.width, {}, 0});
    timeline.width += 7;
    free.push_back(i);
  }
  if (free.empty()) throw core::Error("there is no free object to drop");
  const auto frames =
      static_cast<int>(std::lround(options.seconds / options.time_step)) / options.steps_per_frame;
  for (int frame = 0; frame <= frames; ++frame) {
    for (const int index : indices) viewer::AppendPose(world.Pose(index), &timeline.rows);
    core::CheckCancelled();
    for (int step = 0; step < options.steps_per_frame; ++step) world.Step();
  }
  double farthest = -1.0;
  std::size_t worst = 0;
  for (std::size_t i = 0; i < free.size(); ++i) {
    const double moved =
        (world.Pose(indices[i]).translation() - bodies[free[i]].world_from_body.translation())
            .norm();
    if (moved <= farthest) continue;
    farthest = moved;
    worst = free[i];
  }
  timeline.facts = {{"dropped by", viewer::Quantity(1000.0 * options.height, "mm")},
                    {"farthest from its place", bodies[worst].name},
                    {"distance at the end", viewer::Quantity(1000.0 * farthest, "mm", 3)}};
  return timeline;
}

core::OrderedJson DropOffer() {
  return {{"title", "Drop"}, {"waiting", "Simulating the drop in Bullet"}};
}

}  // namespace simwright::workflows
