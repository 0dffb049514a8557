#include "physics_params/volume_mass.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <optional>
#include <string_view>

#include "core/error.h"
#include "physics_params/log_normal_mixture.h"
#include "physics_params/rounded_text.h"
#include "physics_params/stated_interval.h"

namespace simwright::physics_params {
namespace data {
std::string_view walls_txt();
}  // namespace data
namespace {

bool IsRange(const Interval& range) {
  return range.min > 0.0 && range.min <= range.max && std::isfinite(range.max);
}

void RequireValid(const VolumeMassInput& input, double probability) {
  const bool sized = input.volume > 0.0 && input.area > 0.0 && std::isfinite(input.volume) &&
                     std::isfinite(input.area) && input.volume_error >= 0.0;
  if (!sized || input.fillings.empty()) {
    throw core::Error("the mass of a volume needs a volume, an area and a material");
  }
  for (const Filling& one : input.fillings) {
    if (!(one.weight > 0.0) || !IsRange(one.density) || (one.shell && !IsRange(one.wall))) {
      throw core::Error("a filling needs a positive weight, density and wall", one.material);
    }
  }
  if (!(probability > 0.0 && probability < 1.0)) {
    throw core::Error("a stated probability must lie between 0 and 1");
  }
}

// Returns the share of the volume that a wall fills.
double WallShare(double wall, double volume, double area) {
  const double cavity = std::max(0.0, 1.0 - wall * area / (3.0 * volume));
  return 1.0 - cavity * cavity * cavity;
}

void AddFilling(const VolumeMassInput& input, const Filling& filling,
                std::vector<LogNormal>* mixture) {
  LogNormal density = LogNormalOf(filling.density, filling.weight);
  if (!filling.shell) {
    mixture->push_back({filling.weight, density.mean + std::log(input.volume),
                        std::hypot(density.deviation, input.volume_error)});
    return;
  }
  // A thin wall's mass has the area's error, 2/3 of the volume's; a thick one's has more.
  constexpr int kQuantiles = 200;
  const std::vector<LogNormal> wall = {LogNormalOf(filling.wall, 1.0)};
  for (int i = 0; i < kQuantiles; ++i) {
    const double thickness = MixtureQuantile(wall, (i + 0.5) / kQuantiles);
    const double share = WallShare(thickness, input.volume, input.area);
    const double error = (2.0 + share) / 3.0 * input.volume_error;
    mixture->push_back({filling.weight / kQuantiles, density.mean + std::log(share * input.volume),
                        std::hypot(density.deviation, error)});
  }
}

// Returns the material's usual wall, m; unset if it has none.
std::optional<Interval> UsualWall(std::string_view material) {
  constexpr double kMillimetre = 1e-3;
  std::string_view table = data::walls_txt();
  while (!table.empty()) {
    const size_t end = std::min(table.find('\n'), table.size());
    const std::string_view line = table.substr(0, end);
    table.remove_prefix(std::min(end + 1, table.size()));
    const size_t bar = line.find('|');
    if (line.empty() || line[0] == '#' || line.substr(0, bar) != material) continue;
    const std::string_view range = line.substr(bar + 1);
    const size_t dash = range.find('-');
    Interval wall;
    std::from_chars(range.data(), range.data() + dash, wall.min);
    std::from_chars(range.data() + dash + 1, range.data() + range.size(), wall.max);
    return Interval{wall.min * kMillimetre, wall.max * kMillimetre};
  }
  return std::nullopt;
}

// Returns true if a mesh of this mean thickness models the walls themselves.
bool ModelsItsWalls(const Interval& wall, double volume, double area) {
  constexpr double kSlack = 1.5;
  return 2.0 * volume / area <= kSlack * wall.max;
}

}  // namespace

VolumeMassOutput MassFromVolume(const VolumeMassInput& input, double probability) {
  RequireValid(input, probability);
  std::vector<LogNormal> mixture;
  double total = 0.0;
  for (const Filling& filling : input.fillings) total += filling.weight;
  for (Filling filling : input.fillings) {
    filling.weight /= total;
    AddFilling(input, filling, &mixture);
  }
  return {MixtureQuantile(mixture, 0.5), CentralInterval(mixture, probability)};
}

VolumeMassInput VolumeInputOf(const Category& category, const KnowledgeBase& base, double volume,
                              double area, double volume_error) {
  VolumeMassInput input{volume, area, volume_error, {}};
  double total = 0.0;
  for (size_t i = 0; i < category.materials.size(); ++i) total += 1.0 / static_cast<double>(i + 1);
  for (size_t i = 0; i < category.materials.size(); ++i) {
    const Material& material = *base.FindMaterial(category.materials[i]);
    Filling filling;
    filling.material = material.name;
    filling.weight = 1.0 / (static_cast<double>(i + 1) * total);
    filling.density = material.density;
    const std::optional<Interval> wall = UsualWall(material.name);
    const bool solid =
        category.fill == Fill::kSolid || !wall || ModelsItsWalls(*wall, volume, area);
    if (!solid) {
      if (category.fill == Fill::kFrame) {
        filling.weight *= 0.5;
        input.fillings.push_back(filling);
      }
      filling.shell = true;
      filling.wall = *wall;
    }
    input.fillings.push_back(filling);
  }
  return input;
}

MeasuredMass MassOfMeasured(const Category& category, const KnowledgeBase& base, double volume,
                            double area, double volume_error) {
  constexpr double kEach = 0.95;  // two of these hold together with 90 % at least
  const VolumeMassInput input = VolumeInputOf(category, base, volume, area, volume_error);
  const Interval by_volume = MassFromVolume(input, kEach).mass;
  const Interval by_name = StatedInterval(category, base, Quantity::kMass, kEach);
  MeasuredMass measured;
  measured.mass = {std::max(by_volume.min, by_name.min), std::min(by_volume.max, by_name.max)};
  const bool agree = measured.mass.min <= measured.mass.max;
  const Interval volume_alone = MassFromVolume(input, kStatedProbability).mass;
  if (!agree) measured.mass = volume_alone;
  for (const Interval& one : {volume_alone, StatedInterval(category, base, Quantity::kMass)}) {
    if (agree && one.max / one.min < measured.mass.max / measured.mass.min) measured.mass = one;
  }
  std::string materials;
  for (const std::string& name : category.materials) {
    materials += (materials.empty() ? "" : " or ") + name;
  }
  measured.sentence = "its measured volume of " + RoundedText(1e3 * volume) + " l in " + materials +
                      " weighs " + RoundedText(measured.mass.min) + " to " +
                      RoundedText(measured.mass.max) + " kg";
  if (!agree) {
    measured.sentence += ", unlike a '" + category.name + "' of " + RoundedText(by_name.min) +
                         " to " + RoundedText(by_name.max) + " kg";
  }
  return measured;
}

}  // namespace simwright::physics_params
