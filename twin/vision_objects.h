#pragma once

#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Geometry>

#include "core/finding.h"
#include "core/image.h"
#include "core/progress.h"
#include "llm/chat_model.h"

namespace simwright::twin {

// An object that a vision model sees in a photo.
struct NamedBox {
  Eigen::AlignedBox2d box;  // pixels, inside of the photo
  std::string name;         // "coffee mug": letters, digits, blanks, hyphens; may be empty
  std::vector<int> kinds;   // of the library, by its name; empty: any
};

struct VisionObjects {
  std::vector<NamedBox> boxes;
  core::Findings findings;  // of what the answer had that was not used, and why
};

// Returns the question for boxes and names of the objects on the table of a photo (RGB, sent as
// JPEG). `again`: why the last answer could not be used; empty: there was none.
llm::ChatRequest VisionQuestion(const core::Image& photo, const std::string& again = "");

// Reads an answer about a photo of `width` x `height` pixels: the first JSON value that is a list
// of objects with "box" and "name", or has one as "objects". Boxes are pixels, or shares of the
// sides if no number is above 1. Names are data: they choose a category of the knowledge base, and
// nothing else. Boxes that are not four finite numbers, lie outside of the photo, are smaller than
// 8 pixels a side or cover nearly all of it, those of the table itself, repeated ones and those
// beyond the hundredth are left out, each with a finding. Returns false, with the reason, for an
// answer without such a list.
bool ReadVisionAnswer(std::string_view answer, int width, int height, VisionObjects* objects,
                      std::string* fault);

// Asks a vision model for the objects. An answer that cannot be used is requested once more. Throws
// core::Error if the second cannot be used either, and what the model throws.
VisionObjects AskForObjects(llm::ChatModel* model, const core::Image& photo,
                            core::Progress* progress);

}  // namespace simwright::twin
