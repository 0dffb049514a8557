#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include <nanobind/nanobind.h>

#include "skills/episode_cameras.h"

namespace simwright::python {

// The images that Python asks for: which cameras, and which buffers of each.
struct ImageChoice {
  std::vector<int> cameras;  // indices
  bool rgb = false, depth = false, label = false, normal = false;

  // Reads names of cameras, and "rgb", "depth", "segmentation" and "normal". Throws core::Error for
  // another name, and without any kind.
  static ImageChoice Of(const skills::EpisodeCameras& cameras,
                        const std::vector<std::string>& names,
                        const std::vector<std::string>& kinds);
};

// The images of N views from M cameras in arrays that Python receives without a copy.
class EpisodeImages {
 public:
  EpisodeImages(const skills::EpisodeCameras& cameras, int views, const ImageChoice& choice);

  // Returns the memory of one image; none if its camera was not chosen.
  render::ImageBuffers At(int view, int camera) const;
  // Returns the memory of all images, by view, then camera.
  std::vector<render::ImageBuffers> All() const;
  // Returns a dict from camera to a dict from kind to an array: (N, H, W, ...), or without N if
  // `single`. Requires the GIL; call it once.
  nanobind::dict Take(bool single);

 private:
  struct Memory {
    std::unique_ptr<std::uint8_t[]> rgb;
    std::unique_ptr<float[]> depth, normal;
    std::unique_ptr<std::int32_t[]> label;
  };
  const skills::EpisodeCameras& cameras_;
  int views_ = 0;
  std::vector<Memory> memory_;  // by camera; empty if not chosen
};

}  // namespace simwright::python
