#include "viewer/contents/drop_replay.h"

#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "core/progress.h"
#include "sim/world.h"

namespace simwright::viewer {
namespace {

constexpr double kRestSeconds = 0.2;
constexpr float kRestTurn = 2e-6f;   // 1 - |cos| of half an angle of 4 mrad
constexpr double kFloorBound = 1.0;  // m, height of the floor's AABB: a body falls less in a step

sim::WorldOptions OptionsOf(const DropOptions& options) {
  sim::WorldOptions world;
  world.time_step = options.time_step;
  world.full_warm_start = true;
  world.floor_reach = kFloorBound;
  return world;
}

// Returns true if no position in the last row differs by `tolerance` (m) or more from the row of
// `frames` frames before.
bool IsAtRest(const Timeline& timeline, int frames, double tolerance) {
  const auto width = static_cast<std::size_t>(timeline.width);
  const float* const now = timeline.rows.data() + timeline.rows.size() - width;
  const float* const before = now - width * static_cast<std::size_t>(frames);
  for (std::size_t at = 0; at < width; at += 7) {
    const Eigen::Map<const Eigen::Vector3f> a(now + at), b(before + at);
    const Eigen::Map<const Eigen::Vector4f> p(now + at + 3), q(before + at + 3);
    if ((a - b).norm() >= tolerance) return false;
    if (1.0f - std::abs(p.dot(q)) >= kRestTurn) return false;
  }
  return true;
}

}  // namespace

bool DropOptions::IsValid(std::string* error) const {
  if (!(height >= 0.0 && height <= 10.0)) {
    *error = "the height of a drop must be from 0 to 10 m";
  } else if (!(seconds > 0.0 && seconds <= 60.0)) {
    *error = "a drop must last from 0 to 60 s";
  } else if (!(time_step > 0.0 && time_step <= 0.01)) {
    *error = "the time step of a drop must be from 0 to 0.01 s";
  } else if (!(rest_tolerance >= 0.0)) {
    *error = "the rest tolerance of a drop must not be negative";
  } else if (steps_per_frame < 1) {
    *error = "a frame of a drop must have at least one step";
  } else {
    return true;
  }
  return false;
}

Timeline DropReplay(const std::vector<DroppedBody>& bodies, const DropOptions& options) {
  std::string fault;
  if (!options.IsValid(&fault)) throw core::Error(fault);
  sim::World world(OptionsOf(options));
  Timeline timeline;
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
  const int rest_frames = std::max(1, static_cast<int>(std::lround(kRestSeconds * timeline.rate)));
  for (int frame = 0; frame <= frames; ++frame) {
    for (const int index : indices) AppendPose(world.Pose(index), &timeline.rows);
    core::CheckCancelled();
    if (frame > 2 * rest_frames && IsAtRest(timeline, rest_frames, options.rest_tolerance)) break;
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
  timeline.facts = {{"dropped by", Quantity(1000.0 * options.height, "mm")},
                    {"farthest from its place", bodies[worst].name},
                    {"distance at the end", Quantity(1000.0 * farthest, "mm", 3)}};
  return timeline;
}

core::OrderedJson DropOffer() {
  return {{"title", "Drop"}, {"waiting", "Simulating the drop in Bullet"}};
}

}  // namespace simwright::viewer
