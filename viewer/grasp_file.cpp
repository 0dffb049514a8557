#include "viewer/grasp_file.h"

#include <algorithm>
#include <numbers>
#include <numeric>

#include <Eigen/Geometry>

#include "viewer/document.h"

namespace simwright::viewer {
namespace {

constexpr std::uint64_t kMaxGraspFile = 64ull << 20;  // bytes
constexpr double kRotationTolerance = 1e-3;
constexpr double kPandaOpening = 0.08;  // m
constexpr double kPandaDepth = 0.1034;  // m, from the hand's frame to the fingertips

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

// Returns the tool's pose of a hand's pose in GraspGen's frame.
Eigen::Isometry3d ToolOf(Eigen::Isometry3d hand) {
  hand.rotate(Eigen::AngleAxisd(-0.5 * std::numbers::pi, Eigen::Vector3d::UnitZ()));
  hand.translate(Eigen::Vector3d(0.0, 0.0, kPandaDepth));
  return hand;
}

double QualityOf(const core::JsonField& field) {
  if (field.json().is_boolean()) return field.Flag() ? 1.0 : 0.0;
  return field.NumberWithin(-1e9, 1e9);
}

}  // namespace

core::OrderedJson ReadGrasps(const std::filesystem::path& file, std::size_t most) {
  const core::JsonDocument document = core::JsonDocument::Read(file, kMaxGraspFile);
  const core::JsonField grasps = document.root()["grasps"];
  const bool of_tool = grasps.Has("tool_transforms");
  const std::vector<core::JsonField> transforms =
      grasps[of_tool ? "tool_transforms" : "transforms"].Elements();
  std::vector<double> qualities(transforms.size(), 1.0);
  for (const char* member : {"quality", "qualities", "object_in_gripper"}) {
    if (!grasps.Has(member)) continue;
    const std::vector<core::JsonField> values = grasps[member].Elements(transforms.size());
    for (std::size_t i = 0; i < values.size(); ++i) qualities[i] = QualityOf(values[i]);
    break;
  }
  std::vector<double> openings(transforms.size(), kPandaOpening);
  if (grasps.Has("opening_m")) openings = grasps["opening_m"].Numbers(transforms.size());
  std::vector<std::size_t> order(transforms.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return qualities[a] > qualities[b]; });
  if (order.size() > most) order.resize(most);
  std::vector<core::JsonField> links;
  if (grasps.Has("link")) links = grasps["link"].Elements(transforms.size());
  core::OrderedJson json = {{"count", transforms.size()},
                            {"shown", order.size()},
                            {"poses", core::OrderedJson::array()},
                            {"qualities", core::OrderedJson::array()},
                            {"openings", core::OrderedJson::array()}};
  for (const std::size_t i : order) {
    const Eigen::Isometry3d pose = PoseOf(transforms[i]);
    json["poses"].push_back(PoseNumbers(of_tool ? pose : ToolOf(pose)));
    json["openings"].push_back(openings[i]);
    json["qualities"].push_back(qualities[i]);
    if (!links.empty()) json["links"].push_back(links[i].Name());
  }
  return json;
}

}  // namespace simwright::viewer
