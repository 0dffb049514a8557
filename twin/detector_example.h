#pragma once

#include <cstdint>
#include <vector>

#include "twin/table_scene.h"

namespace simwright::twin {

// A picture and what the detector shall tell from it.
struct DetectorExample {
  std::vector<std::uint8_t> picture;  // (height x width x 3) RGB
  std::vector<std::uint8_t> object;   // (height x width) 1 + the object's index, 0: none
};

// Renders a random scene; a pure function of the arguments.
DetectorExample MakeDetectorExample(const TableSceneSources& sources,
                                    const TableSceneOptions& options, std::uint64_t seed);

}  // namespace simwright::twin
