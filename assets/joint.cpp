#include "assets/joint.h"

namespace simwright::assets {

Eigen::Isometry3d JointMotion(const Joint& joint, double position) {
  switch (joint.type) {
    case JointType::kRevolute:
    case JointType::kContinuous:
      return Eigen::Isometry3d(Eigen::AngleAxisd(position, joint.axis));
    case JointType::kPrismatic:
      return Eigen::Isometry3d(Eigen::Translation3d(position * joint.axis));
    default:
      return Eigen::Isometry3d::Identity();
  }
}

}  // namespace simwright::assets
