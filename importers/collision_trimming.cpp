#include "importers/collision_trimming.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <set>
#include <tuple>
#include <utility>
#include <vector>

#include "asset_build/link_overlap.h"
#include "assets/joint_poses.h"
#include "core/finding_text.h"
#include "core/parallel.h"
#include "core/progress.h"
#include "geometry/convex_cut.h"
#include "geometry/distance.h"
#include "geometry/weld.h"

namespace simwright::importers {
namespace {

using assets::Joint;
using assets::UrdfModel;

constexpr int kTrimmingSteps = 48;  // positions over a joint's range: 2 degrees of a door
constexpr int kFewSteps = 6;
constexpr double kLeastLeft = 0.3;  // of a part's volume that must remain after a cut

// A half-space that a part must stay in: normal . x <= offset, in its link's frame.
struct Cut {
  Eigen::Vector3d normal;
  double offset = 0.0;  // m
};

struct PartPlace {
  size_t link = 0, part = 0;
  bool operator<(const PartPlace& other) const {
    return std::tie(link, part) < std::tie(other.link, other.part);
  }
};

struct PairContacts {
  double depth = 0.0;  // m, deepest overlap in the range; negative if only the gap is too small
  std::vector<Cut> cuts;
};

// A contact of one part with another link (or the floor) at one joint position.
struct PartContact {
  PartPlace part;
  int against = 0;
  double depth = 0.0;
  Cut cut;
};

class Trimming {
 public:
  Trimming(const CollisionTrimmingOptions& options, UrdfModel* model)
      : options_(options),
        model_(model),
        groups_(*model),
        bears_(asset_build::SupportingLinks(*model)) {
    for (const assets::UrdfLink& link : model->links) {
      boxes_.emplace_back();
      for (const assets::UrdfShape& shape : link.collisions) {
        boxes_.back().push_back(core::Bounds(shape.mesh));
      }
    }
  }

  core::Findings Clear() {
    for (size_t joint = 0; joint < model_->joints.size(); ++joint) {
      if (!model_->joints[joint].Moves()) continue;
      core::CheckCancelled();
      // A few positions reveal the deep overlaps, so that the full sweep can skip those pairs.
      Sweep(joint, kFewSteps);
      ExcludeDeepOnes();
      Sweep(joint, kTrimmingSteps);
      Trim();
    }
    return std::move(findings_);
  }

 private:
  void Sweep(size_t joint, int steps) {
    contacts_.clear();
    const Joint& moved = model_->joints[joint];
    const bool turns = moved.type == assets::JointType::kContinuous;
    const double lower = turns ? -std::numbers::pi : moved.lower;
    const double upper = turns ? std::numbers::pi : moved.upper;
    const std::vector<bool> carried = groups_.CarriedBy(joint);
    const bool alone = std::count_if(model_->joints.begin(), model_->joints.end(),
                                     [](const Joint& j) { return j.Moves(); }) == 1;
    for (const bool others_up : {false, true}) {
      if (others_up && alone) continue;
      assets::JointPositions positions;
      for (const Joint& other : model_->joints) {
        if (others_up && other.Moves()) positions[other.name] = other.upper;
      }
      std::vector<std::vector<PartContact>> hits(static_cast<size_t>(steps) + 1);
      core::ParallelFor(steps + 1, [&](int i) {
        assets::JointPositions at = positions;
        at[moved.name] = lower + (upper - lower) * i / steps;
        Collide(carried, assets::LinkPoses(*model_, at), others_up, &hits[static_cast<size_t>(i)]);
      });
      for (const std::vector<PartContact>& some : hits) {
        for (const PartContact& one : some) {
          PairContacts& contacts = contacts_[{one.part, one.against}];
          contacts.depth = std::max(contacts.depth, one.depth);
          contacts.cuts.push_back(one.cut);
        }
      }
    }
  }

  const core::TriangleMesh& Mesh(const PartPlace& at) const {
    return model_->links[at.link].collisions[at.part].mesh;
  }

  void Collide(const std::vector<bool>& carried, const std::vector<Eigen::Isometry3d>& poses,
               bool others_up, std::vector<PartContact>* hits) const {
    for (size_t a = 0; a < carried.size(); ++a) {
      if (!carried[a]) continue;
      for (size_t part = 0; part < boxes_[a].size(); ++part) {
        if (options_.on_floor && !others_up && !bears_[a]) CollideFloor({a, part}, poses[a], hits);
      }
      for (size_t b = 0; b < carried.size(); ++b) {
        if (!carried[b] && !asset_build::IsExcluded(*model_, a, b)) CollideLink(a, b, poses, hits);
      }
    }
  }

  void CollideLink(size_t a, size_t b, const std::vector<Eigen::Isometry3d>& poses,
                   std::vector<PartContact>* hits) const {
    std::vector<Eigen::AlignedBox3d> others;
    for (const Eigen::AlignedBox3d& box : boxes_[b]) others.push_back(box.transformed(poses[b]));
    for (size_t part = 0; part < boxes_[a].size(); ++part) {
      const Eigen::AlignedBox3d box = boxes_[a][part].transformed(poses[a]);
      for (size_t other = 0; other < others.size(); ++other) {
        if (box.exteriorDistance(others[other]) >= options_.gap) continue;
        CollidePart({a, part}, {b, other}, poses, hits);
      }
    }
  }

