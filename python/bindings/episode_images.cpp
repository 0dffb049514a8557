#include "python/bindings/episode_images.h"

#include <initializer_list>
#include <utility>

#include <nanobind/ndarray.h>

#include "core/error.h"

namespace simwright::python {
namespace {

namespace nb = nanobind;

size_t PixelsOf(const render::CameraSpec& camera) {
  return static_cast<size_t>(camera.width) * static_cast<size_t>(camera.height);
}

template <typename Number>
std::unique_ptr<Number[]> Allocate(bool wanted, size_t count) {
  return wanted ? std::unique_ptr<Number[]>(new Number[count]) : nullptr;
}

template <typename Number>
void Add(const char* name, std::unique_ptr<Number[]> memory, std::vector<size_t> shape,
         nb::dict* images) {
  if (!memory) return;
  Number* numbers = memory.release();
  const nb::capsule owner(numbers,
                          [](void* held) noexcept { delete[] static_cast<Number*>(held); });
  (*images)[name] = nb::ndarray<nb::numpy, Number>(numbers, shape.size(), shape.data(), owner);
}

}  // namespace

ImageChoice ImageChoice::Of(const skills::EpisodeCameras& cameras,
                            const std::vector<std::string>& names,
                            const std::vector<std::string>& kinds) {
  ImageChoice choice;
  for (const std::string& name : names) choice.cameras.push_back(cameras.Find(name));
  for (const std::string& kind : kinds) {
    if (kind == "rgb") {
      choice.rgb = true;
    } else if (kind == "depth") {
      choice.depth = true;
    } else if (kind == "segmentation") {
      choice.label = true;
    } else if (kind == "normal") {
      choice.normal = true;
    } else {
      throw core::Error("there is no '" + kind + "'", "images",
                        "give rgb, depth, segmentation or normal");
    }
  }
  if (kinds.empty()) throw core::Error("is empty", "images", "give rgb, depth ...");
  return choice;
}

EpisodeImages::EpisodeImages(const skills::EpisodeCameras& cameras, int views,
                             const ImageChoice& choice)
    : cameras_(cameras), views_(views), memory_(static_cast<size_t>(cameras.size())) {
  for (const int camera : choice.cameras) {
    const size_t pixels =
        static_cast<size_t>(views) * PixelsOf(cameras.cameras()[static_cast<size_t>(camera)]);
    memory_[static_cast<size_t>(camera)] = {
        Allocate<std::uint8_t>(choice.rgb, 3 * pixels), Allocate<float>(choice.depth, pixels),
        Allocate<float>(choice.normal, 3 * pixels), Allocate<std::int32_t>(choice.label, pixels)};
  }
}

render::ImageBuffers EpisodeImages::At(int view, int camera) const {
  const Memory& memory = memory_[static_cast<size_t>(camera)];
  const size_t first =
      static_cast<size_t>(view) * PixelsOf(cameras_.cameras()[static_cast<size_t>(camera)]);
  render::ImageBuffers buffers;
  if (memory.rgb) buffers.rgb = memory.rgb.get() + 3 * first;
  if (memory.depth) buffers.depth = memory.depth.get() + first;
  if (memory.label) buffers.label = memory.label.get() + first;
  if (memory.normal) buffers.normal = memory.normal.get() + 3 * first;
  return buffers;
}

std::vector<render::ImageBuffers> EpisodeImages::All() const {
  std::vector<render::ImageBuffers> images;
  for (int view = 0; view < views_; ++view) {
    for (int camera = 0; camera < cameras_.size(); ++camera) images.push_back(At(view, camera));
  }
  return images;
}

nb::dict EpisodeImages::Take(bool single) {
  nb::dict dict;
  for (size_t i = 0; i < memory_.size(); ++i) {
    const render::CameraSpec& camera = cameras_.cameras()[i];
    std::vector<size_t> shape;
    if (!single) shape.push_back(static_cast<size_t>(views_));
    shape.push_back(static_cast<size_t>(camera.height));
    shape.push_back(static_cast<size_t>(camera.width));
    std::vector<size_t> vectors = shape;
    vectors.push_back(3);
    nb::dict images;
    Add("rgb", std::move(memory_[i].rgb), vectors, &images);
    Add("depth", std::move(memory_[i].depth), shape, &images);
    Add("segmentation", std::move(memory_[i].label), shape, &images);
    Add("normal", std::move(memory_[i].normal), vectors, &images);
    if (images.size() > 0) dict[camera.name.c_str()] = images;
  }
  return dict;
}

}  // namespace simwright::python
