#include "texture/painting/painting.h"

#include <algorithm>
#include <cmath>

#include <opencv2/imgproc.hpp>

#include "core/error.h"
#include "core/parallel.h"
#include "render/scene.h"
#include "texture/painting/surface_fill.h"

namespace simwright::texture {
namespace {

// The published sizes are in pixels of pictures of 1200 pixels per side.
constexpr double kPublishedSide = 1200.0;
constexpr double kGenerateGrowth = 19.0, kRefineOpening = 5.0, kOutlineErosion = 7.0;
constexpr double kBlendSigma = 16.0;
constexpr float kDepthJump = 0.02f;           // of the diagonal, between neighbouring pixels
constexpr double kFieldOfView = 0.75;         // rad
constexpr std::uint8_t kUnpaintedGrey = 128;  // of the request's render
constexpr float kAcceptFrom = 0.5f, kAcceptTo = 0.85f;  // of the blurred trimap

int Pixels(double published, int side) {
  return std::max(1, static_cast<int>(std::lround(published * side / kPublishedSide)));
}

// The odd kernel of a morphological operation whose published diameter is given.
cv::Mat Kernel(double published, int side) {
  const int diameter = Pixels(published, side) | 1;
  return cv::getStructuringElement(cv::MORPH_ELLIPSE, {diameter, diameter});
}

// The width of the erosion at outlines, odd: a bilinear lookup must not meet the background.
int OutlineWidth(int side) {
  return std::max(5, Pixels(kOutlineErosion, side) | 1);
}

float Smooth(float from, float to, float value) {
  const float t = std::clamp((value - from) / (to - from), 0.0f, 1.0f);
  return t * t * (3.0f - 2.0f * t);
}

// Samples the picture bilinearly from the pixels that the trimap does not keep: those that it keeps
// may show bare surface.
Eigen::Vector3f ChangedColor(const core::Image& picture, const core::Image& trimap,
                             const Eigen::Vector2d& pixel) {
  const double px = std::clamp(pixel.x() - 0.5, 0.0, picture.width - 1.0);
  const double py = std::clamp(pixel.y() - 0.5, 0.0, picture.height - 1.0);
  const int x = std::min(static_cast<int>(px), std::max(0, picture.width - 2));
  const int y = std::min(static_cast<int>(py), std::max(0, picture.height - 2));
  const float u = static_cast<float>(px - x), v = static_cast<float>(py - y);
  Eigen::Vector3f sum = Eigen::Vector3f::Zero();
  float weights = 0.0f;
  for (int k = 0; k < 4; ++k) {
    const int nx = std::min(x + (k & 1), picture.width - 1);
    const int ny = std::min(y + (k >> 1), picture.height - 1);
    if (*trimap.At(nx, ny) == kTrimapKeep) continue;
    const float weight = ((k & 1) ? u : 1.0f - u) * ((k >> 1) ? v : 1.0f - v);
    for (int c = 0; c < 3; ++c) {
      sum[c] += weight * static_cast<float>(picture.At(nx, ny)[c]) / 255.0f;
    }
    weights += weight;
  }
  return sum / std::max(1e-6f, weights);
}

class Painter {
 public:
  Painter(const core::TexturedMesh& mesh, const TexelMap& map, const PaintingOptions& options)
      : mesh_(mesh), map_(map), options_(options) {
    scene_.Add(&mesh_);
    scene_.Commit();
    reach_ = static_cast<float>(core::Bounds(mesh.mesh).diagonal().norm());
    colors_.assign(map.count(), Eigen::Vector3f::Constant(kUnpaintedGrey / 255.0f));
    painting_.facing.assign(map.count(), 0.0f);
    painting_.painted_by.assign(map.count(), kNoTexel);
    points_.resize(map.count());
    normals_.resize(map.count());
    ForChunks([&](std::size_t texel) {
      if (map_.triangle[texel] < 0) return;
      painting_.painted_by[texel] = kUnseenTexel;
      const render::Hit hit = HitOf(texel);
      const Eigen::Matrix3f corners = scene_.Corners(0, hit.triangle);
      points_[texel] = corners * map_.OnTriangle(texel);
      normals_[texel] = scene_.ShadingNormal(hit);
    });
  }

