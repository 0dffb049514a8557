#pragma once

#include <vector>

#include "core/camera.h"
#include "core/image.h"
#include "scene/asset_set/asset_set.h"
#include "scene/grammar/scene_sample.h"

namespace simwright::scene {

// Renders a scene from a camera, RGBA, with a transparent background. Throws core::Error for a
// category without an asset, or a scene without objects.
core::Image RenderScene(const std::vector<SceneObject>& objects, const AssetSet& asset_set,
                        const core::Camera& camera);

// Renders the whole scene from the side, 35 degrees above the horizontal. `size`: pixels per side.
core::Image RenderFromSide(const std::vector<SceneObject>& objects, const AssetSet& asset_set,
                           int size);

// Renders the whole scene from straight above, from so far that the projection is almost
// orthographic: x to the right, y upwards.
core::Image RenderFromAbove(const std::vector<SceneObject>& objects, const AssetSet& asset_set,
                            int size);

}  // namespace simwright::scene
