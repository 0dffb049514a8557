#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/finding.h"
#include "core/image.h"
#include "core/progress.h"
#include "llm/chat_model.h"
#include "twin/object_detector.h"
#include "workflows/twin/twin_photo.h"

namespace simwright::workflows {

// The objects of a photo with the kinds that each may be.
struct TwinDetections {
  twin::Detections found;
  std::vector<std::vector<int>> kinds;  // by object; empty: any
};

// Reads the user's objects (docs/twin.md): boxes in pixels of the photo of `width` x `height`,
// which is scaled to the size of `photo`; each with an optional category and mask file beside the
// JSON file. The camera is a general guess. Throws core::Error, naming the member, for a damaged
// file, a box outside of the photo, or a category without a kind of the library.
TwinDetections ReadTwinObjects(const std::filesystem::path& file, const core::Image& photo,
                               int width, int height);

// Asks a vision model for boxes and names (twin/vision_objects.h), and segments the boxes: by the
// depth, if there is any, where a piece above the plane fills the box about, else by GrabCut. The
// camera is a general guess. Adds the findings of the answer.
TwinDetections AskForTwinObjects(llm::ChatModel* model, const TwinPhoto& photo,
                                 core::Progress* progress, core::Findings* findings);

// Keeps the `most` largest detections, with a finding about the others, and reports those that the
// photo's border cuts off.
void LimitDetections(int most, TwinDetections* detections, core::Findings* findings);

}  // namespace simwright::workflows