  // Paints from one camera.
  void Paint(const core::Camera& camera, ImageGenerator* generator) {
    ImageRequest request = Request(camera);
    PaintedView view;
    view.camera = camera;
    view.trimap = request.trimap;
    if (std::all_of(request.trimap.pixels.begin(), request.trimap.pixels.end(),
                    [](std::uint8_t value) { return value == kTrimapKeep; })) {
      painting_.views.push_back(std::move(view));
      return;
    }
    view.picture = generator->Generate(request);
    if (view.picture.channels != 3 || view.picture.width != camera.width ||
        view.picture.height != camera.height) {
      throw core::Error("the generator's picture has another size than was asked for",
                        generator->name());
    }
    Project(&view);
    painting_.views.push_back(std::move(view));
  }

  Painting Finish() {
    std::vector<std::uint8_t> known(map_.count());
    double inside = 0.0, unseen = 0.0;
    std::vector<Eigen::Vector3f> points, colors;
    std::vector<std::size_t> texels;
    known.clear();
    for (std::size_t i = 0; i < map_.count(); ++i) {
      if (map_.triangle[i] < 0) continue;
      const bool seen = painting_.painted_by[i] >= 0;
      inside += map_.inside[i];
      unseen += map_.inside[i] && !seen;
      texels.push_back(i);
      points.push_back(points_[i]);
      colors.push_back(colors_[i]);
      known.push_back(seen);
    }
    painting_.unseen_share = inside > 0.0 ? unseen / inside : 0.0;
    FillUnknownColors(points, known, reach_ / 400.0f, &colors);
    painting_.texture = core::Image(map_.size, map_.size, 3);
    for (std::size_t i = 0; i < texels.size(); ++i) {
      for (int c = 0; c < 3; ++c) {
        painting_.texture.pixels[3 * texels[i] + c] =
            static_cast<std::uint8_t>(std::lround(255.0f * std::clamp(colors[i][c], 0.0f, 1.0f)));
      }
    }
    FillBetweenCharts(map_, kGutter, &painting_.texture);
    return std::move(painting_);
  }

 private:
  template <typename Body>
  void ForChunks(const Body& body) const {
    core::ParallelFor(map_.size, [&](int y) {
      for (int x = 0; x < map_.size; ++x) body(map_.Index(x, y));
    });
  }

  render::Hit HitOf(std::size_t texel) const {
    const Eigen::Vector3f at = map_.OnTriangle(texel);
    render::Hit hit;
    hit.instance = 0;
    hit.triangle = map_.triangle[texel];
    hit.u = at[1];
    hit.v = at[2];
    return hit;
  }

  static float Facing(const Eigen::Vector3f& point, const Eigen::Vector3f& normal,
                      const core::Camera& camera) {
    const Eigen::Vector3f to_camera = camera.position().cast<float>() - point;
    return normal.dot(to_camera.normalized());
  }

  // Returns the texel of a hit, or -1.
  std::int64_t TexelOf(const render::Hit& hit) const {
    const std::size_t first = 3 * static_cast<std::size_t>(hit.triangle);
    const Eigen::Vector2f uv = (1.0f - hit.u - hit.v) * mesh_.corner_uvs[first] +
                               hit.u * mesh_.corner_uvs[first + 1] +
                               hit.v * mesh_.corner_uvs[first + 2];
    const float side = static_cast<float>(map_.size);
    const int x = std::clamp(static_cast<int>(uv.x() * side), 0, map_.size - 1);
    const int y = std::clamp(static_cast<int>((1.0f - uv.y()) * side), 0, map_.size - 1);
    const std::size_t texel = map_.Index(x, y);
    return map_.triangle[texel] >= 0 ? static_cast<std::int64_t>(texel) : -1;
  }

