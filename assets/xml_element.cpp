#include "assets/xml_element.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include <tinyxml2.h>
#include <Eigen/Geometry>

#include "assets/principal_inertia.h"
#include "assets/sdf_material.h"

namespace simwright::assets {

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

Element::Element(tinyxml2::XMLPrinter* printer, const char* name) : printer_(printer) {
  printer_->OpenElement(name);
}

Element::~Element() {
  printer_->CloseElement();
}

Element& Element::Set(const char* name, const std::string& value) {
  printer_->PushAttribute(name, value.c_str());
  return *this;
}

void Element::Text(const std::string& text) {
  printer_->PushText(text.c_str());
}

void Leaf(tinyxml2::XMLPrinter* printer, const char* name, const std::string& text) {
  Element(printer, name).Text(text);
}

void UrdfVisual(tinyxml2::XMLPrinter* printer, const std::string& file) {
  Element visual(printer, "visual");
  Element(printer, "origin").Set("xyz", "0 0 0").Set("rpy", "0 0 0");
  Element geometry(printer, "geometry");
  Element(printer, "mesh").Set("filename", file);
}

void UrdfCollision(tinyxml2::XMLPrinter* printer, const std::string& file,
                   const HydroelasticContact& contact) {
  Element collision(printer, "collision");
  Element(printer, "origin").Set("xyz", "0 0 0").Set("rpy", "0 0 0");
  {
    Element geometry(printer, "geometry");
    Element mesh(printer, "mesh");
    mesh.Set("filename", file);
    Element(printer, "drake:declare_convex");
  }
  Element properties(printer, "drake:proximity_properties");
  Element(printer, "drake:compliant_hydroelastic");
  const auto property = [&](const char* name, double value) {
    Element(printer, name).Set("value", Number(value));
  };
  property("drake:hydroelastic_modulus", contact.modulus);
  property("drake:mesh_resolution_hint", contact.resolution_hint);
  property("drake:hunt_crossley_dissipation", contact.dissipation);
  property("drake:mu_static", contact.friction);
  property("drake:mu_dynamic", contact.friction);
}

void UrdfInertial(tinyxml2::XMLPrinter* printer, const Inertial& body) {
  Element inertial(printer, "inertial");
  Element(printer, "origin").Set("xyz", Numbers(body.center_of_mass)).Set("rpy", "0 0 0");
  Element(printer, "mass").Set("value", Number(body.mass));
  const Eigen::Matrix3d& I = body.inertia;
  Element(printer, "inertia")
      .Set("ixx", Number(I(0, 0)))
      .Set("ixy", Number(I(0, 1)))
      .Set("ixz", Number(I(0, 2)))
      .Set("iyy", Number(I(1, 1)))
      .Set("iyz", Number(I(1, 2)))
      .Set("izz", Number(I(2, 2)));
}

void UrdfContact(tinyxml2::XMLPrinter* printer, double friction, double rolling_friction,
                 double restitution) {
  Element contact(printer, "contact");
  Element(printer, "lateral_friction").Set("value", Number(friction));
  Element(printer, "rolling_friction").Set("value", Number(rolling_friction));
  Element(printer, "restitution").Set("value", Number(restitution));
}

void SdfInertial(tinyxml2::XMLPrinter* printer, const Inertial& source) {
  Element inertial(printer, "inertial");
  const Eigen::Vector3d& c = source.center_of_mass;
  Leaf(printer, "pose", Numbers({c.x(), c.y(), c.z(), 0, 0, 0}));
  Leaf(printer, "mass", Number(source.mass));
  Element inertia(printer, "inertia");
  const Eigen::Matrix3d& I = source.inertia;
  Leaf(printer, "ixx", Number(I(0, 0)));
  Leaf(printer, "ixy", Number(I(0, 1)));
  Leaf(printer, "ixz", Number(I(0, 2)));
  Leaf(printer, "iyy", Number(I(1, 1)));
  Leaf(printer, "iyz", Number(I(1, 2)));
  Leaf(printer, "izz", Number(I(2, 2)));
}

namespace {

void SdfGeometry(tinyxml2::XMLPrinter* printer, const std::string& file, bool convex) {
  Element geometry(printer, "geometry");
  Element mesh(printer, "mesh");
  if (convex) Element(printer, "drake:declare_convex");
  Leaf(printer, "uri", file);
}

}  // namespace

void SdfVisual(tinyxml2::XMLPrinter* printer, const std::string& name, const std::string& file,
               const Eigen::Vector4f* color) {
  Element visual(printer, "visual");
  visual.Set("name", name);
  SdfGeometry(printer, file, false);
  if (color != nullptr) SdfMaterial(printer, *color, nullptr, {});
}

void SdfCollision(tinyxml2::XMLPrinter* printer, const std::string& name, const std::string& file,
                  const HydroelasticContact& contact) {
  Element collision(printer, "collision");
  collision.Set("name", name);
  SdfGeometry(printer, file, true);
  {
    Element properties(printer, "drake:proximity_properties");
    Element(printer, "drake:compliant_hydroelastic");
    Leaf(printer, "drake:hydroelastic_modulus", Number(contact.modulus));
    Leaf(printer, "drake:mesh_resolution_hint", Number(contact.resolution_hint));
    Leaf(printer, "drake:hunt_crossley_dissipation", Number(contact.dissipation));
  }
  SdfSurface(printer, contact.friction);
}

void SdfSurface(tinyxml2::XMLPrinter* printer, double friction) {
  Element surface(printer, "surface");
  Element coulomb(printer, "friction");
  Element ode(printer, "ode");
  Leaf(printer, "mu", Number(friction));
  Leaf(printer, "mu2", Number(friction));
}

void MjcfOption(tinyxml2::XMLPrinter* printer, double time_step) {
  Element option(printer, "option");
  // With the default tolerance light objects with many contacts jitter; at 1e-14 a cup of a few
  // grams rests. Elliptic cones jitter less than pyramids, and with impratio 10 grasped objects
  // slip less.
  option.Set("timestep", Number(time_step))
      .Set("solver", "Newton")
      .Set("tolerance", "1e-14")
      .Set("cone", "elliptic")
      .Set("impratio", "10");
  Element(printer, "flag").Set("multiccd", "enable");
}

void MjcfInertial(tinyxml2::XMLPrinter* printer, const Inertial& inertial) {
  // The principal axes computed by MuJoCo 2.2 itself were off by up to 1e-6 of the inertia.
  const PrincipalInertia principal = PrincipalInertiaOf(inertial.inertia);
  const Eigen::Quaterniond& quat = principal.link_from_axes;
  const Eigen::Vector3d& moments = principal.moments;
  Element(printer, "inertial")
      .Set("pos", Numbers(inertial.center_of_mass))
      .Set("quat", Numbers({quat.w(), quat.x(), quat.y(), quat.z()}))
      .Set("mass", Number(inertial.mass))
      .Set("diaginertia", Numbers({moments.x(), moments.y(), moments.z()}));
}

double DampingRatio(double restitution) {
  const double e = std::clamp(restitution, 0.01, 0.99);
  const double l = std::log(e);
  return std::clamp(std::abs(l) / std::sqrt(M_PI * M_PI + l * l), 0.4, 1.0);
}

}  // namespace simwright::assets
