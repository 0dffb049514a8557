#pragma once

#include <cstdint>
#include <string>

#include "core/camera.h"
#include "core/finding.h"
#include "core/float_image.h"
#include "core/image.h"

namespace simwright::texture {

// The values of a trimap (1 channel).
inline constexpr std::uint8_t kTrimapKeep = 0;        // the pixel stays as rendered
inline constexpr std::uint8_t kTrimapRefine = 128;    // painted before from a flatter angle
inline constexpr std::uint8_t kTrimapGenerate = 255;  // not painted yet

// A picture that is asked for. With an empty `render` it is made from the words alone, of `width` x
// `height` pixels; otherwise it has the size of `render`, which shows a textured object from one
// camera.
struct ImageRequest {
  std::string prompt;
  std::string negative_prompt;
  core::Image exemplar;  // RGB, a picture whose look is wanted; may be empty
  int width = 0, height = 0;
  core::Image render;      // RGB, sRGB: the object as painted so far
  core::Image trimap;      // 1 channel, the size of `render`
  core::FloatImage depth;  // 1 channel, the size of `render`: m along the optical axis, 0: nothing
  core::Camera camera;     // of `render`
  std::uint64_t seed = 1;

  // Returns false, with the reason, unless there is a prompt or an exemplar, and all pictures of a
  // view have one size; without a view both sides must be 64 to 4096 pixels.
  bool IsValid(std::string* error) const;
};

// Makes pictures by words, an exemplar or both. Implementations may be asked from one thread at a
// time.
class ImageGenerator {
 public:
  virtual ~ImageGenerator() = default;

  // Returns the name for messages and records: "sdwebui http://localhost:7860".
  virtual std::string name() const = 0;
  // Returns an RGB picture of the requested size. The same request gives the same picture where the
  // generator is deterministic. Throws core::Error for an invalid request and for a failure that
  // the user can mend, and core::Cancelled.
  virtual core::Image Generate(const ImageRequest& request) = 0;
  // Returns the findings since the last call, e.g. a picture that was resized or a depth that the
  // generator cannot use.
  virtual core::Findings TakeFindings() { return {}; }
};

}  // namespace simwright::texture
