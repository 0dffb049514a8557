#include "physics_params/physical_parameters.h"

#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "core/random.h"
#include "geometry/mass_properties.h"
#include "physics_params/rounded_text.h"

namespace simwright::physics_params {
namespace {

double Lerp(const Interval& range, double t) {
  return std::clamp(range.min + t * (range.max - range.min), range.min, range.max);
}

Estimate Sampled(const Interval& range, double t, const std::string& source) {
  return {range.min, range.max, Lerp(range, t), source};
}

const Material& SampleMaterial(const Category& category, const KnowledgeBase& base,
                               core::Rng& rng) {
  double total = 0.0;
  for (size_t i = 0; i < category.materials.size(); ++i) total += 1.0 / static_cast<double>(i + 1);
  double left = core::Uniform(rng) * total;
  size_t chosen = 0;
  for (; chosen + 1 < category.materials.size(); ++chosen) {
    left -= 1.0 / static_cast<double>(chosen + 1);
    if (left < 0.0) break;
  }
  return *base.FindMaterial(category.materials[chosen]);
}

}  // namespace

PhysicalParameters SampleParameters(const Category& category, const KnowledgeBase& base,
                                    std::uint64_t seed) {
  core::Rng rng(seed);
  PhysicalParameters p;
  p.category = category.name;
  p.fill = category.fill;
  p.shape = category.shape;
  const Material& material = SampleMaterial(category, base, rng);
  p.material = material.name;
  // Sizes cluster around the middle: use the mean of two uniform samples.
  const double size = 0.5 * (core::Uniform(rng) + core::Uniform(rng));
  const auto near_size = [&](double freedom) {
    return std::clamp(size + core::Uniform(rng, -freedom, freedom), 0.0, 1.0);
  };
  p.length = Sampled(category.length, near_size(0.15), category.source);
  p.width = Sampled(category.width, near_size(0.15), category.source);
  // The category's ranges may overlap: keep length the longer side, inside its own range.
  if (p.width.sample > p.length.sample) {
    p.width.sample = std::max(p.width.min, p.length.sample);
    p.length.sample = std::max(p.length.sample, p.width.sample);
  }
  p.height = Sampled(category.height, near_size(0.15), category.source);
  // Mass spans decades: interpolate its logarithm, driven by the size.
  p.mass = {category.mass.min, category.mass.max,
            std::clamp(
                category.mass.min * std::pow(category.mass.max / category.mass.min, near_size(0.2)),
                category.mass.min, category.mass.max),
            category.source};
  p.density = Sampled(material.density, core::Uniform(rng), material.source);
  p.friction = Sampled(material.friction, core::Uniform(rng), material.source);
  p.restitution = Sampled(material.restitution, core::Uniform(rng), material.source);
  p.intervals = StateIntervals(category, base);
  return p;
}

std::string ScaleMassToSize(const Category& category, const Eigen::Vector3d& size,
                            double solid_volume, PhysicalParameters* p) {
  const double sampled_box = p->length.sample * p->width.sample * p->height.sample;
  p->length.sample = std::max(size.x(), size.y());
  p->width.sample = std::min(size.x(), size.y());
  p->height.sample = size.z();
  if (category.name == "object") {
    constexpr double kHollowGoods = 250.0;  // kg/m^3
    p->mass.sample = kHollowGoods * solid_volume;
    p->mass.min = std::min(p->mass.min, p->mass.sample);
    p->mass.max = std::max(p->mass.max, p->mass.sample);
    return "";
  }
  p->mass.sample *= size.prod() / sampled_box;
  // A tenth beyond the range is still the same category.
  const auto fits = [](const Interval& range, double value) {
    return value >= 0.9 * range.min && value <= 1.1 * range.max;
  };
  if (fits(category.length, p->length.sample) && fits(category.width, p->width.sample) &&
      fits(category.height, p->height.sample)) {
    p->mass.sample = std::clamp(p->mass.sample, p->mass.min, p->mass.max);
    return "";
  }
  return "its size of " + RoundedText(p->length.sample) + " x " + RoundedText(p->width.sample) +
         " x " + RoundedText(size.z()) + " m is unusual for '" + category.name + "'";
}

MassModel ReconcileMass(const PhysicalParameters& parameters, const Category& category,
                        const KnowledgeBase& base, double volume, double area) {
  if (!(volume > 0.0) || !(area > 0.0)) {
    throw core::Error("the mass needs a solid with a volume", parameters.category);
  }
  const Material& material = *base.FindMaterial(parameters.material);
  MassModel model;
  model.material = material.name;
  model.mass = parameters.mass.sample;
  const double full_density = model.mass / volume;
  const std::string against = " in " + material.name + " of " + RoundedText(material.density.min) +
                              "-" + RoundedText(material.density.max) + " kg/m3";
  if (material.density.Contains(full_density)) {
    model.density = full_density;
    model.sentence = "full: " + RoundedText(full_density) + " kg/m3 over its volume lies" + against;
    return model;
  }
  if (full_density < material.density.min) {
    model.density = parameters.density.sample;
    if (model.mass == 0.0) {  // scaled by a bounding box without volume: an open, flat sheet
      model.mass = model.density * volume;
      model.within_range = category.mass.Contains(model.mass);
      model.sentence = "full: a flat sheet of " + RoundedText(model.density) + " kg/m3";
      return model;
    }
    model.wall_thickness = geometry::WallThickness(full_density / model.density, volume, area);
    model.sentence = "shell: " + RoundedText(full_density) + " kg/m3 over its volume is too light" +
                     against + ", so a wall of " + RoundedText(model.wall_thickness * 1e3) +
                     " mm carries the mass";
    return model;
  }
  // Too heavy for the sampled material: another of the row's materials may fit, else clamp.
  for (const std::string& name : category.materials) {
    const Material& other = *base.FindMaterial(name);
    if (other.density.Contains(full_density)) {
      model.material = other.name;
      model.density = full_density;
      model.sentence = "full: " + RoundedText(full_density) + " kg/m3 is too heavy" + against +
                       ", and fits " + other.name;
      return model;
    }
  }
  model.density = material.density.max;
  model.mass = model.density * volume;
  model.within_range = category.mass.Contains(model.mass);
  model.sentence = "full: " + RoundedText(full_density) + " kg/m3 would be too heavy" + against +
                   ", so the mass was lowered to " + RoundedText(model.mass) + " kg";
  return model;
}

}  // namespace simwright::physics_params
