#pragma once

#include <string_view>

namespace simwright::tasks {

enum class TitleDirection { kNone, kAway, kBack };

// Returns the direction in which a title moves a joint: kAway from its rest position ("open", "turn
// on", "pull out", "press") or kBack to it ("close", "shut", "turn off", "push in"). The first such
// verb decides. Words may have any case and be joined by '_' or by capitals ("CloseDoor").
TitleDirection DirectionOfTitle(std::string_view title);

}  // namespace simwright::tasks
