#pragma once

#include <string>

#include "core/finding.h"
#include "workflows/twin/twin_record.h"

namespace simwright::workflows {

// Returns the page of a twin: photo, overlay and view from above beside each other, a row for each
// object, and the findings. Its pictures are photo.jpg, twin.png, overlay.png and above.png beside
// it, and those of the assets.
std::string TwinPage(const TwinRecord& record, const core::Findings& findings, double seconds);

}  // namespace simwright::workflows
