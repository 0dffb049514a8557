#pragma once

#include <vector>

#include "core/camera.h"
#include "core/image.h"
#include "scene/asset_set/asset_set.h"
#include "scene/grammar/scene_sample.h"

namespace simwright::scene {

// Renders a scene from a camera, RGBA, with a transparent background, `samples_per_side` squared
// samples per pixel. Throws core::Error for a category without an asset, or a scene without
// objects.
core::Image RenderScene(const std::vector<SceneObject>& objects, const AssetSet& asset_set,
                        const core::Camera& camera, int samples_per_side = 3);

// Return the cameras of RenderFromSide and RenderFromAbove for these objects, e.g. to render
// several scenes alike.
core::Camera SideCamera(const std::vector<SceneObject>& objects, const AssetSet& asset_set,
                        int size);
core::Camera AboveCamera(const std::vector<SceneObject>& objects, const AssetSet& asset_set,
                         int size);

// Renders the whole scene from the side, 35 degrees above the horizontal. `size`: pixels per side.
core::Image RenderFromSide(const std::vector<SceneObject>& objects, const AssetSet& asset_set,
                           int size);

// Renders the whole scene from straight above, from so far that the projection is almost
// orthographic: x to the right, y upwards.
core::Image RenderFromAbove(const std::vector<SceneObject>& objects, const AssetSet& asset_set,
                            int size);

}  // namespace simwright::scene
