#include "render/gradient_collection.h"

#include <algorithm>

#include "core/parallel.h"

namespace simwright::render {
namespace {

void FitGradients(const std::vector<PreparedObject>& objects, SceneGradients* gradients) {
  if (gradients->objects.size() != objects.size()) {
    *gradients = {};
    gradients->objects.resize(objects.size());
  }
  for (std::size_t i = 0; i < objects.size(); ++i) {
    const DifferentiableObject& object = objects[i].object;
    ObjectGradients& to = gradients->objects[i];
    if (to.vertices.size() != object.mesh.vertices.size()) {
      to.vertices.assign(object.mesh.vertices.size(), Eigen::Vector3d::Zero());
    }
    if (to.vertex_colors.size() != object.vertex_colors.size()) {
      to.vertex_colors.assign(object.vertex_colors.size(), Eigen::Vector3f::Zero());
    }
    if (to.texture.values.size() != object.texture.values.size() ||
        to.texture.width != object.texture.width) {
      to.texture =
          core::FloatImage(object.texture.width, object.texture.height, object.texture.channels);
    }
  }
}

// Entries per task; the tasks' sums are added in order, so that the result does not depend on
// scheduling.
constexpr std::size_t kChunk = 4096;

// The totals over an object's vertices.
struct RigidSums {
  Eigen::Vector3d force = Eigen::Vector3d::Zero();
  Eigen::Vector3d moment = Eigen::Vector3d::Zero();

