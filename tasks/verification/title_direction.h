#pragma once

#include <string_view>

namespace simwright::tasks {

enum class TitleDirection { kNone, kAway, kBack };

// What a title asks of a joint: kAway from its rest ("open", "turn on", "pull out", "press"), kBack
// to it ("close", "shut", "turn off", "push in"); by the first such verb in it. Words in any case,
// joined by '_' or by capitals ("CloseDoor") as well.
TitleDirection DirectionOfTitle(std::string_view title);

}  // namespace simwright::tasks
