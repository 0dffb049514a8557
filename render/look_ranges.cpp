#include "render/look_ranges.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <sstream>

namespace simwright::render {
namespace {

using Eigen::Vector3f;

// The streams of SampleLook: each part of a look has its own generator.
enum LookStream : std::uint64_t {
  kFloorStream,
  kWallStream,
  kLightStream,
  kBackgroundStream,
  kRobotStream,
  kCameraStream = 1000,
  kObjectStream = 1000000,
};

const Vector3f kKeyDirection = Vector3f(0.4f, -0.5f, 0.75f).normalized();

float Within(core::Rng& rng, double low, double high) {
  return static_cast<float>(core::Uniform(rng, low, high));
}

// Samples an sRGB colour of any hue, neither black nor white.
Vector3f AnyColor(core::Rng& rng) {
  const Vector3f color(Within(rng, 0.0, 1.0), Within(rng, 0.0, 1.0), Within(rng, 0.0, 1.0));
  const float grey = color.mean(), saturation = Within(rng, 0.2, 1.0);
  return (0.08f + 0.84f * (grey + saturation * (color.array() - grey))).matrix();
}

Vector3f Factors(core::Rng& rng, double amount) {
  return {Within(rng, 1.0 - amount, 1.0 + amount), Within(rng, 1.0 - amount, 1.0 + amount),
          Within(rng, 1.0 - amount, 1.0 + amount)};
}

void SamplePattern(core::Rng& rng, double low_size, double high_size, SurfaceLook* look) {
  constexpr Pattern kPatterns[] = {Pattern::kChecker, Pattern::kStripes, Pattern::kNoise,
                                   Pattern::kPlanks};
  look->pattern = kPatterns[core::UniformIndex(rng, 4)];
  look->pattern_color = AnyColor(rng);
  look->pattern_size = Within(rng, low_size, high_size);
  look->pattern_strength = Within(rng, 0.3, 1.0);
  look->pattern_seed = static_cast<std::uint32_t>(rng());
}

// Samples the look of a part; the same draws are made whatever the ranges are.
SurfaceLook SamplePart(core::Rng& rng, double color, double tint, double pattern,
                       const SurfaceLook& base) {
  SurfaceLook look = base;
  const bool colored = core::Uniform(rng) < color;
  const Vector3f drawn = AnyColor(rng);
  if (colored) look.color = drawn;
  look.tint = look.tint.cwiseProduct(Factors(rng, tint));
  if (core::Uniform(rng) < pattern) SamplePattern(rng, 0.01, 0.08, &look);
  return look;
}

void SampleBackdrop(const LookRanges& ranges, std::uint64_t seed, Backdrop* backdrop) {
  core::Rng floor = core::StreamRng(seed, kFloorStream);
  backdrop->floor_look = SamplePart(floor, ranges.floor_color, 0.0, 0.0, backdrop->floor_look);
  if (core::Uniform(floor) < ranges.floor_pattern) {
    SamplePattern(floor, 0.05, 0.5, &backdrop->floor_look);
  }
  core::Rng walls = core::StreamRng(seed, kWallStream);
  if (core::Uniform(walls) < ranges.walls) {
    backdrop->walls = true;
    const auto side = [&] { return Within(walls, 1.8, 4.0); };
    const Eigen::Vector2f low(-side(), -side()), high(side(), side());
    backdrop->wall_range = Eigen::AlignedBox2f(low, high);
    backdrop->wall_look = SurfaceLook();
    backdrop->wall_look.color = AnyColor(walls);
    if (core::Uniform(walls) < 0.5) SamplePattern(walls, 0.1, 0.6, &backdrop->wall_look);
  }
  core::Rng background = core::StreamRng(seed, kBackgroundStream);
  if (core::Uniform(background) < ranges.background) backdrop->background = AnyColor(background);
}

// Replaces the light where a range is on.
void SampleLight(const LookRanges& ranges, std::uint64_t seed, SceneLight* light) {
  core::Rng rng = core::StreamRng(seed, kLightStream);
  const auto angle = static_cast<float>(ranges.light_angle * std::sqrt(core::Uniform(rng)));
  const Vector3f axis = core::UniformDirection(rng).cast<float>();
  const Vector3f factors = Factors(rng, ranges.light_color);
  const float strength = Within(rng, ranges.light_strength.low, ranges.light_strength.high);
  light->shadow = std::max(light->shadow, Within(rng, ranges.shadow.low, ranges.shadow.high));
  if (ranges.light_angle > 0.0) {
    const Vector3f across = kKeyDirection.cross(axis).normalized();
    Vector3f key = Eigen::AngleAxisf(angle, across) * kKeyDirection;
    key.z() = std::max(key.z(), 0.15f);  // from above
    light->shadow_direction = key.normalized();
    light->ambient = SphericalHarmonicsLight::Studio(light->shadow_direction);
  }
  for (int c = 0; c < 3; ++c) light->ambient.radiance.col(c) *= strength * factors[c];
}

void SampleCamera(const LookRanges& ranges, std::uint64_t seed, std::size_t index,
                  CameraSpec* camera) {
  core::Rng rng = core::StreamRng(seed, kCameraStream + index);
  Eigen::Vector3d shift, turn;
  for (int i = 0; i < 3; ++i) shift[i] = core::Uniform(rng, -1.0, 1.0) * ranges.camera_position;
  for (int i = 0; i < 3; ++i) turn[i] = core::Uniform(rng, -1.0, 1.0) * ranges.camera_angle;
  const double zoom = 1.0 + core::Uniform(rng, -1.0, 1.0) * ranges.camera_fov;
  Eigen::Isometry3d change = Eigen::Isometry3d::Identity();
  change.translation() = shift;
  if (turn.norm() > 0.0) change.rotate(Eigen::AngleAxisd(turn.norm(), turn.normalized()));
  camera->mount_from_camera = camera->mount_from_camera * change;
  if (camera->intrinsics) {
    camera->intrinsics->fx *= zoom;
    camera->intrinsics->fy *= zoom;
  } else {
    camera->vertical_fov = 2.0 * std::atan(std::tan(0.5 * camera->vertical_fov) / zoom);
  }
}

bool RefuseRange(std::string* error, const char* name, double value, const std::string& range) {
  if (error != nullptr) {
    std::ostringstream line;
    line << name << " is " << value << ", but must be " << range;
    *error = line.str();
  }
  return false;
}

struct NamedValue {
  const char* name;
  double value;
};

}  // namespace

bool LookRanges::IsValid(std::string* error) const {
  for (const NamedValue& share :
       {NamedValue{"object_color", object_color}, NamedValue{"robot_color", robot_color},
        NamedValue{"object_pattern", object_pattern}, NamedValue{"floor_color", floor_color},
        NamedValue{"floor_pattern", floor_pattern}, NamedValue{"walls", walls},
        NamedValue{"background", background}, NamedValue{"shadow.low", shadow.low},
        NamedValue{"shadow.high", shadow.high}}) {
    if (share.value >= 0.0 && share.value <= 1.0) continue;
    return RefuseRange(error, share.name, share.value, "from 0 to 1");
  }
  for (const NamedValue& amount : {NamedValue{"tint", tint}, NamedValue{"light_color", light_color},
                                   NamedValue{"camera_fov", camera_fov}}) {
    if (amount.value >= 0.0 && amount.value <= 0.9) continue;
    return RefuseRange(error, amount.name, amount.value, "from 0 to 0.9");
  }
  for (const NamedValue& angle :
       {NamedValue{"light_angle", light_angle}, NamedValue{"camera_angle", camera_angle}}) {
    if (angle.value >= 0.0 && angle.value <= std::numbers::pi) continue;
    return RefuseRange(error, angle.name, angle.value, "from 0 to pi (rad)");
  }
  if (!(camera_position >= 0.0 && camera_position <= 10.0)) {
    return RefuseRange(error, "camera_position", camera_position, "from 0 to 10 (m)");
  }
  if (!(light_strength.low > 0.0 && light_strength.low <= 10.0)) {
    return RefuseRange(error, "light_strength.low", light_strength.low, "above 0, at most 10");
  }
  if (!(light_strength.high >= light_strength.low && light_strength.high <= 10.0)) {
    return RefuseRange(error, "light_strength.high", light_strength.high,
                       "at least light_strength.low, at most 10");
  }
  if (shadow.high < shadow.low) {
    return RefuseRange(error, "shadow.high", shadow.high, "at least shadow.low");
  }
  return true;
}

LookRanges LookRanges::Wide() {
  LookRanges ranges;
  ranges.object_color = ranges.robot_color = 0.5;
  ranges.tint = 0.3;
  ranges.object_pattern = 0.3;
  ranges.floor_color = 0.8;
  ranges.floor_pattern = 0.6;
  ranges.walls = 0.5;
  ranges.background = 0.8;
  ranges.light_angle = 1.0;
  ranges.light_color = 0.15;
  ranges.light_strength = {0.7, 1.3};
  ranges.shadow = {0.0, 0.6};
  ranges.camera_position = 0.02;
  ranges.camera_angle = 0.05;
  ranges.camera_fov = 0.05;
  return ranges;
}

SceneLook SampleLook(const LookRanges& ranges, const SceneLook& base, int object_count,
                     std::uint64_t seed) {
  SceneLook look = base;
  look.objects.resize(static_cast<std::size_t>(object_count));
  for (std::size_t i = 0; i < look.objects.size(); ++i) {
    core::Rng rng = core::StreamRng(seed, kObjectStream + i);
    look.objects[i] =
        SamplePart(rng, ranges.object_color, ranges.tint, ranges.object_pattern, look.objects[i]);
  }
  core::Rng robot = core::StreamRng(seed, kRobotStream);
  look.robot = SamplePart(robot, ranges.robot_color, ranges.tint, 0.0, look.robot);
  look.gripper = SamplePart(robot, ranges.robot_color, ranges.tint, 0.0, look.gripper);
  SampleBackdrop(ranges, seed, &look.backdrop);
  SampleLight(ranges, seed, &look.light);
  for (std::size_t i = 0; i < look.cameras.size(); ++i) {
    SampleCamera(ranges, seed, i, &look.cameras[i]);
  }
  return look;
}

}  // namespace simwright::render
