#include "twin/object_detector.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include "asset_lift/segmentation/mask_refinement.h"
#include "core/error.h"
#include "core/parallel.h"
#include "nn/checkpoint.h"
#include "twin/detected_pixels.h"
#include "twin/detector_network.h"

namespace simwright::twin {
namespace {

constexpr int kInsideAlpha = 128;
constexpr double kLeastDetected = 0.45;
// The sides of the pictures that the network sees, over those of its training: the coarse one shows
// large objects whole, the fine one shows small objects.
constexpr std::array kScales = {1.0, 1.5};
constexpr double kNetworkPixels = 256.0 * 192.0;  // of the pictures on which it was trained

int NetworkSide(int side, double scale, int step) {
  return std::max(2, static_cast<int>(std::lround(side * scale / step))) * step;
}

// Returns the value of a picture of `pixels` at a point, bilinear, in pixels of that picture.
float ValueAt(const std::vector<float>& values, int width, int height, double x, double y) {
  const double px = std::clamp(x - 0.5, 0.0, width - 1.0);
  const double py = std::clamp(y - 0.5, 0.0, height - 1.0);
  const int x0 = static_cast<int>(px), y0 = static_cast<int>(py);
  const int x1 = std::min(x0 + 1, width - 1), y1 = std::min(y0 + 1, height - 1);
  const auto tx = static_cast<float>(px - x0), ty = static_cast<float>(py - y0);
  const auto at = [&](int i, int j) { return values[static_cast<size_t>(j) * width + i]; };
  return (1.0f - ty) * ((1.0f - tx) * at(x0, y0) + tx * at(x1, y0)) +
         ty * ((1.0f - tx) * at(x0, y1) + tx * at(x1, y1));
}

DetectedPixels PixelsOf(const DetectorOutput& output) {
  DetectedPixels pixels;
  const auto width = output.object.size(3), height = output.object.size(2);
  pixels.width = static_cast<int>(width);
  pixels.height = static_cast<int>(height);
  const torch::Tensor object = torch::sigmoid(output.object).contiguous();
  const torch::Tensor centre = torch::sigmoid(output.centre).contiguous();
  const torch::Tensor offset = output.offset.contiguous();
  const auto count = static_cast<size_t>(width * height);
  pixels.object.assign(object.data_ptr<float>(), object.data_ptr<float>() + count);
  pixels.centre.assign(centre.data_ptr<float>(), centre.data_ptr<float>() + count);
  const float* of = offset.data_ptr<float>();
  for (size_t i = 0; i < count; ++i) {
    pixels.offset.push_back(kOffsetUnit * Eigen::Vector2f(of[i], of[count + i]));
  }
  return pixels;
}

// Returns the objects that the groups of pixels show, in the photo's pixels.
std::vector<Detection> ObjectsOf(const DetectedPixels& pixels, const PixelGroups& groups,
                                 const core::Image& photo) {
  std::vector<Detection> objects(groups.centre.size());
  std::vector<double> sum(objects.size(), 0.0);
  std::vector<int> count(objects.size(), 0);
  for (Detection& object : objects) object.alpha = core::Image(photo.width, photo.height, 1);
  for (int y = 0; y < photo.height; ++y) {
    for (int x = 0; x < photo.width; ++x) {
      const double px = (x + 0.5) * pixels.width / photo.width;
      const double py = (y + 0.5) * pixels.height / photo.height;
      const float share = ValueAt(pixels.object, pixels.width, pixels.height, px, py);
      if (share < 0.02f) continue;
      const int cx = std::min(static_cast<int>(px), pixels.width - 1);
      const int cy = std::min(static_cast<int>(py), pixels.height - 1);
      // Pixels just outside of an object belong to the object of a neighbour.
      int group = -1;
      for (int reach = 0; reach <= 1 && group < 0; ++reach) {
        for (int dy = -reach; dy <= reach && group < 0; ++dy) {
          for (int dx = -reach; dx <= reach && group < 0; ++dx) {
            const int nx = std::clamp(cx + dx, 0, pixels.width - 1);
            const int ny = std::clamp(cy + dy, 0, pixels.height - 1);
            group = groups.group[static_cast<size_t>(ny) * pixels.width + nx];
          }
        }
      }
      if (group < 0) continue;
      Detection& object = objects[static_cast<size_t>(group)];
      *object.alpha.At(x, y) = static_cast<std::uint8_t>(std::lround(255.0f * share));
      if (share < 0.5f) continue;
      object.box.extend(Eigen::Vector2d(x, y));
      object.box.extend(Eigen::Vector2d(x + 1, y + 1));
      sum[static_cast<size_t>(group)] += share;
      ++count[static_cast<size_t>(group)];
    }
  }
  for (size_t k = 0; k < objects.size(); ++k) {
    objects[k].confidence = groups.centre[k] * sum[k] / std::max(1, count[k]);
    const Eigen::AlignedBox2d& box = objects[k].box;
    objects[k].cut =
        !box.isEmpty() && (box.min().x() < 2 || box.min().y() < 2 ||
                           box.max().x() > photo.width - 2 || box.max().y() > photo.height - 2);
  }
  std::erase_if(objects, [](const Detection& object) { return object.box.isEmpty(); });
  return objects;
}

// Moves the outlines of the objects to the edges of the photo.
void RefineOutlines(const core::Image& photo, std::vector<Detection>* objects) {
  const std::vector<Detection> rough = *objects;
  core::ParallelFor(static_cast<int>(rough.size()), [&](int i) {
    core::Image others(photo.width, photo.height, 1);
    for (size_t k = 0; k < rough.size(); ++k) {
      if (static_cast<int>(k) == i) continue;
      for (size_t p = 0; p < others.pixels.size(); ++p) {
        others.pixels[p] = std::max(others.pixels[p], rough[k].alpha.pixels[p]);
      }
    }
    Detection& object = (*objects)[static_cast<size_t>(i)];
    object.alpha = asset_lift::RefinedMask(photo, object.alpha, others);
    object.box.setEmpty();
    for (int y = 0; y < photo.height; ++y) {
      for (int x = 0; x < photo.width; ++x) {
        if (*object.alpha.At(x, y) < kInsideAlpha) continue;
        object.box.extend(Eigen::Vector2d(x, y));
        object.box.extend(Eigen::Vector2d(x + 1, y + 1));
      }
    }
  });
}

}  // namespace

struct ObjectDetector::Network {
  DetectorNetworkOptions sizes;
  DetectorNetwork net{nullptr};

