#include "skills/skill_visuals.h"

#include <algorithm>
#include <map>
#include <sstream>
#include <utility>

namespace simwright::skills {
namespace {

using Piece = SkillVisuals::Piece;

const Eigen::Vector4f kRobotPaint(0.90f, 0.91f, 0.93f, 1.0f);
const Eigen::Vector4f kFingerPaint(0.35f, 0.36f, 0.40f, 1.0f);
const Eigen::Vector4f kObjectPaint(0.75f, 0.72f, 0.66f, 1.0f);
// Primitives of a link often overlap with sides in one plane, where their colours would flicker:
// each is smaller than its successor by this length (m).
constexpr double kInset = 2e-6;

// Appends a mesh without textures to another.
void AppendPlain(const core::TexturedMesh& addition, core::TexturedMesh* mesh) {
  const auto first = static_cast<int>(mesh->materials.size());
  core::Append(addition.mesh, &mesh->mesh);
  for (std::size_t t = 0; t < addition.mesh.triangles.size(); ++t) {
    const int own = addition.triangle_material.empty() ? 0 : addition.triangle_material[t];
    mesh->triangle_material.push_back(first + own);
  }
  mesh->materials.insert(mesh->materials.end(), addition.materials.begin(),
                         addition.materials.end());
  if (addition.materials.empty()) mesh->materials.push_back({"plain", kObjectPaint, -1});
}

// Moves the sides of a shape inwards by `distance` (m) along each axis, about its middle.
void Inset(double distance, core::TriangleMesh* mesh) {
  const Eigen::AlignedBox3d box = core::Bounds(*mesh);
  const Eigen::Vector3d half = (0.5 * box.sizes()).cwiseMax(10.0 * distance);
  const Eigen::Vector3d factors = Eigen::Vector3d::Ones() - distance * half.cwiseInverse();
  for (Eigen::Vector3d& vertex : mesh->vertices) {
    vertex = box.center() + factors.cwiseProduct(vertex - box.center());
  }
}

// Reads visuals and prepares meshes; equal files at equal places share one.
class VisualReader {
 public:
  // Adds the pieces of one robot or object: one for each link, and for each textured shape.
  template <typename PaintOf, typename LabelOf>
  void Add(const std::vector<assets::LinkVisual>& visuals, int object, const PaintOf& paint,
           const LabelOf& label, std::vector<Piece>* pieces) {
    for (std::size_t i = 0; i < visuals.size();) {
      const int link = visuals[i].link;
      core::TexturedMesh plain;
      std::size_t end = i;
      while (end < visuals.size() && visuals[end].link == link) ++end;
      for (; i < end; ++i) {
        if (!visuals[i].file.empty()) {
          pieces->push_back({OfFile(visuals[i], paint(link)), object, link, label(link)});
          continue;
        }
        core::TexturedMesh mesh = assets::ReadVisual(visuals[i], paint(link));
        if (mesh.mesh.empty()) continue;
        Inset(kInset * static_cast<double>(end - 1 - i), &mesh.mesh);
        AppendPlain(mesh, &plain);
      }
      if (plain.mesh.empty()) continue;
      pieces->push_back({std::make_shared<render::RigidMesh>(plain), object, link, label(link)});
    }
  }

 private:
  std::shared_ptr<const render::RigidMesh> OfFile(const assets::LinkVisual& visual,
                                                  const Eigen::Vector4f& paint) {
    std::ostringstream key;
    key.precision(17);
    key << visual.file << '\n' << visual.link_from_file.matrix();
    if (visual.color) key << '\n' << visual.color->transpose();
    std::shared_ptr<const render::RigidMesh>& mesh = meshes_[key.str()];
    if (!mesh) mesh = std::make_shared<render::RigidMesh>(assets::ReadVisual(visual, paint));
    return mesh;
  }

  std::map<std::string, std::shared_ptr<const render::RigidMesh>> meshes_;
};

// Returns, by link of an object, true if the target's joint moves it.
std::vector<bool> TargetLinks(const SkillVariant& variant, int object) {
  const tasks::ArticulatedObject& known = variant.model.objects[static_cast<std::size_t>(object)];
  if (!variant.target || variant.target->object != object || variant.target->joint < 0) {
    return std::vector<bool>(known.links.size(), false);
  }
  const auto joint = static_cast<std::size_t>(variant.target->joint);
  return known.kinematics->Subtree(known.joints[joint].link);
}

std::vector<LabelName> MakeLegend(const SkillVariant& variant) {
  std::vector<LabelName> legend = {{-1, "nothing", false},
                                   {kBackdropLabel, "floor", false},
                                   {kRobotLabel, "robot", false},
                                   {kGripperLabel, "gripper", false}};
  std::vector<int> placed = variant.placed;
  std::sort(placed.begin(), placed.end());
  for (const int object : placed) {
    const tasks::ArticulatedObject& known = variant.model.objects[static_cast<std::size_t>(object)];
    const bool target = variant.target && variant.target->object == object;
    const bool joint = target && variant.target->joint >= 0;
    legend.push_back({ObjectLabel(object), known.name, target && !joint});
    if (!joint) continue;
    const int link = known.joints[static_cast<std::size_t>(variant.target->joint)].link;
    legend.push_back({TargetLinkLabel(object), known.name + "/" + known.LinkName(link), true});
  }
  return legend;
}

}  // namespace

std::vector<bool> GripperLinks(const robot::RobotModel& robot) {
  if (robot.gripper.links.empty()) return std::vector<bool>(robot.urdf.links.size(), false);
  const int carrier = robot.kinematics->ParentLink(robot.gripper.links.front());
  return robot.kinematics->Subtree(std::max(0, carrier));
}

SkillVisuals::SkillVisuals(const Skill& skill) {
  VisualReader reader;
  const robot::RobotModel& robot = *skill.robot;
  const std::vector<bool> gripper = GripperLinks(robot);
  const std::vector<int>& fingers = robot.gripper.links;
  std::vector<Piece> arm;
  reader.Add(
      assets::LinkVisuals(robot.urdf), -1,
      [&](int link) {
        const bool finger = std::find(fingers.begin(), fingers.end(), link) != fingers.end();
        return finger ? kFingerPaint : kRobotPaint;
      },
      [&](int link) {
        return gripper[static_cast<std::size_t>(link)] ? kGripperLabel : kRobotLabel;
      },
      &arm);
  for (const SkillVariant& variant : skill.variants) {
    std::vector<Piece>& pieces = pieces_.emplace_back(arm);
    for (const int object : variant.placed) {
      const std::vector<bool> target = TargetLinks(variant, object);
      reader.Add(
          variant.visuals[static_cast<std::size_t>(object)], object,
          [](int) { return kObjectPaint; },
          [&](int link) {
            return target[static_cast<std::size_t>(link)] ? TargetLinkLabel(object)
                                                          : ObjectLabel(object);
          },
          &pieces);
    }
    legends_.push_back(MakeLegend(variant));
  }
}

}  // namespace simwright::skills
