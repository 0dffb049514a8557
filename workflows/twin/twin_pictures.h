#pragma once

#include <filesystem>

#include "core/image.h"
#include "workflows/twin/twin_record.h"

namespace simwright::workflows {

// The pictures of a twin.
struct TwinPictures {
  core::Image overlay;   // RGB: the twin over the darkened photo, from its camera
  core::Image rendered;  // RGB: the twin alone, from the photo's camera
  core::Image above;     // RGB: from straight above
};

// Renders the twin whose assets lie below `assets`. `photo`: RGB, the size of the record's camera.
TwinPictures RenderTwin(const TwinRecord& record, const std::filesystem::path& assets,
                        const core::Image& photo);

}  // namespace simwright::workflows
