#include "assets/model_writer.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <initializer_list>

#include <tinyxml2.h>
#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>

#include "geometry/mass_properties.h"

namespace simwright::assets {
namespace {

std::string Number(double value) {
  char text[40];
  std::snprintf(text, sizeof(text), "%.17g", value);
  return text;
}

std::string Numbers(std::initializer_list<double> values) {
  std::string text;
  for (const double value : values) text += (text.empty() ? "" : " ") + Number(value);
  return text;
}

std::string Numbers(const Eigen::Vector3d& v) {
  return Numbers({v.x(), v.y(), v.z()});
}

// Nested elements with attributes; closes itself.
class Element {
 public:
  Element(tinyxml2::XMLPrinter* printer, const char* name) : printer_(printer) {
    printer_->OpenElement(name);
  }
  ~Element() { printer_->CloseElement(); }
  Element(const Element&) = delete;
  Element& operator=(const Element&) = delete;
  Element& Set(const char* name, const std::string& value) {
    printer_->PushAttribute(name, value.c_str());
    return *this;
  }
  void Text(const std::string& text) { printer_->PushText(text.c_str()); }

 private:
  tinyxml2::XMLPrinter* printer_;
};

void Leaf(tinyxml2::XMLPrinter* printer, const char* name, const std::string& text) {
  Element(printer, name).Text(text);
}

void UrdfMesh(tinyxml2::XMLPrinter* printer, const char* role, const std::string& file) {
  Element owner(printer, role);
  Element(printer, "origin").Set("xyz", "0 0 0").Set("rpy", "0 0 0");
  Element geometry(printer, "geometry");
  Element(printer, "mesh").Set("filename", file);
}

void SdfMesh(tinyxml2::XMLPrinter* printer, const char* role, const std::string& name,
             const std::string& file, const Asset* surface_of) {
  Element owner(printer, role);
  owner.Set("name", name);
  {
    Element geometry(printer, "geometry");
    Element mesh(printer, "mesh");
    Leaf(printer, "uri", file);
  }
  if (surface_of == nullptr) return;
  Element surface(printer, "surface");
  {
    Element friction(printer, "friction");
    Element ode(printer, "ode");
    Leaf(printer, "mu", Number(surface_of->friction));
    Leaf(printer, "mu2", Number(surface_of->friction));
  }
  Element bounce(printer, "bounce");
  Leaf(printer, "restitution_coefficient", Number(surface_of->restitution));
}

// MuJoCo's spring-damper contact has no coefficient of restitution. A damping ratio gives one:
// e = exp(-pi d / sqrt(1 - d^2)) for a linear spring and damper; never under 0.4, where stacks
// ring, and 1 for what hardly bounces.
double DampingRatio(double restitution) {
  const double e = std::clamp(restitution, 0.01, 0.99);
  const double l = std::log(e);
  return std::clamp(std::abs(l) / std::sqrt(M_PI * M_PI + l * l), 0.4, 1.0);
}

void MjcfAssets(tinyxml2::XMLPrinter* printer, const Asset& asset, bool textured) {
  Element assets(printer, "asset");
  if (textured) {
    Element(printer, "texture")
        .Set("name", asset.name + "_texture")
        .Set("type", "2d")
        .Set("file", "texture.png");
    Element(printer, "material")
        .Set("name", asset.name + "_material")
        .Set("texture", asset.name + "_texture");
  }
  Element(printer, "mesh")
      .Set("name", asset.name + "_visual")
      .Set("file", VisualSuitsMujoco(asset.visual.mesh) ? "visual.obj" : "solid.obj");
  for (size_t i = 0; i < asset.parts.size(); ++i) {
    const std::string file = CollisionFileName(static_cast<int>(i));
    Element(printer, "mesh")
        .Set("name", asset.name + "_" + file.substr(0, file.find('.')))
        .Set("file", file);
  }
}

void MjcfBody(tinyxml2::XMLPrinter* printer, const Asset& asset, bool textured) {
  Element body(printer, "body");
  body.Set("name", asset.name);
  Element(printer, "freejoint").Set("name", asset.name + "_free");
  // On principal axes: found by MuJoCo 2.2 they were off by up to 1e-6 of the inertia.
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes(asset.inertial.inertia);
  Eigen::Matrix3d rotation = axes.eigenvectors();
  if (rotation.determinant() < 0.0) rotation.col(0) *= -1.0;
  const Eigen::Quaterniond quat(rotation);
  const Eigen::Vector3d& moments = axes.eigenvalues();
  Element(printer, "inertial")
      .Set("pos", Numbers(asset.inertial.center_of_mass))
      .Set("quat", Numbers({quat.w(), quat.x(), quat.y(), quat.z()}))
      .Set("mass", Number(asset.inertial.mass))
      .Set("diaginertia", Numbers({moments.x(), moments.y(), moments.z()}));
  {
    Element visual(printer, "geom");
    visual.Set("type", "mesh")
        .Set("mesh", asset.name + "_visual")
        .Set("contype", "0")
        .Set("conaffinity", "0")
        .Set("group", "2");
    if (textured) {
      visual.Set("material", asset.name + "_material");
    } else if (!asset.visual.materials.empty()) {
      const Eigen::Vector4f& c = asset.visual.materials[0].base_color;
      visual.Set("rgba", Numbers({c.x(), c.y(), c.z(), 1.0}));
    }
  }
  for (size_t i = 0; i < asset.parts.size(); ++i) {
    const std::string file = CollisionFileName(static_cast<int>(i));
    Element(printer, "geom")
        .Set("type", "mesh")
        .Set("mesh", asset.name + "_" + file.substr(0, file.find('.')))
        .Set("group", "3")
        .Set("condim", "6")
        .Set("friction", Numbers({asset.friction, asset.rolling_friction, asset.rolling_friction}))
        .Set("solref", Numbers({0.005, DampingRatio(asset.restitution)}));
  }
}

}  // namespace

std::string CollisionFileName(int part) {
  char name[32];
  std::snprintf(name, sizeof(name), "collision_%03d.obj", part);
  return name;
}

bool VisualSuitsMujoco(const core::TriangleMesh& visual) {
  if (visual.triangles.size() > 200'000) return false;
  // MuJoCo 2.2 sums |volume| of the cones over all faces from their centre and refuses < 1e-15.
  double volume = 0.0;
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3d& vertex : visual.vertices) centre += vertex;
  centre /= std::max<double>(1.0, static_cast<double>(visual.vertices.size()));
  for (size_t i = 0; i < visual.triangles.size(); ++i) {
    const Eigen::Vector3d& corner = visual.vertices[visual.triangles[i][0]];
    volume += core::TriangleAreaVector(visual, static_cast<int>(i)).dot(corner - centre) / 6.0;
  }
  return std::abs(volume) > 1e-10;
}

std::string UrdfText(const Asset& asset) {
  tinyxml2::XMLPrinter printer;
  printer.PushHeader(false, true);
  {
    Element robot(&printer, "robot");
    robot.Set("name", asset.name);
    Element link(&printer, "link");
    link.Set("name", asset.name);
    {
      Element inertial(&printer, "inertial");
      Element(&printer, "origin")
          .Set("xyz", Numbers(asset.inertial.center_of_mass))
          .Set("rpy", "0 0 0");
      Element(&printer, "mass").Set("value", Number(asset.inertial.mass));
      const Eigen::Matrix3d& I = asset.inertial.inertia;
      Element(&printer, "inertia")
          .Set("ixx", Number(I(0, 0)))
          .Set("ixy", Number(I(0, 1)))
          .Set("ixz", Number(I(0, 2)))
          .Set("iyy", Number(I(1, 1)))
          .Set("iyz", Number(I(1, 2)))
          .Set("izz", Number(I(2, 2)));
    }
    UrdfMesh(&printer, "visual", "visual.obj");
    for (size_t i = 0; i < asset.parts.size(); ++i) {
      UrdfMesh(&printer, "collision", CollisionFileName(static_cast<int>(i)));
    }
    // Bullet's and Gazebo's extension: friction and bounce travel with the link.
    Element contact(&printer, "contact");
    Element(&printer, "lateral_friction").Set("value", Number(asset.friction));
    Element(&printer, "rolling_friction").Set("value", Number(asset.rolling_friction));
    Element(&printer, "restitution").Set("value", Number(asset.restitution));
  }
  return printer.CStr();
}

std::string SdfText(const Asset& asset) {
  tinyxml2::XMLPrinter printer;
  printer.PushHeader(false, true);
  {
    Element sdf(&printer, "sdf");
    sdf.Set("version", "1.9");
    Element model(&printer, "model");
    model.Set("name", asset.name);
    Element link(&printer, "link");
    link.Set("name", asset.name);
    {
      Element inertial(&printer, "inertial");
      const Eigen::Vector3d& c = asset.inertial.center_of_mass;
      Leaf(&printer, "pose", Numbers({c.x(), c.y(), c.z(), 0, 0, 0}));
      Leaf(&printer, "mass", Number(asset.inertial.mass));
      Element inertia(&printer, "inertia");
      const Eigen::Matrix3d& I = asset.inertial.inertia;
      Leaf(&printer, "ixx", Number(I(0, 0)));
      Leaf(&printer, "ixy", Number(I(0, 1)));
      Leaf(&printer, "ixz", Number(I(0, 2)));
      Leaf(&printer, "iyy", Number(I(1, 1)));
      Leaf(&printer, "iyz", Number(I(1, 2)));
      Leaf(&printer, "izz", Number(I(2, 2)));
    }
    SdfMesh(&printer, "visual", "visual", "visual.obj", nullptr);
    for (size_t i = 0; i < asset.parts.size(); ++i) {
      const std::string file = CollisionFileName(static_cast<int>(i));
      SdfMesh(&printer, "collision", file.substr(0, file.find('.')), file, &asset);
    }
  }
  return printer.CStr();
}

std::string MjcfText(const Asset& asset) {
  tinyxml2::XMLPrinter printer;
  {
    Element mujoco(&printer, "mujoco");
    mujoco.Set("model", asset.name);
    Element(&printer, "compiler").Set("angle", "radian");
    {
      Element option(&printer, "option");
      // The default tolerance lets light things with many contacts tremble; at 1e-14 a cup of a
      // few grams rests still. Elliptic cones tremble less than pyramids, and with impratio 10
      // held things slip less.
      option.Set("timestep", "0.002")
          .Set("solver", "Newton")
          .Set("tolerance", "1e-14")
          .Set("cone", "elliptic")
          .Set("impratio", "10");
      Element(&printer, "flag").Set("multiccd", "enable");
    }
    {
      // MuJoCo 2.2 reserves 500 rows of constraints and 100 contacts, which a thing of many parts
      // overflows (three contacts of six rows a part on a plane), and memory for their square:
      // not more rows than a lying comb needs.
      const int parts = static_cast<int>(asset.parts.size());
      Element(&printer, "size")
          .Set("njmax", std::to_string(std::min(500 + 40 * parts, 2500)))
          .Set("nconmax", std::to_string(100 + 4 * parts));
    }
    const bool textured = asset.visual.textures.size() == 1 && VisualSuitsMujoco(asset.visual.mesh);
    MjcfAssets(&printer, asset, textured);
    Element worldbody(&printer, "worldbody");
    MjcfBody(&printer, asset, textured);
  }
  return printer.CStr();
}

}  // namespace simwright::assets
