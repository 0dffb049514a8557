#include "sim/link_tree.h"

#include "geometry/mass_properties.h"
#include "sim/bullet_shape.h"

namespace simwright::sim {
namespace {

// Returns the combined inertial of `link` and all links that it carries, in its frame.
assets::Inertial CarriedInertial(const ArticulatedBody& body, const std::vector<TreeLink>& carried,
                                 int link) {
  assets::Inertial whole;
  whole.inertia.setZero();
  const auto each = [&](const auto& add) {
    for (size_t i = 0; i < body.links.size(); ++i) {
      const assets::Inertial& part = body.links[i].inertial;
      if (carried[i].carrier != link || !(part.mass > 0.0)) continue;
      add(part, carried[i].carrier_from_link);
    }
  };
  each([&](const assets::Inertial& part, const Eigen::Isometry3d& pose) {
    whole.mass += part.mass;
    whole.center_of_mass += part.mass * (pose * part.center_of_mass);
  });
  if (!(whole.mass > 0.0)) return body.links[static_cast<size_t>(link)].inertial;
  whole.center_of_mass /= whole.mass;
  each([&](const assets::Inertial& part, const Eigen::Isometry3d& pose) {
    const Eigen::Vector3d d = pose * part.center_of_mass - whole.center_of_mass;
    whole.inertia += pose.linear() * part.inertia * pose.linear().transpose() +
                     part.mass * (d.squaredNorm() * Eigen::Matrix3d::Identity() -
                                  d * d.transpose());  // parallel axis theorem
  });
  return whole;
}

}  // namespace

LinkTree WholeTree(const ArticulatedBody& body,
                   const std::vector<std::unique_ptr<BulletShape>>& shapes) {
  LinkTree tree;
  tree.links.resize(body.links.size());
  tree.joint_count = static_cast<int>(body.joints().size());
  for (size_t i = 0; i < body.links.size(); ++i) {
    TreeLink& link = tree.links[i];
    link.carrier = static_cast<int>(i);
    link.bullet = link.carrier - 1;
    link.link_from_principal = shapes[i]->body_from_principal();
    link.mass = body.links[i].inertial.mass;
    link.moments = shapes[i]->moments();
  }
  return tree;
}

LinkTree FoldedTree(const ArticulatedBody& body,
                    const std::vector<std::unique_ptr<BulletShape>>& shapes) {
  LinkTree tree = WholeTree(body, shapes);
  tree.joint_count = 0;
  std::vector<bool> carries(body.links.size(), false);  // a link with a mass
  for (size_t i = 1; i < body.links.size(); ++i) {
    TreeLink& link = tree.links[i];
    if (body.joints()[i - 1].Moves()) {
      link.bullet = tree.joint_count++;
      continue;
    }
    const TreeLink& parent = tree.links[static_cast<size_t>(body.kinematics->parents()[i - 1])];
    link.carrier = parent.carrier;
    link.bullet = parent.bullet;
    link.carrier_from_link = parent.carrier_from_link * body.joints()[i - 1].parent_from_joint;
    if (link.mass > 0.0) carries[static_cast<size_t>(link.carrier)] = true;
  }
  for (size_t i = 0; i < body.links.size(); ++i) {
    if (!carries[i]) continue;
    TreeLink& link = tree.links[i];
    const assets::Inertial whole = CarriedInertial(body, tree.links, static_cast<int>(i));
    const geometry::PrincipalInertia principal = geometry::PrincipalInertiaOf(whole.inertia);
    link.link_from_principal =
        Eigen::Translation3d(whole.center_of_mass) * Eigen::Isometry3d(principal.axes);
    link.mass = whole.mass;
    link.moments = principal.moments;
  }
  for (size_t i = 0; i < body.links.size(); ++i) {
    TreeLink& link = tree.links[i];
    const auto carrier = static_cast<size_t>(link.carrier);
    if (carrier == i && !carries[i]) continue;
    link.offset = tree.links[carrier].link_from_principal.inverse() * link.carrier_from_link *
                  shapes[i]->body_from_principal();
  }
  return tree;
}

}  // namespace simwright::sim
