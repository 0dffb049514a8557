#include "viewer/grasp_file.h"

#include <algorithm>
#include <numeric>

#include <Eigen/Geometry>

#include "viewer/document.h"

namespace simwright::viewer {
namespace {

constexpr std::uint64_t kMaxGraspFile = 64ull << 20;  // bytes
constexpr double kRotationTolerance = 1e-3;

Eigen::Isometry3d PoseOf(const core::JsonField& field) {
  const std::vector<core::JsonField> rows = field.Elements(4);
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  for (int row = 0; row < 3; ++row) {
    pose.matrix().row(row) = rows[static_cast<std::size_t>(row)].Vector<4>().transpose();
  }
  const Eigen::Matrix3d turn = pose.linear();
  const Eigen::Matrix3d difference = turn * turn.transpose() - Eigen::Matrix3d::Identity();
  if (difference.cwiseAbs().maxCoeff() > kRotationTolerance || turn.determinant() < 0.0) {
    field.Fail("must be a rigid motion: its rotation is not orthonormal");
  }
  return pose;
}

double QualityOf(const core::JsonField& field) {
  if (field.json().is_boolean()) return field.Flag() ? 1.0 : 0.0;
  return field.NumberWithin(-1e9, 1e9);
}

}  // namespace

core::OrderedJson ReadGrasps(const std::filesystem::path& file, std::size_t most) {
  const core::JsonDocument document = core::JsonDocument::Read(file, kMaxGraspFile);
  const core::JsonField grasps = document.root()["grasps"];
  const std::vector<core::JsonField> transforms = grasps["transforms"].Elements();
  std::vector<double> qualities(transforms.size(), 1.0);
  for (const char* member : {"quality", "qualities", "object_in_gripper"}) {
    if (!grasps.Has(member)) continue;
    const std::vector<core::JsonField> values = grasps[member].Elements(transforms.size());
    for (std::size_t i = 0; i < values.size(); ++i) qualities[i] = QualityOf(values[i]);
    break;
  }
  std::vector<std::size_t> order(transforms.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return qualities[a] > qualities[b]; });
  if (order.size() > most) order.resize(most);
  core::OrderedJson json = {{"count", transforms.size()},
                            {"shown", order.size()},
                            {"poses", core::OrderedJson::array()},
                            {"qualities", core::OrderedJson::array()}};
  for (const std::size_t i : order) {
    json["poses"].push_back(PoseNumbers(PoseOf(transforms[i])));
    json["qualities"].push_back(qualities[i]);
  }
  return json;
}

}  // namespace simwright::viewer