  // Renders the object as painted so far, with its depth and trimap.
  ImageRequest Request(const core::Camera& camera) const {
    ImageRequest request;
    request.prompt = options_.prompt;
    request.negative_prompt = options_.negative_prompt;
    request.exemplar = options_.exemplar;
    request.camera = camera;
    request.width = camera.width;
    request.height = camera.height;
    request.seed = options_.seed + painting_.views.size();
    request.render = core::Image(camera.width, camera.height, 3, 255);
    request.depth = core::FloatImage(camera.width, camera.height, 1);
    cv::Mat object(camera.height, camera.width, CV_8U, cv::Scalar(0));
    cv::Mat generate = object.clone(), refine = object.clone();
    const Eigen::Vector3f origin = camera.position().cast<float>();
    core::ParallelFor(camera.height, [&](int y) {
      for (int x = 0; x < camera.width; ++x) {
        const Eigen::Vector3f ray = camera.Ray({x + 0.5, y + 0.5}).cast<float>();
        const render::Hit hit = scene_.Intersect(origin, ray);
        if (hit.instance < 0) continue;
        object.at<std::uint8_t>(y, x) = 255;
        *request.depth.At(x, y) = hit.depth;
        const std::int64_t texel = TexelOf(hit);
        const bool painted = texel >= 0 && painting_.painted_by[texel] >= 0;
        for (int c = 0; c < 3; ++c) {
          request.render.At(x, y)[c] =
              painted ? static_cast<std::uint8_t>(std::lround(255.0f * colors_[texel][c]))
                      : kUnpaintedGrey;
        }
        const float facing = Facing(origin + hit.depth * ray, scene_.ShadingNormal(hit), camera);
        if (facing < static_cast<float>(options_.least_facing)) continue;
        if (!painted) generate.at<std::uint8_t>(y, x) = 255;
        if (painted &&
            facing > painting_.facing[texel] + static_cast<float>(options_.refine_gain)) {
          refine.at<std::uint8_t>(y, x) = 255;
        }
      }
    });
    MarkDepthJumps(request.depth, &object);
    request.trimap = Trimap(object, generate, refine);
    return request;
  }

  // Clears the pixels of `object` at which one surface ends before another.
  void MarkDepthJumps(const core::FloatImage& depth, cv::Mat* object) const {
    const float jump = kDepthJump * reach_;
    for (int y = 0; y + 1 < depth.height; ++y) {
      for (int x = 0; x + 1 < depth.width; ++x) {
        const float here = *depth.At(x, y);
        if (std::abs(here - *depth.At(x + 1, y)) > jump ||
            std::abs(here - *depth.At(x, y + 1)) > jump) {
          object->at<std::uint8_t>(y, x) = 0;
        }
      }
    }
  }

  core::Image Trimap(const cv::Mat& object, const cv::Mat& generate, const cv::Mat& refine) const {
    const int side = options_.view_size;
    cv::Mat grown, opened, inner;
    cv::dilate(generate, grown, Kernel(kGenerateGrowth, side));
    cv::morphologyEx(refine, opened, cv::MORPH_OPEN, Kernel(kRefineOpening, side));
    cv::erode(object, inner, cv::Mat::ones(OutlineWidth(side), OutlineWidth(side), CV_8U));
    core::Image trimap(object.cols, object.rows, 1, kTrimapKeep);
    for (int y = 0; y < object.rows; ++y) {
      for (int x = 0; x < object.cols; ++x) {
        if (inner.at<std::uint8_t>(y, x) == 0) continue;
        if (opened.at<std::uint8_t>(y, x)) *trimap.At(x, y) = kTrimapRefine;
        if (grown.at<std::uint8_t>(y, x)) *trimap.At(x, y) = kTrimapGenerate;
      }
    }
    return trimap;
  }

  // Returns the share of the new picture in each pixel, falling towards what is kept.
  cv::Mat AcceptedShare(const core::Image& trimap) const {
    cv::Mat changed(trimap.height, trimap.width, CV_32F, cv::Scalar(0));
    for (int y = 0; y < trimap.height; ++y) {
      for (int x = 0; x < trimap.width; ++x) {
        if (*trimap.At(x, y) != kTrimapKeep) changed.at<float>(y, x) = 1.0f;
      }
    }
    const double sigma = kBlendSigma * trimap.width / kPublishedSide;
    cv::GaussianBlur(changed, changed, {0, 0}, sigma, sigma);
    return changed;
  }

