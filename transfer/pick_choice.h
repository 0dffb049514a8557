#pragma once

#include <string>
#include <vector>

#include "tasks/task.h"
#include "workflows/twin/twin_record.h"

namespace simwright::transfer {

// Returns how far an object may be from its place while open fingers still come down on both sides
// of it, in standard deviations of its position: half of what its narrower side leaves of a Panda's
// opening, over position_error. Negative for an object that is wider than the opening.
double GripRoom(const workflows::TwinObject& object);

// Returns the names of the set's tasks of one subtask that pick an object of the twin up, the one
// with the largest GripRoom first.
std::vector<std::string> SurestPicks(const tasks::TaskSet& set,
                                     const workflows::TwinRecord& record);

}  // namespace simwright::transfer
