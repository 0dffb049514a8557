#pragma once

#include <filesystem>

#include "core/finding.h"
#include "workflows/twin/twin_record.h"

namespace simwright::workflows {

// Moves the objects of a twin until none interpenetrate and all rest on the table: projection, then
// settling in Bullet. Articulated objects are fixed. An object that falls or topples keeps the pose
// of the photo, with a finding, and the record then does not stand. `assets`: the folder of the
// objects' asset folders.
void SettleTwin(const std::filesystem::path& assets, TwinRecord* record, core::Findings* findings);

}  // namespace simwright::workflows
