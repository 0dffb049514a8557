#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "core/camera.h"
#include "core/image.h"
#include "scene/asset_set/asset_set.h"
#include "scene/dataset/vocabulary.h"
#include "scene/grammar/scene_sample.h"

namespace simwright::scene {

inline constexpr int kLabelWidth = 640, kLabelHeight = 480;  // pixels
// The largest number of classes: more than any of our vocabularies has; the colours of more would
// be hard to distinguish.
inline constexpr int kMaxLabels = 48;

// Returns red, green and blue (0 .. 255) of class `index`, 0 .. kMaxLabels - 1, for any scene
// type: each colour, of six levels per channel, is the farthest in CIELAB from white and all
// previous ones. Throws core::Error for another index.
std::array<std::uint8_t, 3> LabelColour(int index);

// Returns the camera for comparing scenes of a type, 640 x 480 (Pfaff et al., appendix, who put the
// origin at the table's top or the shelf's middle): breakfast from 1.5 m and dimsum from 1.7 m
// above the table top, restaurants from 13 m above the floor, all three straight down with a
// vertical field of view of 45 degrees and the world's y to the right; shelves from 1.2 m in front
// of their middle, 0.1 m above it, with 55 degrees, so that the whole shelf is visible. Throws
// core::Error for an unknown type.
core::Camera LabelCamera(const std::string& type);

// Returns an RGB render of the scene, each object in the unlit colour of its class, furniture
// included, on white; an empty scene gives a white image. Throws core::Error for a category without
// an asset or a class, or for more classes than colours.
core::Image LabelRender(const std::vector<SceneObject>& objects, const Vocabulary& vocabulary,
                        const AssetSet& asset_set, const core::Camera& camera);

}  // namespace simwright::scene
