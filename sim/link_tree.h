#pragma once

#include <memory>
#include <optional>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "sim/articulated_body.h"

namespace simwright::sim {

class BulletShape;

// Where a link of a body is among Bullet's links.
struct TreeLink {
  int carrier =
      0;  // the link that Bullet moves it with: itself, the root or one that a joint moves
  int bullet = -1;  // the carrier's index in Bullet; the root's is -1
  Eigen::Isometry3d carrier_from_link = Eigen::Isometry3d::Identity();
  // Of a carrier, with all that it carries: principal axes at the centre of mass, kg, kg m^2.
  Eigen::Isometry3d link_from_principal = Eigen::Isometry3d::Identity();
  double mass = 0.0;
  Eigen::Vector3d moments = Eigen::Vector3d::Zero();
  // Of the shape's principal frame from the carrier's; none where they are one.
  std::optional<Eigen::Isometry3d> offset = std::nullopt;
};

struct LinkTree {
  std::vector<TreeLink> links;  // by link
  int joint_count = 0;          // Bullet's links beside the root
};

// Each link is one of Bullet's. `shapes`: by link.
LinkTree WholeTree(const ArticulatedBody& body,
                   const std::vector<std::unique_ptr<BulletShape>>& shapes);
// Links on fixed joints move with what they are fixed to: a step of the Panda then has 9 links to
// go through instead of 12.
LinkTree FoldedTree(const ArticulatedBody& body,
                    const std::vector<std::unique_ptr<BulletShape>>& shapes);

}  // namespace simwright::sim
