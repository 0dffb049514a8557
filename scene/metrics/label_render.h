#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "core/camera.h"
#include "core/image.h"
#include "scene/dataset/vocabulary.h"
#include "scene/grammar/scene_draw.h"
#include "scene/palette.h"

namespace simwright::scene {

inline constexpr int kLabelWidth = 640, kLabelHeight = 480;  // pixels
// More classes than any vocabulary of ours has; of more, colours would be hard to tell apart.
inline constexpr int kMostLabels = 48;

// Red, green and blue (0 .. 255) of class `index`, 0 .. kMostLabels - 1, whatever the scene type:
// each the farthest in CIELAB from white and all before it, of six levels a channel. Throws
// core::Error for another index.
std::array<std::uint8_t, 3> LabelColour(int index);

// The one camera from which scenes of a type are compared, 640 x 480 (Pfaff et al., appendix, whose
// tables have their top and whose shelves their middle at the origin): breakfast from 1.5 m and
// dimsum from 1.7 m above the table's top, restaurants from 13 m above the floor, all three
// straight down, 45 degrees high, the world's y to the right; shelves from 1.2 m in front of their
// middle, 0.1 m above it, 55 degrees high, so that all of them is seen. Throws core::Error for an
// unknown type.
core::Camera LabelCamera(const std::string& type);

// The scene as a camera sees it, RGB, each object in its class's colour without light, furniture
// included, on white; nothing is a white picture. Throws core::Error for a slot without an asset or
// without a class, or for more classes than there are colours.
core::Image LabelRender(const std::vector<DrawnObject>& objects, const Vocabulary& vocabulary,
                        const Palette& palette, const core::Camera& camera);

}  // namespace simwright::scene
