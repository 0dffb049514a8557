#pragma once

#include <vector>

#include "core/camera.h"
#include "core/image.h"
#include "scene/grammar/scene_draw.h"
#include "scene/palette.h"

namespace simwright::scene {

// Renders a scene from a camera, RGBA, with a transparent background. Throws core::Error for a
// category without an asset, or a scene without objects.
core::Image ScenePicture(const std::vector<DrawnObject>& objects, const Palette& palette,
                         const core::Camera& camera);

// Renders the whole scene from the side, 35 degrees above the horizontal. `size`: pixels per side.
core::Image SceneFromTheSide(const std::vector<DrawnObject>& objects, const Palette& palette,
                             int size);

// Renders the whole scene from straight above, from so far that the projection is almost
// orthographic: x to the right, y upwards.
core::Image SceneFromAbove(const std::vector<DrawnObject>& objects, const Palette& palette,
                           int size);

}  // namespace simwright::scene
