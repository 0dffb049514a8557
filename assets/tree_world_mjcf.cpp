#include <algorithm>
#include <set>

#include <tinyxml2.h>
#include <Eigen/Eigenvalues>

#include "assets/tree_world.h"
#include "assets/xml_element.h"
#include "core/error.h"

namespace simwright::assets {
namespace {

using TreePrinter = tinyxml2::XMLPrinter;

constexpr double kTreeStep = 1e-3;      // s; stiff servos and stacks need it
constexpr size_t kMostTreeBodies = 28;  // contact bits of an int, less the floor's

std::string QuaternionNumbers(const Eigen::Isometry3d& pose) {
  const Eigen::Quaterniond q(pose.linear());
  return Numbers({q.w(), q.x(), q.y(), q.z()});
}

// Writes the bodies of one world, and collects its keyframe in the order of MuJoCo's joints.
class TreeMjcf {
 public:
  TreeMjcf(TreePrinter* printer, const std::vector<TreeBody>& bodies)
      : printer_(printer), bodies_(bodies) {}

  void WriteWorld(const std::string& name) {
    Element mujoco(printer_, "mujoco");
    mujoco.Set("model", name);
    // Masses are those of the inertials alone.
    Element(printer_, "compiler").Set("angle", "radian").Set("inertiafromgeom", "false");
    WriteOption();
    Element(printer_, "size").Set("njmax", "6000").Set("nconmax", "1000");
    WriteMeshes();
    {
      Element world(printer_, "worldbody");
      WriteSurroundings();
      for (size_t b = 0; b < bodies_.size(); ++b) WriteLink(b, 0);
    }
    WriteMimics();
    WriteMotors();
    Element keyframe(printer_, "keyframe");
    Element(printer_, "key").Set("name", "start").Set("qpos", positions_).Set("ctrl", targets_);
  }

 private:
  // The same solver settings as for rigid worlds (MjcfOption); damping of the servos is implicit.
  void WriteOption() {
    Element option(printer_, "option");
    option.Set("timestep", Number(kTreeStep))
        .Set("integrator", "implicit")
        .Set("solver", "Newton")
        .Set("tolerance", "1e-10")
        .Set("cone", "elliptic")
        .Set("impratio", "10");
    Element(printer_, "flag").Set("multiccd", "enable");
  }

  void WriteMeshes() {
    Element assets(printer_, "asset");
    const auto add = [&](const TreeShape& shape) {
      if (shape.capsule || shape.file.empty()) return;
      Element(printer_, "mesh").Set("name", shape.name).Set("file", shape.file);
    };
    for (const TreeBody& body : bodies_) {
      for (const TreeLink& link : body.links) {
        for (const TreeShape& shape : link.visuals) add(shape);
        for (const TreeShape& shape : link.collisions) add(shape);
      }
    }
  }

  void WriteSurroundings() {
    Element(printer_, "light").Set("pos", "0 0 3").Set("directional", "true");
    Element(printer_, "geom")
        .Set("name", "ground")
        .Set("type", "plane")
        .Set("size", "0 0 1")
        .Set("condim", "6")
        .Set("contype", "1")
        .Set("conaffinity", "1")
        .Set("friction", "0.01 1e-5 1e-5");
  }

  void WriteLink(size_t b, int link) {
    const TreeBody& body = bodies_[b];
    Element element(printer_, "body");
    element.Set("name", TreeLinkName(body, link));
    const Eigen::Isometry3d& pose =
        link == 0 ? body.world_from_root
                  : body.kinematics->joints()[static_cast<size_t>(link) - 1].parent_from_joint;
    element.Set("pos", Numbers(Eigen::Vector3d(pose.translation())))
        .Set("quat", QuaternionNumbers(pose));
    if (link > 0) {
      WriteJoint(body, link - 1);
    } else if (!body.fixed) {
      Element(printer_, "freejoint").Set("name", body.name + "_free");
      AddPosition(Numbers(Eigen::Vector3d(pose.translation())) + " " + QuaternionNumbers(pose));
    }
    const Inertial& inertial = body.kinematics->links()[static_cast<size_t>(link)].inertial;
    if (inertial.mass > 0.0) MjcfInertial(printer_, TreeInertial(inertial));
    WriteShapes(b, body.links[static_cast<size_t>(link)]);
    const std::vector<int>& parents = body.kinematics->parents();
    for (size_t j = 0; j < parents.size(); ++j) {
      if (parents[j] == link) WriteLink(b, static_cast<int>(j) + 1);
    }
  }

  void WriteJoint(const TreeBody& body, int index) {
    const Joint& joint = body.kinematics->joints()[static_cast<size_t>(index)];
    if (!joint.Moves()) return;
    const bool slides = joint.type == JointType::kPrismatic;
    Element element(printer_, "joint");
    element.Set("name", TreeJointName(body, index))
        .Set("type", slides ? "slide" : "hinge")
        .Set("axis", Numbers(joint.axis))
        .Set("damping", Number(joint.damping));
    if (joint.type != JointType::kContinuous) {
      element.Set("limited", "true").Set("range", Numbers({joint.lower, joint.upper}));
    }
    if (joint.friction > 0.0) {
      // The stiffest values that MuJoCo permits, as in an asset's own MJCF: else lids creep.
      element.Set("frictionloss", Number(joint.friction))
          .Set("solreffriction", "0.004 1")
          .Set("solimpfriction", "0.9999 0.9999 0.001 0.5 2");
    }
    AddPosition(Number(body.positions[static_cast<size_t>(index)]));
  }

