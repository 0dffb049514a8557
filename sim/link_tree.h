#pragma once

#include <memory>
#include <optional>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "sim/articulated_body.h"

namespace simwright::sim {

class BulletShape;

// The place of a body's link among Bullet's links.
struct TreeLink {
  // The link that Bullet moves it with: itself, the root or a link on a movable joint.
  int carrier = 0;
  int bullet = -1;  // the carrier's index in Bullet; the root's is -1
  Eigen::Isometry3d carrier_from_link = Eigen::Isometry3d::Identity();
  // The principal axes at the centre of mass, mass (kg) and moments (kg m^2) of a carrier with all
  // links that it carries.
  Eigen::Isometry3d link_from_principal = Eigen::Isometry3d::Identity();
  double mass = 0.0;
  Eigen::Vector3d moments = Eigen::Vector3d::Zero();
  // The pose of the shape's principal frame in the carrier's; none if they coincide.
  std::optional<Eigen::Isometry3d> offset = std::nullopt;
};

struct LinkTree {
  std::vector<TreeLink> links;  // by link
  int joint_count = 0;          // number of Bullet's links without the root
};

// Returns the tree with one Bullet link per link. `shapes`: by link.
LinkTree WholeTree(const ArticulatedBody& body,
                   const std::vector<std::unique_ptr<BulletShape>>& shapes);
// Returns the tree with links on fixed joints merged into their carrier: the Panda then has 9 links
// per step instead of 12.
LinkTree FoldedTree(const ArticulatedBody& body,
                    const std::vector<std::unique_ptr<BulletShape>>& shapes);

}  // namespace simwright::sim
