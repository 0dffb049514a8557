#pragma once

#include <vector>

#include "core/camera.h"
#include "core/image.h"
#include "scene/grammar/scene_draw.h"
#include "scene/palette.h"

namespace simwright::scene {

// What a camera sees of a scene, RGBA, see-through where nothing is. Throws core::Error for a slot
// without an asset, or a scene without objects.
core::Image ScenePicture(const std::vector<DrawnObject>& objects, const Palette& palette,
                         const core::Camera& camera);

// The same from a side and above (35 degrees), so that all of it is seen. `size`: pixels a side.
core::Image SceneFromTheSide(const std::vector<DrawnObject>& objects, const Palette& palette,
                             int size);

// The same straight from above, from so far that lines of sight are all but parallel: x to the
// right, y upwards.
core::Image SceneFromAbove(const std::vector<DrawnObject>& objects, const Palette& palette,
                           int size);

}  // namespace simwright::scene
