#include "manipulation/gripper_penetration.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <unordered_set>

namespace simwright::manipulation {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;

void AddSurface(const core::TriangleMesh& mesh, const Isometry3d& tool_from_link, double spacing,
                std::vector<Vector3d>* points) {
  for (const Eigen::Vector3i& triangle : mesh.triangles) {
    const Vector3d a = tool_from_link * mesh.vertices[static_cast<size_t>(triangle[0])];
    const Vector3d b = tool_from_link * mesh.vertices[static_cast<size_t>(triangle[1])] - a;
    const Vector3d c = tool_from_link * mesh.vertices[static_cast<size_t>(triangle[2])] - a;
    const double longest = std::max({b.norm(), c.norm(), (b - c).norm()});
    const int steps = std::max(1, static_cast<int>(std::ceil(longest / spacing)));
    for (int i = 0; i <= steps; ++i) {
      for (int j = 0; i + j <= steps; ++j) {
        points->push_back(a + (i * b + j * c) / steps);
      }
    }
  }
}

// Returns one of the points in each cube of side `spacing`: meshes of round shapes are much finer.
std::vector<Vector3d> Thinned(const std::vector<Vector3d>& points, double spacing) {
  const auto hash = [](const std::array<int, 3>& cube) {
    size_t sum = 0;
    for (const int index : cube) sum = (sum + static_cast<size_t>(index)) * 0x9e3779b97f4a7c15u;
    return sum ^ (sum >> 32);
  };
  std::unordered_set<std::array<int, 3>, decltype(hash)> cubes(points.size(), hash);
  std::vector<Vector3d> thinned;
  for (const Vector3d& point : points) {
    const Eigen::Vector3i cube = (point / spacing).array().floor().cast<int>();
    if (cubes.insert({cube.x(), cube.y(), cube.z()}).second) thinned.push_back(point);
  }
  return thinned;
}

}  // namespace

SurfacePoints GripperSurface(const robot::RobotModel& robot, double spacing) {
  const assets::UrdfModel& urdf = robot.urdf;
  const std::vector<Isometry3d> poses =
      robot.LinkPoses(Eigen::VectorXd::Zero(robot.arm.size()), robot.gripper.open);
  const Isometry3d tool_from_root = poses[static_cast<size_t>(robot.tool_link)].inverse();
  const std::vector<bool> hand = robot.kinematics->Subtree(robot.arm_joints.back() + 1);
  std::vector<Vector3d> points;
  for (size_t l = 0; l < urdf.links.size(); ++l) {
    if (!hand[l]) continue;
    for (const assets::UrdfShape& shape : urdf.links[l].collisions) {
      AddSurface(shape.mesh, tool_from_root * poses[l], 0.5 * spacing, &points);
    }
  }
  return SurfacePoints(Thinned(points, 0.5 * spacing));
}

double PenetrationDepth(const SurfacePoints& surface, const Isometry3d& world_from_surface,
                        const BodyParts& body, const std::vector<Isometry3d>& world_from_links,
                        int gripped) {
  double deepest = 0.0;
  for (const Vector3d& point : surface.points) {
    deepest = std::max(deepest, -(world_from_surface * point).z());
  }
  return std::max(
      deepest, PenetrationIntoBody(surface, world_from_surface, body, world_from_links, gripped));
}

double PenetrationIntoBody(const SurfacePoints& surface, const Isometry3d& world_from_surface,
                           const BodyParts& body, const std::vector<Isometry3d>& world_from_links,
                           int gripped) {
  double deepest = 0.0;
  for (size_t l = 0; l < body.size(); ++l) {
    if (static_cast<int>(l) == gripped) continue;
    const Isometry3d link_from_surface = world_from_links[l].inverse() * world_from_surface;
    for (const ConvexPart& solid : body[l]) {
      deepest = std::max(deepest, PenetrationIntoPart(solid, surface, link_from_surface));
    }
  }
  return deepest;
}

std::vector<Isometry3d> WorldLinkPoses(const tasks::ArticulatedObject& object,
                                       const Isometry3d& root, const std::vector<double>& joints) {
  std::vector<Isometry3d> poses = tasks::LinkPosesOf(object, joints);
  for (Isometry3d& pose : poses) pose = root * pose;
  return poses;
}

SurfacePoints BodySurface(const sim::ArticulatedBody& body,
                          const std::vector<Isometry3d>& frame_from_links, double spacing) {
  std::vector<Vector3d> points;
  for (size_t l = 0; l < body.links.size(); ++l) {
    for (const core::TriangleMesh& part : body.links[l].parts) {
      AddSurface(part, frame_from_links[l], 0.5 * spacing, &points);
    }
  }
  return SurfacePoints(Thinned(points, 0.5 * spacing));
}

std::vector<SurfacePoints> RobotSurface(const robot::RobotModel& robot, double spacing) {
  std::vector<SurfacePoints> surface;
  for (const assets::UrdfLink& link : robot.urdf.links) {
    std::vector<Vector3d> points;
    for (const assets::UrdfShape& shape : link.collisions) {
      AddSurface(shape.mesh, Isometry3d::Identity(), 0.5 * spacing, &points);
    }
    surface.emplace_back(Thinned(points, 0.5 * spacing));
  }
  return surface;
}

}  // namespace simwright::manipulation