  void Add(const Eigen::Vector3d& at, const Eigen::Vector3d& gradient) {
    force += gradient;
    moment += at.cross(gradient);
  }
  void Add(const RigidSums& other) {
    force += other.force;
    moment += other.moment;
  }
};

// Calls body(first, last, sums) for chunks of [0, count) from several threads; returns the total.
template <typename Body>
RigidSums OverChunks(std::size_t count, const Body& body) {
  std::vector<RigidSums> parts((count + kChunk - 1) / kChunk);
  core::ParallelFor(static_cast<int>(parts.size()), [&](int chunk) {
    const std::size_t first = static_cast<std::size_t>(chunk) * kChunk;
    body(first, std::min(first + kChunk, count), &parts[chunk]);
  });
  RigidSums total;
  for (const RigidSums& part : parts) total.Add(part);
  return total;
}

// Sums the threads' point gradients and transforms them to the world, in the first thread's sums;
// adds their effect on the camera to `camera_gradients`.
void TransformToWorld(const PreparedObject& of, std::size_t object, const core::Camera& camera,
                      std::vector<GradientSums>* sums, CameraGradients* camera_gradients) {
  const Eigen::Matrix3d rotation = camera.world_from_camera.linear();
  std::vector<Eigen::Vector3d>& points = (*sums)[0].objects[object].points;
  const RigidSums total =
      OverChunks(points.size(), [&](std::size_t first, std::size_t last, RigidSums* part) {
        for (std::size_t t = 1; t < sums->size(); ++t) {
          std::vector<Eigen::Vector3d>& more = (*sums)[t].objects[object].points;
          for (std::size_t i = first; i < last; ++i) {
            points[i] += more[i];
            more[i].setZero();
          }
        }
        for (std::size_t i = first; i < last; ++i) {
          part->Add(of.camera[i].cast<double>(), points[i]);
          points[i] = rotation * points[i];
        }
      });
  // Points are fixed in the world: relative to the camera they move oppositely.
  camera_gradients->pose.translation -= rotation * total.force;
  camera_gradients->pose.rotation -= rotation * total.moment;
}

// Propagates the threads' gradients of unit normals to world points in the first thread's sums: a
// normal is the sum s of its faces' area vectors e1 x e2, divided by its length.
void PropagateNormals(const PreparedObject& of, std::size_t object, bool smooth,
                      std::vector<GradientSums>* sums) {
  std::vector<Eigen::Vector3d>& normals = (*sums)[0].objects[object].normals;
  std::vector<Eigen::Vector3d>& points = (*sums)[0].objects[object].points;
  for (std::size_t i = 0; i < normals.size(); ++i) {
    for (std::size_t t = 1; t < sums->size(); ++t) {
      Eigen::Vector3d& more = (*sums)[t].objects[object].normals[i];
      normals[i] += more;
      more.setZero();
    }
    const Eigen::Vector3d unit = of.normals[i].cast<double>();
    const double length = of.normal_lengths[i];
    normals[i] = length > 0.0 ? Eigen::Vector3d((normals[i] - unit * unit.dot(normals[i])) / length)
                              : Eigen::Vector3d::Zero();
  }
  for (std::size_t f = 0; f < of.object.mesh.triangles.size(); ++f) {
    const Eigen::Vector3i& welded = of.topology.welded_triangles[f];
    const Eigen::Vector3d area =
        smooth ? Eigen::Vector3d(normals[welded[0]] + normals[welded[1]] + normals[welded[2]])
               : normals[f];
    if (area.isZero(0.0)) continue;
    const Eigen::Vector3i& t = of.object.mesh.triangles[f];
    const Eigen::Vector3d p = of.world[t[0]].cast<double>();
    const Eigen::Vector3d at1 = (of.world[t[2]].cast<double>() - p).cross(area);
    const Eigen::Vector3d at2 = area.cross(of.world[t[1]].cast<double>() - p);
    points[t[0]] -= at1 + at2;
    points[t[1]] += at1;
    points[t[2]] += at2;
  }
  std::fill(normals.begin(), normals.end(), Eigen::Vector3d::Zero());
}

void TakePoints(const PreparedObject& of, std::size_t object, std::vector<GradientSums>* sums,
                ObjectGradients* to) {
  std::vector<Eigen::Vector3d>& points = (*sums)[0].objects[object].points;
  const Eigen::Matrix3d back = of.object.world_from_object.linear().transpose();
  const Eigen::Vector3d origin = of.object.world_from_object.translation();
  const RigidSums total =
      OverChunks(points.size(), [&](std::size_t first, std::size_t last, RigidSums* part) {
        for (std::size_t i = first; i < last; ++i) {
          part->Add(of.world[i].cast<double>() - origin, points[i]);
          to->vertices[i] += back * points[i];
          points[i].setZero();
        }
      });
  to->pose.translation += total.force;
  to->pose.rotation += total.moment;
}

void TakeColors(std::size_t object, std::vector<GradientSums>* sums,
                std::vector<Eigen::Vector3f>* to) {
  for (GradientSums& of : *sums) {
    std::vector<Eigen::Vector3f>& from = of.objects[object].colors;
    for (std::size_t i = 0; i < from.size(); ++i) (*to)[i] += from[i];
    std::fill(from.begin(), from.end(), Eigen::Vector3f::Zero());
  }
}

void CollectTexels(std::size_t object, std::vector<GradientSums>* sums, core::FloatImage* to) {
  for (GradientSums& of : *sums) {
    ObjectSums& from = of.objects[object];
    for (std::size_t block = 0; block < from.touched.size(); ++block) {
      if (!from.touched[block]) continue;
      const std::size_t begin = block * ObjectSums::kTexelBlock;
      const std::size_t end = std::min(begin + ObjectSums::kTexelBlock, from.texels.size());
      for (std::size_t i = begin; i < end; ++i) {
        to->values[i] += from.texels[i];
        from.texels[i] = 0.0f;
      }
      from.touched[block] = 0;
    }
  }
}

}  // namespace

void FitSums(const std::vector<PreparedObject>& objects, GradientSums* sums) {
  sums->objects.resize(objects.size());
  for (std::size_t i = 0; i < objects.size(); ++i) {
    const DifferentiableObject& object = objects[i].object;
    ObjectSums& of = sums->objects[i];
    of.points.resize(object.mesh.vertices.size(), Eigen::Vector3d::Zero());
    of.normals.resize(objects[i].normals.size(), Eigen::Vector3d::Zero());
    of.colors.resize(object.vertex_colors.size(), Eigen::Vector3f::Zero());
    of.texels.resize(object.texture.values.size(), 0.0f);
    of.touched.resize((of.texels.size() + ObjectSums::kTexelBlock - 1) / ObjectSums::kTexelBlock,
                      0);
  }
}

void Collect(const std::vector<PreparedObject>& objects, const core::Camera& camera,
             bool smooth_normals, std::vector<GradientSums>* sums, SceneGradients* gradients) {
  FitGradients(objects, gradients);
  for (std::size_t i = 0; i < objects.size(); ++i) {
    TransformToWorld(objects[i], i, camera, sums, &gradients->camera);
    bool normals = false;
    for (GradientSums& of : *sums) {
      normals = normals || of.objects[i].normals_touched;
      of.objects[i].normals_touched = false;
    }
    if (normals) PropagateNormals(objects[i], i, smooth_normals, sums);
    ObjectGradients& to = gradients->objects[i];
    TakePoints(objects[i], i, sums, &to);
    TakeColors(i, sums, &to.vertex_colors);
    CollectTexels(i, sums, &to.texture);
  }
  for (GradientSums& of : *sums) {
    gradients->light += of.light;
    gradients->camera.fx += of.fx;
    gradients->camera.fy += of.fy;
    gradients->camera.cx += of.cx;
    gradients->camera.cy += of.cy;
    of.light.setZero();
    of.fx = of.fy = of.cx = of.cy = 0.0;
  }
}

}  // namespace simwright::render