  void CollidePart(const PartPlace& a, const PartPlace& b,
                   const std::vector<Eigen::Isometry3d>& poses,
                   std::vector<PartContact>* hits) const {
    const geometry::ConvexDistance found = geometry::SignedDistance(
        {Mesh(a).vertices}, poses[a.link], {Mesh(b).vertices}, poses[b.link]);
    if (found.distance >= 0.9 * options_.gap) return;
    hits->push_back(ContactOf(a, static_cast<int>(b.link), -found.distance, poses[a.link],
                              found.normal, found.normal.dot(found.point_b)));
  }

  void CollideFloor(const PartPlace& a, const Eigen::Isometry3d& a_pose,
                    std::vector<PartContact>* hits) const {
    double lowest = options_.gap;
    for (const Eigen::Vector3d& v : Mesh(a).vertices) lowest = std::min(lowest, (a_pose * v).z());
    if (lowest >= 0.9 * options_.gap) return;
    hits->push_back(ContactOf(a, kFloor, -lowest, a_pose, -Eigen::Vector3d::UnitZ(), 0.0));
  }

  // Returns the contact whose cut keeps part a on the near side of the plane normal . x = offset
  // (root's frame), less the gap.
  PartContact ContactOf(const PartPlace& a, int against, double depth,
                        const Eigen::Isometry3d& a_pose, const Eigen::Vector3d& normal,
                        double offset) const {
    return {a,
            against,
            depth,
            {a_pose.linear().transpose() * normal,
             offset - options_.gap - normal.dot(a_pose.translation())}};
  }

  // Returns the deepest overlap of each link and the link (or floor) that it collides with.
  std::map<std::pair<size_t, int>, double> DepthByPair() const {
    std::map<std::pair<size_t, int>, double> depths;
    for (const auto& [key, contacts] : contacts_) {
      double& depth = depths.emplace(std::pair{key.first.link, key.second}, 0.0).first->second;
      depth = std::max(depth, contacts.depth);
    }
    return depths;
  }

  void ExcludeDeepOnes() {
    for (const auto& [pair, depth] : DepthByPair()) {
      if (depth > options_.most) KeepOverlap(pair.first, pair.second, depth);
    }
  }

  // Excludes neighbours by a joint from contact, or reports the overlap of any other pair.
  void KeepOverlap(size_t link, int against, double depth) {
    const auto other = static_cast<size_t>(std::max(against, 0));
    if (against != kFloor && groups_.Adjacent(link, other)) {
      model_->excluded_pairs.emplace_back(model_->links[link].name, model_->links[other].name);
      Say("contact-excluded", core::Severity::kWarning, link,
          "it and " + NameOf(against) + " overlap by " + core::Millimetres(depth) +
              " in the range of their joint: they are excluded from contact in all formats",
          depth, "repair the file's meshes to enable contact between them");
    } else if (reported_.insert({link, against}).second) {
      Say("overlap", core::Severity::kWarning, link,
          "its collision parts overlap " + NameOf(against) + " by " + core::Millimetres(depth) +
              " during its motion",
          depth, "move one joint at a time, or repair the file's meshes");
    }
  }

  // Cuts the parts of each pair, if all of its parts can be cut enough.
  void Trim() {
    const auto depths = DepthByPair();
    std::set<std::pair<size_t, int>> too_deep;
    for (const auto& [pair, depth] : depths) {
      if (depth > options_.most) too_deep.insert(pair);
    }
    for (const auto& [key, contacts] : contacts_) {
      const std::pair<size_t, int> pair{key.first.link, key.second};
      if (too_deep.contains(pair)) continue;
      core::TriangleMesh& mesh = model_->links[key.first.link].collisions[key.first.part].mesh;
      core::TriangleMesh cut = mesh;
      for (const Cut& plane : contacts.cuts) {
        if (!cut.empty()) cut = geometry::CutConvex(cut, plane.normal, plane.offset);
      }
      if (cut.empty() || geometry::SignedVolume(cut) < kLeastLeft * geometry::SignedVolume(mesh)) {
        too_deep.insert(pair);
        continue;
      }
      mesh = std::move(cut);
      boxes_[key.first.link][key.first.part] = core::Bounds(mesh);
    }
    for (const auto& [pair, depth] : depths) {
      if (too_deep.contains(pair)) {
        KeepOverlap(pair.first, pair.second, depth);
      } else {
        Say("trimmed", core::Severity::kInfo, pair.first,
            "its collision parts were trimmed by at most " +
                core::Millimetres(std::max(depth, 0.0) + options_.gap) + " to clear " +
                NameOf(pair.second),
            depth);
      }
    }
  }

  std::string NameOf(int against) const {
    return against == kFloor ? "the floor"
                             : "'" + model_->links[static_cast<size_t>(against)].name + "'";
  }

  void Say(const std::string& code, core::Severity severity, size_t link,
           const std::string& sentence, double depth, const std::string& remedy = "") {
    findings_.push_back({code, severity, model_->links[link].name, sentence, 1e3 * depth, remedy});
  }

  static constexpr int kFloor = -1;
  const CollisionTrimmingOptions options_;
  UrdfModel* model_;
  const asset_build::LinkGroups groups_;
  const std::vector<bool> bears_;
  std::vector<std::vector<Eigen::AlignedBox3d>> boxes_;  // part AABBs by link, in the link's frame
  std::map<std::pair<PartPlace, int>, PairContacts> contacts_;  // by part and link (or floor)
  std::set<std::pair<size_t, int>> reported_;                   // pairs with a reported overlap
  core::Findings findings_;
};

}  // namespace

core::Findings TrimMovingParts(const CollisionTrimmingOptions& options, UrdfModel* model) {
  return Trimming(options, model).Clear();
}

}  // namespace simwright::importers
