#pragma once

#include <string>
#include <vector>

#include "core/random.h"
#include "render/camera_spec.h"
#include "render/rigid_scene.h"

namespace simwright::render {

// A range of values, uniformly sampled.
struct ValueRange {
  double low = 0.0, high = 0.0;
};

// The ranges of a randomised look. All are off by default: each share is a probability in [0, 1],
// each amount a half range around the look that is not randomised.
struct LookRanges {
  // Materials of each object, of the robot and of the gripper.
  double object_color = 0.0;    // share of objects whose untextured triangles get a random colour
  double robot_color = 0.0;     // the same for the robot, and for the gripper
  double tint = 0.0;            // amount per channel, [0, 1): factors of the albedo of all parts
  double object_pattern = 0.0;  // share of objects with a random pattern over their surface
  // Floor and background.
  double floor_color = 0.0;    // share of episodes with a random colour of the floor
  double floor_pattern = 0.0;  // share with a random pattern on the floor
  double walls = 0.0;          // share with four walls of random distance, colour and pattern
  double background = 0.0;     // share with a random colour where nothing is hit
  // Light.
  double light_angle = 0.0;                // amount, rad: turns the key light
  double light_color = 0.0;                // amount per channel, [0, 1)
  ValueRange light_strength = {1.0, 1.0};  // factor of all light, > 0
  ValueRange shadow = {0.0, 0.0};          // share of light lost in hard shadows, within [0, 1]
  // Cameras, each about its own frame.
  double camera_position = 0.0;  // amount per axis, m
  double camera_angle = 0.0;     // amount per axis, rad
  double camera_fov = 0.0;       // amount, a share of the focal length, [0, 0.9]

  // Returns false, with a line that names the value, if one is not finite or outside its range.
  bool IsValid(std::string* error) const;

  // Returns ranges for training policies that are to work under other looks.
  static LookRanges Wide();
};

// The look of one episode or scene.
struct SceneLook {
  std::vector<SurfaceLook> objects;  // by object
  SurfaceLook robot, gripper;
  Backdrop backdrop;
  SceneLight light;
  std::vector<CameraSpec> cameras;
};

// Returns the look of `object_count` objects around `base`, whose cameras, backdrop and light are
// not randomised: a pure function of its arguments. Cameras do not depend on the number of objects,
// nor one part of the look on the ranges of another.
SceneLook SampleLook(const LookRanges& ranges, const SceneLook& base, int object_count,
                     std::uint64_t seed);

}  // namespace simwright::render