  // Takes the view's colours into the texels that it sees and that are not to be kept.
  void Project(PaintedView* view) {
    const core::Camera& camera = view->camera;
    const cv::Mat share = AcceptedShare(view->trimap);
    const Eigen::Vector3f eye = camera.position().cast<float>();
    const std::int16_t index = static_cast<std::int16_t>(painting_.views.size());
    std::vector<int> generated(static_cast<std::size_t>(map_.size), 0), refined = generated;
    core::ParallelFor(map_.size, [&](int row) {
      for (int column = 0; column < map_.size; ++column) {
        const std::size_t texel = map_.Index(column, row);
        if (map_.triangle[texel] < 0) continue;
        const Eigen::Vector3f& point = points_[texel];
        const float facing = Facing(point, normals_[texel], camera);
        if (facing < static_cast<float>(options_.least_facing)) continue;
        const bool painted = painting_.painted_by[texel] >= 0;
        const float gain = static_cast<float>(options_.refine_gain);
        if (painted && facing + gain < painting_.facing[texel]) continue;
        const Eigen::Vector3d at = camera.Project(point.cast<double>());
        const int x = static_cast<int>(std::floor(at.x())),
                  y = static_cast<int>(std::floor(at.y()));
        if (at.z() <= 0.0 || x < 0 || y < 0 || x >= camera.width || y >= camera.height) continue;
        if (*view->trimap.At(x, y) == kTrimapKeep) continue;
        const Eigen::Vector3f to_eye = eye - point;
        const Eigen::Vector3f start = point + 1e-4f * reach_ * normals_[texel];
        if (scene_.Occluded(start, to_eye, 1e-4f, 1.0f)) continue;
        const Eigen::Vector3f color = ChangedColor(view->picture, view->trimap, {at.x(), at.y()});
        const float weight = painted ? Smooth(kAcceptFrom, kAcceptTo, share.at<float>(y, x)) : 1.0f;
        colors_[texel] += weight * (color - colors_[texel]);
        if (weight < 0.5f) continue;
        ++(painted ? refined : generated)[static_cast<std::size_t>(row)];
        painting_.painted_by[texel] = index;
        painting_.facing[texel] = facing;
      }
    });
    for (const int n : generated) view->generated += static_cast<std::size_t>(n);
    for (const int n : refined) view->refined += static_cast<std::size_t>(n);
  }

  const core::TexturedMesh& mesh_;
  const TexelMap& map_;
  const PaintingOptions& options_;
  render::Scene scene_;
  float reach_ = 1.0f;                    // m, the mesh's diagonal
  std::vector<Eigen::Vector3f> points_;   // (size x size), m, on the surface
  std::vector<Eigen::Vector3f> normals_;  // (size x size), of shading
  std::vector<Eigen::Vector3f> colors_;   // (size x size), sRGB in [0, 1]
  Painting painting_;
};

}  // namespace

bool PaintingOptions::IsValid(std::string* error) const {
  const auto fail = [error](const std::string& reason) {
    if (error) *error = reason;
    return false;
  };
  if (prompt.empty() && exemplar.empty()) return fail("neither a prompt nor an exemplar is given");
  if (view_size < 64 || view_size > 4096) return fail("a view has 64 to 4096 pixels per side");
  const auto is_cosine = [](double value) { return value >= 0.0 && value < 1.0; };
  if (!is_cosine(refine_gain) || !is_cosine(least_facing)) {
    return fail("refine_gain and least_facing are cosines in [0, 1)");
  }
  return true;
}

std::vector<core::Camera> PaintingCameras(const Eigen::AlignedBox3d& bounds, double front_azimuth,
                                          int size) {
  // Degrees: the polar angle from the top and the azimuth from the front.
  constexpr double kViews[][2] = {{60, 0},   {60, 45},  {60, 315}, {60, 90}, {60, 270},
                                  {60, 135}, {60, 225}, {60, 180}, {30, 0},  {150, 0}};
  constexpr double kDegree = M_PI / 180.0, kMargin = 1.04;
  const double radius = std::max(1e-9, 0.5 * bounds.diagonal().norm());
  const double distance = kMargin * radius / std::sin(0.5 * kFieldOfView);
  std::vector<core::Camera> cameras;
  for (const auto& [polar, azimuth] : kViews) {
    cameras.push_back(core::OrbitCamera(bounds.center(), distance, (90.0 - polar) * kDegree,
                                        front_azimuth + azimuth * kDegree, kFieldOfView, size,
                                        size));
  }
  return cameras;
}

Painting PaintTexture(const core::TexturedMesh& mesh, const TexelMap& map,
                      const PaintingOptions& options, ImageGenerator* generator,
                      core::Progress* progress) {
  std::string error;
  if (!options.IsValid(&error)) throw core::Error("the painting cannot start: " + error);
  if (mesh.corner_uvs.size() != 3 * mesh.mesh.triangles.size() || mesh.mesh.empty()) {
    throw core::Error("a texture needs texture coordinates for each corner");
  }
  const std::vector<core::Camera> cameras =
      PaintingCameras(core::Bounds(mesh.mesh), options.front_azimuth, options.view_size);
  progress->Stage("paint", static_cast<int>(cameras.size()));
  Painter painter(mesh, map, options);
  for (const core::Camera& camera : cameras) {
    core::CheckCancelled();
    painter.Paint(camera, generator);
    progress->Advance();
  }
  progress->Finish();
  return painter.Finish();
}

}  // namespace simwright::texture
