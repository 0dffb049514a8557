#pragma once

#include <string>
#include <vector>

namespace simwright::twin {

// The sizes of the detector's network, which its weights' file keeps.
struct DetectorNetworkOptions {
  std::vector<int> channels = {32, 64, 128, 192};  // of the U-Net's four levels
  int patch = 4;  // pixels per side of one position of the finest level

  // The sides of a picture must be multiples of this many pixels.
  int side_step() const { return patch * 8; }

  // Returns false, with the reason in `error` unless it is null, for sizes that it cannot have.
  bool IsValid(std::string* error) const;
};

}  // namespace simwright::twin
