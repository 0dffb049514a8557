#include "twin_judgement.h"

#include <algorithm>
#include <cmath>

#include "object_symmetry.h"

namespace simwright::bench {
namespace {

constexpr int kLeastPixels = 80;
constexpr double kMatch = 0.5;  // IoU
constexpr int kAlignments = 10;
constexpr double kRobust = 0.005;  // m: larger distances weigh less

double YawOf(const Eigen::Isometry3d& pose) {
  return std::atan2(pose.linear()(1, 0), pose.linear()(0, 0));
}

// Returns the rigid motion in the plane from `from` to `to`, with weights that fall with distance.
Eigen::Isometry2d Alignment(const std::vector<Eigen::Vector2d>& from,
                            const std::vector<Eigen::Vector2d>& to) {
  Eigen::Isometry2d motion = Eigen::Isometry2d::Identity();
  std::vector<double> weight(from.size(), 1.0);
  for (int pass = 0; pass < kAlignments && !from.empty(); ++pass) {
    Eigen::Vector2d a = Eigen::Vector2d::Zero(), b = a;
    double sum = 0.0;
    for (size_t i = 0; i < from.size(); ++i) {
      a += weight[i] * from[i];
      b += weight[i] * to[i];
      sum += weight[i];
    }
    a /= sum;
    b /= sum;
    double sine = 0.0, cosine = 1e-12;
    for (size_t i = 0; i < from.size(); ++i) {
      const Eigen::Vector2d p = from[i] - a, q = to[i] - b;
      cosine += weight[i] * p.dot(q);
      sine += weight[i] * (p.x() * q.y() - p.y() * q.x());
    }
    const Eigen::Rotation2Dd turn(from.size() < 2 ? 0.0 : std::atan2(sine, cosine));
    motion.linear() = turn.toRotationMatrix();
    motion.translation() = b - turn * a;
    for (size_t i = 0; i < from.size(); ++i) {
      weight[i] = 1.0 / (kRobust + (motion * from[i] - to[i]).norm());
    }
  }
  return motion;
}

}  // namespace

Eigen::Isometry3d TwinFromScene(const core::Camera& camera) {
  const Eigen::Vector3d axis = camera.world_from_camera.linear().col(2);
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.linear() =
      Eigen::AngleAxisd(0.5 * M_PI - std::atan2(axis.y(), axis.x()), Eigen::Vector3d::UnitZ())
          .toRotationMatrix();
  Eigen::Vector3d foot = camera.position();
  foot.z() = 0.0;
  pose.translation() = -(pose.linear() * foot);
  return pose;
}

std::vector<twin::Detection> TrueDetections(const twin::TablePicture& picture, int objects,
                                            std::vector<int>* indices) {
  const int width = picture.color.width, height = picture.color.height;
  std::vector<twin::Detection> truth;
  for (int k = 0; k < objects; ++k) {
    twin::Detection detection;
    detection.alpha = core::Image(width, height, 1);
    detection.confidence = 1.0;
    int pixels = 0;
    for (int y = 0; y < height; ++y) {
      for (int x = 0; x < width; ++x) {
        if (picture.label[static_cast<size_t>(y) * width + x] != k) continue;
        *detection.alpha.At(x, y) = 255;
        detection.box.extend(Eigen::Vector2d(x, y));
        detection.box.extend(Eigen::Vector2d(x + 1, y + 1));
        detection.cut = detection.cut || x < 2 || y < 2 || x > width - 3 || y > height - 3;
        ++pixels;
      }
    }
    if (pixels < kLeastPixels) continue;
    truth.push_back(std::move(detection));
    indices->push_back(k);
  }
  return truth;
}

std::vector<int> MatchedDetections(const std::vector<twin::Detection>& found,
                                   const std::vector<twin::Detection>& truth) {
  std::vector<int> matched(found.size(), -1);
  std::vector<double> best(truth.size(), kMatch);
  std::vector<int> holder(truth.size(), -1);
  for (size_t i = 0; i < found.size(); ++i) {
    for (size_t k = 0; k < truth.size(); ++k) {
      double both = 0.0, either = 0.0;
      for (size_t p = 0; p < found[i].alpha.pixels.size(); ++p) {
        const bool a = found[i].alpha.pixels[p] > 127, b = truth[k].alpha.pixels[p] > 127;
        both += a && b ? 1.0 : 0.0;
        either += a || b ? 1.0 : 0.0;
      }
      if (both / std::max(1.0, either) <= best[k]) continue;
      best[k] = both / either;
      if (holder[k] >= 0) matched[static_cast<size_t>(holder[k])] = -1;
      holder[k] = static_cast<int>(i);
      matched[i] = static_cast<int>(k);
    }
  }
  return matched;
}

std::vector<ObjectErrors> JudgeTable(const twin::TableReconstruction& table,
                                     const std::vector<int>& objects, const twin::TableScene& scene,
                                     bool aligned) {
  const Eigen::Isometry3d twin_from_scene = TwinFromScene(scene.camera);
  std::vector<Eigen::Vector2d> estimates, truths;
  std::vector<size_t> judged;
  for (size_t k = 0; k < table.objects.size(); ++k) {
    if (objects[k] < 0) continue;
    const twin::TableFit& fit = table.objects[k].fit;
    const twin::TableObject& truth = scene.objects[static_cast<size_t>(objects[k])];
    const core::TriangleMesh mesh = library_fit::InstanceMesh(fit.instance).mesh;
    estimates.emplace_back((fit.pose.WorldFromObject() * core::Bounds(mesh).center()).head<2>());
    truths.emplace_back(
        (twin_from_scene * truth.world_from_object * core::Bounds(truth.visual.mesh).center())
            .head<2>());
    judged.push_back(k);
  }
  Eigen::Isometry2d motion = Eigen::Isometry2d::Identity();
  if (aligned) motion = Alignment(estimates, truths);
  const double turn = std::atan2(motion.linear()(1, 0), motion.linear()(0, 0));
  std::vector<ObjectErrors> errors;
  for (size_t i = 0; i < judged.size(); ++i) {
    const twin::ReconstructedObject& object = table.objects[judged[i]];
    const twin::TableObject& truth = scene.objects[static_cast<size_t>(objects[judged[i]])];
    ObjectErrors error;
    error.truth = objects[judged[i]];
    error.kind = truth.mesh < 0 && truth.instance.kind == object.fit.instance.kind;
    error.position = (motion * estimates[i] - truths[i]).norm();
    error.yaw =
        YawDifference(object.fit.pose.yaw + turn, YawOf(twin_from_scene * truth.world_from_object),
                      SymmetricTurns(truth.visual.mesh));
    const core::TriangleMesh mesh = library_fit::InstanceMesh(object.fit.instance).mesh;
    error.size = std::log(core::Bounds(mesh).sizes().prod() /
                          core::Bounds(truth.visual.mesh).sizes().prod()) /
                 3.0;
    error.position_sigmas =
        error.position / (std::sqrt(2.0) * std::max(1e-6, object.position_error));
    error.size_sigmas = std::abs(error.size) / std::max(1e-6, object.size_error);
    errors.push_back(error);
  }
  return errors;
}

}  // namespace simwright::bench