  // Returns the mean of the answers for the photo and its mirror image at all scales, in the pixels
  // of the finest one.
  DetectorOutput Look(const core::Image& photo) {
    const std::vector<std::int64_t> finest = SidesAt(photo, kScales.back());
    DetectorOutput mean;
    for (const double scale : kScales) {
      const std::vector<std::int64_t> sides = SidesAt(photo, scale);
      const core::Image seen =
          core::Resize(photo, static_cast<int>(sides[1]), static_cast<int>(sides[0]));
      const torch::Tensor picture =
          DetectorPictures(seen.pixels.data(), 1, seen.height, seen.width);
      const DetectorOutput straight = net->Detect(picture);
      const DetectorOutput mirrored = net->Detect(torch::flip(picture, {3}));
      const torch::Tensor sign = torch::tensor({-1.0f, 1.0f}).reshape({1, 2, 1, 1});
      const auto add = [&](const torch::Tensor& one, const torch::Tensor& other, double factor,
                           torch::Tensor* sum) {
        const torch::Tensor both = one + torch::flip(other, {3});
        const torch::Tensor large = torch::upsample_bilinear2d(both, finest, false) *
                                    (factor / (2.0 * static_cast<double>(kScales.size())));
        *sum = sum->defined() ? *sum + large : large;
      };
      add(straight.object, mirrored.object, 1.0, &mean.object);
      add(straight.centre, mirrored.centre, 1.0, &mean.centre);
      add(straight.offset, sign * mirrored.offset,
          static_cast<double>(finest[1]) / static_cast<double>(sides[1]), &mean.offset);
    }
    return mean;
  }

 private:
  // Returns height and width.
  std::vector<std::int64_t> SidesAt(const core::Image& photo, double scale) const {
    const double factor = scale * std::sqrt(kNetworkPixels / photo.width / photo.height);
    return {NetworkSide(photo.height, factor, sizes.side_step()),
            NetworkSide(photo.width, factor, sizes.side_step())};
  }
};

ObjectDetector::ObjectDetector(const std::filesystem::path& weights)
    : network_(std::make_unique<Network>()) {
  network_->sizes = ReadDetectorSizes(weights);
  network_->net = DetectorNetwork(network_->sizes);
  nn::LoadCheckpoint(weights, "table detector", network_->net.get());
  network_->net->eval();
}

ObjectDetector::~ObjectDetector() = default;

Detections ObjectDetector::Detect(const core::Image& photo) const {
  if (photo.channels != 3 || photo.width < 64 || photo.height < 64) {
    throw core::Error("a photo of a table must be an RGB picture of at least 64 pixels a side");
  }
  const torch::NoGradGuard no_grad;
  const DetectorOutput output = network_->Look(photo);
  const DetectedPixels pixels = PixelsOf(output);
  Detections found;
  found.objects = ObjectsOf(pixels, GroupPixels(pixels), photo);
  found.left_out = static_cast<int>(std::erase_if(
      found.objects, [](const Detection& object) { return object.confidence < kLeastDetected; }));
  std::stable_sort(
      found.objects.begin(), found.objects.end(),
      [](const Detection& a, const Detection& b) { return a.box.volume() > b.box.volume(); });
  RefineOutlines(photo, &found.objects);
  double covered = 0.0;
  for (const float share : pixels.object) covered += share >= 0.5f ? 1.0 : 0.0;
  found.object_share = covered / static_cast<double>(pixels.object.size());
  return found;
}

}  // namespace simwright::twin