  // Bodies collide with each other and with the floor (bit 1), but not with themselves.
  void WriteShapes(size_t b, const TreeLink& link) {
    for (const TreeShape& shape : link.visuals) {
      Element(printer_, "geom")
          .Set("type", "mesh")
          .Set("mesh", shape.name)
          .Set("contype", "0")
          .Set("conaffinity", "0")
          .Set("group", "2")
          .Set("rgba",
               Numbers({shape.color.x(), shape.color.y(), shape.color.z(), shape.color.w()}));
    }
    const unsigned own = 2u << b;
    const unsigned all = (2u << bodies_.size()) - 1u;
    const unsigned others = (all & ~own & ~1u) | (link.meets_floor ? 1u : 0u);
    for (const TreeShape& shape : link.collisions) {
      Element geom(printer_, "geom");
      geom.Set("name", shape.name).Set("group", "3");
      if (shape.capsule) {
        WriteCapsule(*shape.capsule, &geom);
      } else {
        geom.Set("type", "mesh").Set("mesh", shape.name);
      }
      geom.Set("contype", std::to_string(own))
          .Set("conaffinity", std::to_string(others))
          .Set("condim", "4")
          .Set("friction", Numbers({link.friction, 0.005, 0.0001}))
          .Set("solref", Numbers({0.005, DampingRatio(link.restitution)}));
      if (link.friction_prevails) geom.Set("priority", "1");
    }
  }

  static void WriteCapsule(const TreeCapsule& capsule, Element* geom) {
    if ((capsule.a - capsule.b).norm() < 1e-9) {
      geom->Set("type", "sphere")
          .Set("pos", Numbers(capsule.a))
          .Set("size", Number(capsule.radius));
      return;
    }
    geom->Set("type", "capsule")
        .Set("fromto", Numbers(capsule.a) + " " + Numbers(capsule.b))
        .Set("size", Number(capsule.radius));
  }

  void WriteMimics() {
    Element equality(printer_, "equality");
    for (const TreeBody& body : bodies_) {
      const std::vector<Joint>& joints = body.kinematics->joints();
      for (size_t j = 0; j < joints.size(); ++j) {
        if (!joints[j].mimic || !joints[j].Moves()) continue;
        const int leader = body.kinematics->FindJoint(joints[j].mimic->joint);
        if (leader < 0) continue;
        Element(printer_, "joint")
            .Set("joint1", TreeJointName(body, static_cast<int>(j)))
            .Set("joint2", TreeJointName(body, leader))
            .Set("polycoef",
                 Numbers({joints[j].mimic->offset, joints[j].mimic->multiplier, 0, 0, 0}));
      }
    }
  }

  void WriteMotors() {
    Element actuator(printer_, "actuator");
    for (const TreeBody& body : bodies_) {
      for (const TreeMotor& motor : body.motors) {
        const std::string name = TreeJointName(body, motor.joint);
        Element(printer_, "general")
            .Set("name", name)
            .Set("joint", name)
            .Set("biastype", "affine")
            .Set("gainprm", Number(motor.stiffness))
            .Set("biasprm", Numbers({0.0, -motor.stiffness, -motor.damping}))
            .Set("forcelimited", "true")
            .Set("forcerange", Numbers({-motor.force, motor.force}));
        targets_ += (targets_.empty() ? "" : " ") + Number(motor.target);
      }
    }
  }

  void AddPosition(const std::string& position) {
    positions_ += (positions_.empty() ? "" : " ") + position;
  }

  TreePrinter* printer_;
  const std::vector<TreeBody>& bodies_;
  std::string positions_, targets_;
};

}  // namespace

void RequireTreeNames(const std::vector<TreeBody>& bodies) {
  if (bodies.size() > kMostTreeBodies) {
    throw core::Error("a world has at most " + std::to_string(kMostTreeBodies) + " bodies",
                      std::to_string(bodies.size()));
  }
  std::set<std::string> names, links = {"world"}, joints, shapes = {"ground"};
  const auto add = [](std::set<std::string>* set, const std::string& name) {
    if (!set->insert(name).second) {
      throw core::Error("two elements of the world have the same name", name);
    }
  };
  for (const TreeBody& body : bodies) {
    add(&names, body.name);
    for (size_t l = 0; l < body.links.size(); ++l) {
      add(&links, TreeLinkName(body, static_cast<int>(l)));
      for (const TreeShape& shape : body.links[l].visuals) add(&shapes, shape.name);
      for (const TreeShape& shape : body.links[l].collisions) add(&shapes, shape.name);
    }
    for (size_t j = 0; j < body.kinematics->joints().size(); ++j) {
      add(&joints, TreeJointName(body, static_cast<int>(j)));
    }
  }
}

Inertial TreeInertial(const Inertial& inertial) {
  const Eigen::Vector3d moments =
      Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(inertial.inertia).eigenvalues();
  if (moments[0] + moments[1] >= moments[2]) return inertial;
  Inertial balanced = inertial;
  balanced.inertia = moments.mean() * Eigen::Matrix3d::Identity();
  return balanced;
}

std::string TreeLinkName(const TreeBody& body, int link) {
  if (body.prefix.empty()) return body.kinematics->links()[static_cast<size_t>(link)].name;
  if (link == 0) return body.prefix;
  return body.prefix + "_" + body.kinematics->links()[static_cast<size_t>(link)].name;
}

std::string TreeJointName(const TreeBody& body, int joint) {
  const std::string& name = body.kinematics->joints()[static_cast<size_t>(joint)].name;
  return body.prefix.empty() ? name : body.prefix + "_" + name;
}

std::string TreeWorldMjcf(const std::string& name, const std::vector<TreeBody>& bodies) {
  RequireTreeNames(bodies);
  TreePrinter printer;
  TreeMjcf(&printer, bodies).WriteWorld(name);
  return printer.CStr();
}

}  // namespace simwright::assets
