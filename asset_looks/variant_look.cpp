#include "asset_looks/variant_look.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <set>

#include "core/random.h"
#include "texture/materials/named_materials.h"
#include "texture/materials/print_design.h"

namespace simwright::asset_looks {
namespace {

std::vector<std::string> WordsIn(const std::string& text) {
  std::vector<std::string> words;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t space = std::min(text.find(' ', at), text.size());
    if (space > at) words.push_back(text.substr(at, space - at));
    at = space + 1;
  }
  return words;
}

// FNV-1a: one stream of random numbers per name.
std::uint64_t NameHash(const std::string& name) {
  std::uint64_t hash = 1469598103934665603ull;
  for (const unsigned char c : name) hash = (hash ^ c) * 1099511628211ull;
  return hash >> 8;
}

// Surfaces of one family are made of one material: those of one name, and mouldings and switches of
// what they sit on.
std::string FamilyOf(const LookSlot& slot) {
  if (slot.material.empty()) return slot.substance;
  std::string family;
  for (const std::string& word : WordsIn(slot.material)) {
    if (word != "moulding" && word != "switch") family += (family.empty() ? "" : " ") + word;
  }
  return family.empty() ? slot.material : family;
}

// Words that name a part of the asset but no material or colour.
std::vector<std::string> PartWords(const AssetSurfaces& asset) {
  std::set<std::string> words;
  for (const LookSlot& slot : asset.slots) {
    if (!slot.part.empty()) words.insert(slot.part);
    if (slot.material.empty() || texture::IsNamedMaterial(slot.material)) continue;
    if (texture::NamedColor(slot.material)) continue;
    words.insert(slot.material);
  }
  // Parts that many objects have: named without being there, they are a finding.
  for (const char* name : {"handle", "lid", "door", "drawer", "knob", "leg", "seat", "body", "base",
                           "cap", "label", "blade", "shade", "button", "screen", "foot", "spout"}) {
    words.insert(name);
  }
  return {words.begin(), words.end()};
}

bool IsRegion(const std::string& target) {
  return target.empty() || target == "inside" || target == "outside" || target == "rim" ||
         target == "body";
}

bool IsNamed(const LookSlot& slot, const std::string& target) {
  return slot.part == target || slot.material == target;
}

// The slots that words about the whole object mean: the largest surface and those like it.
std::vector<bool> MainSlots(const AssetSurfaces& asset) {
  std::vector<bool> main(asset.slots.size(), false);
  if (asset.slots.empty()) return main;
  std::size_t largest = 0;
  double largest_area = -1.0;
  for (std::size_t s = 0; s < asset.slots.size(); ++s) {
    const double area = asset.slots[s].area * (asset.slots[s].IsFitting() ? 1e-3 : 1.0);
    if (area > largest_area) {
      largest = s;
      largest_area = area;
    }
  }
  for (std::size_t s = 0; s < asset.slots.size(); ++s) {
    const bool alike = asset.slots[s].material == asset.slots[largest].material;
    // Several paints of one object, such as a locomotive's, are its looks together.
    const bool large = asset.slots[s].area > 0.5 * asset.slots[largest].area;
    main[s] = s == largest || (!asset.slots[s].IsFitting() && (alike || large));
  }
  return main;
}

std::shared_ptr<const core::Image> PrintFor(const std::string& title,
                                            const texture::PartFrame& frame, bool is_label,
                                            core::Rng* rng) {
  texture::PrintDesign design;
  design.title = title;
  design.subtitle = std::to_string(50 * (2 + core::UniformIndex(*rng, 18))) + " g";
  const Eigen::Vector3f size = frame.box.sizes().cwiseMax(1e-4f);
  double aspect = std::max(size.x(), size.y()) / size.z();
  if (frame.round) aspect = 0.5 * M_PI * size.head<2>().maxCoeff() / size.z();
  if (is_label) aspect *= 2.0;
  if (!frame.round && size.z() < 0.5f * std::min(size.x(), size.y())) aspect = size.y() / size.x();
  aspect = std::clamp(aspect, 0.4, 3.0);
  const double side = 640.0;
  design.width = static_cast<int>(side * std::sqrt(aspect));
  design.height = static_cast<int>(side / std::sqrt(aspect));
  return std::make_shared<core::Image>(texture::DrawPrint(design, rng));
}

class LookMaker {
 public:
  LookMaker(const AssetSurfaces& asset, const texture::LookWords& words, std::uint64_t seed)
      : asset_(asset), words_(words), seed_(seed), main_(MainSlots(asset)) {}

  VariantLook Make() {
    look_.inside.assign(asset_.slots.size(), -1);
    look_.handle = look_.inside;
    look_.is_main = main_;
    look_.materials.resize(asset_.slots.size());
    for (std::size_t s = 0; s < asset_.slots.size(); ++s) MakeSlot(s);
    return std::move(look_);
  }

 private:
  // The largest frame of a slot among the asset's surfaces.
  const texture::PartFrame& FrameOf(std::size_t slot) const {
    const texture::PartFrame* best = nullptr;
    for (const TexturedSurface& surface : asset_.surfaces) {
      if (surface.slot_frames.empty()) continue;
      const texture::PartFrame& frame = surface.slot_frames[slot];
      if (!best || frame.box.isEmpty() ||
          frame.box.diagonal().norm() > best->box.diagonal().norm()) {
        if (!frame.box.isEmpty()) best = &frame;
      }
    }
    static const texture::PartFrame kNone;
    return best ? *best : kNone;
  }

  void MakeSlot(std::size_t s) {
    const LookSlot& slot = asset_.slots[s];
    // Equal names draw equal numbers, so that door and body are of one wood.
    const std::string key = FamilyOf(slot);
    core::Rng rng = core::StreamRng(seed_, NameHash(key));
    const std::string name = MaterialByRule(slot, asset_.category, &rng);
    // Seeds one after the other go through the colours in turn.
    texture::SurfaceMaterial material = texture::NamedMaterial(name, &rng, seed_ + NameHash(key));
    const texture::PartFrame& frame = FrameOf(s);
    const float side = frame.box.isEmpty() ? 0.1f : frame.box.sizes().maxCoeff();
    material.pattern_size = std::clamp(0.09f * side, 0.006f, 0.12f);
    const texture::SurfaceMaterial by_rule = material;
    if (words_.clauses.empty() && main_[s]) Decorate(s, &rng, &material);
    std::string text;
    bool wants_print = false, outside_only = false;
    for (const texture::LookClause& clause : words_.clauses) {
      const bool whole = clause.target.empty() || clause.target == "outside";
      const bool means = whole ? main_[s] : IsNamed(slot, clause.target);
      if (!means && !(clause.target == "body" && main_[s])) continue;
      if (clause.target == "outside") outside_only = true;
      core::Rng clause_rng = core::StreamRng(seed_, NameHash(clause.target + clause.material));
      const float pattern_size = material.pattern_size;
      material = texture::WithWords(clause, material, &clause_rng);
      material.pattern_size = pattern_size;
      text = clause.text.empty() ? text : clause.text;
      wants_print |= clause.printed;
    }
    if (main_[s]) AddRegions(s, by_rule, outside_only, &material);
    AddPrint(s, text, wants_print, frame, &rng, &material);
    look_.materials[s] = std::move(material);
  }

  // Draws what potters and weavers add: a light inside, a rim, stripes, dots, checks.
  void Decorate(std::size_t s, core::Rng* rng, texture::SurfaceMaterial* material) {
    const double draw = core::Uniform(*rng);
    const bool is_dark = material->color.mean() < 0.62f;
    if (material->substance == texture::Substance::kGlaze) {
      const Eigen::Vector3f white(0.94f, 0.93f, 0.89f), blue(0.16f, 0.29f, 0.50f);
      if (is_dark && draw < 0.45) {
        texture::SurfaceMaterial inner = *material;
        texture::SetColor(white, &inner);
        SetRegion(s, inner, &look_.inside);
      }
      material->pattern_color = is_dark ? white : blue;
      if (draw > 0.62 && draw < 0.76) material->pattern = texture::Pattern::kRim;
      if (draw > 0.76 && draw < 0.90) material->pattern = texture::Pattern::kStripes;
      if (draw > 0.90) material->pattern = texture::Pattern::kDots;
    }
    if (material->substance == texture::Substance::kFabric) {
      material->pattern_color =
          is_dark ? Eigen::Vector3f(0.86f, 0.83f, 0.76f) : Eigen::Vector3f(0.28f, 0.36f, 0.46f);
      if (draw < 0.16) material->pattern = texture::Pattern::kStripes;
      if (draw > 0.84) material->pattern = texture::Pattern::kPlaid;
    }
  }

  // The inside, the rim and the handle of the main slots.
  void AddRegions(std::size_t s, const texture::SurfaceMaterial& by_rule, bool outside_only,
                  texture::SurfaceMaterial* material) {
    const texture::SurfaceMaterial whole = *material;
    for (const texture::LookClause& clause : words_.clauses) {
      core::Rng rng = core::StreamRng(seed_, NameHash(clause.target + "@" + clause.material));
      texture::SurfaceMaterial part = whole;
      part.pattern = texture::Pattern::kNone;
      if (clause.target == "inside") {
        SetRegion(s, texture::WithWords(clause, part, &rng), &look_.inside);
      }
      if (clause.target == "handle" && HasHandle(s)) {
        SetRegion(s, texture::WithWords(clause, part, &rng), &look_.handle);
      }
      if (clause.target == "rim" && !clause.colors.empty()) {
        material->pattern = texture::Pattern::kRim;
        material->pattern_color = clause.colors.front();
        material->pattern_size *= 0.6f;
      }
    }
    if (outside_only && look_.inside[s] < 0) SetRegion(s, by_rule, &look_.inside);
  }

  bool HasHandle(std::size_t s) const {
    return asset_.handle_area[s] > 0.01 * asset_.slots[s].area;
  }

  void SetRegion(std::size_t s, const texture::SurfaceMaterial& material,
                 std::vector<int>* region) {
    (*region)[s] = static_cast<int>(look_.materials.size());
    look_.materials.push_back(material);
  }

  void AddPrint(std::size_t s, const std::string& text, bool wanted,
                const texture::PartFrame& frame, core::Rng* rng,
                texture::SurfaceMaterial* material) const {
    const bool is_print = material->substance == texture::Substance::kPrint;
    const std::string title = text.empty() ? PrintTitle(asset_.category, rng) : text;
    if (is_print) {
      material->print = PrintFor(title, frame, false, rng);
      return;
    }
    if (!wanted || !main_[s]) return;
    // A label on a material of another kind: the rest keeps the material's colour.
    const Eigen::Vector3f color = material->color;
    const float roughness = material->roughness;
    *material = texture::NamedMaterial("print", rng);
    material->color = color;
    material->roughness = roughness;
    material->print_is_label = frame.round;
    material->print = PrintFor(title, frame, frame.round, rng);
  }

  const AssetSurfaces& asset_;
  const texture::LookWords& words_;
  const std::uint64_t seed_;
  const std::vector<bool> main_;
  VariantLook look_;
};

// Materials that follow the whole object rather than each piece: a glaze runs from the rim of the
// pot, a print goes around the can.
bool FollowsTheWhole(texture::Substance substance) {
  using enum texture::Substance;
  switch (substance) {
    case kGlaze:
    case kClay:
    case kGlass:
    case kPrint:
    case kPaint:
    case kPlastic:
    case kFabric:
    case kFelt:
    case kPaper:
    case kMarble:
      return true;
    default:
      return false;
  }
}

void ReportUndrawnText(const std::string& text, core::Findings* findings) {
  const int count = texture::CharactersWithoutGlyph(text);
  if (count == 0) return;
  findings->push_back(
      {"texture-text-undrawn", core::Severity::kWarning, "--prompt",
       "the font of prints lacks characters of '" + text + "', which are printed as question marks",
       static_cast<double>(count), "write it with letters, digits and signs of ASCII"});
}

}  // namespace

texture::LookWords ReadAssetWords(const std::string& prompt, const AssetSurfaces& asset,
                                  core::Findings* findings) {
  std::vector<std::string> ignored = WordsIn(PlainWords(asset.category));
  ignored.push_back(PlainWords(asset.category));
  for (const std::string& word : WordsIn(PlainWords(asset.name))) ignored.push_back(word);
  for (const char* word : {"object", "thing", "asset", "item", "piece", "household"}) {
    ignored.emplace_back(word);
  }
  texture::LookWords words = texture::ReadLookWords(prompt, PartWords(asset), ignored);
  if (!words.unused.empty()) {
    std::string list;
    for (const std::string& word : words.unused) list += (list.empty() ? "'" : ", '") + word + "'";
    findings->push_back(
        {"texture-words-unused", core::Severity::kWarning, "--prompt",
         "the offline materials know nothing of " + list + ", which change nothing",
         static_cast<double>(words.unused.size()),
         "name materials, colours, patterns and finishes, or give an image generator"});
  }
  for (const texture::LookClause& clause : words.clauses) {
    ReportUndrawnText(clause.text, findings);
    if (IsRegion(clause.target) || clause.empty()) continue;
    bool is_there = std::any_of(asset.slots.begin(), asset.slots.end(),
                                [&](const LookSlot& slot) { return IsNamed(slot, clause.target); });
    for (std::size_t s = 0; s < asset.slots.size(); ++s) {
      is_there |= clause.target == "handle" && asset.handle_area[s] > 0.01 * asset.slots[s].area;
    }
    if (is_there) continue;
    findings->push_back({"texture-part-missing", core::Severity::kWarning, asset.name,
                         "the asset has no separate part '" + clause.target +
                             "', and the words about it are not used",
                         0.0, "leave them out, or split the mesh into named parts"});
  }
  return words;
}

VariantLook MakeVariantLook(const AssetSurfaces& asset, const texture::LookWords& words,
                            std::uint64_t seed) {
  return LookMaker(asset, words, seed).Make();
}

texture::MaterialPlan PlanOf(const TexturedSurface& surface, const VariantLook& look) {
  texture::MaterialPlan plan;
  plan.materials = look.materials;
  plan.inside_material = look.inside;
  plan.handle_material = look.handle;
  plan.inside_material.resize(plan.materials.size(), -1);
  plan.handle_material.resize(plan.materials.size(), -1);
  plan.frames = surface.pieces.frames;
  const int first_slot_frame = static_cast<int>(plan.frames.size());
  plan.frames.insert(plan.frames.end(), surface.slot_frames.begin(), surface.slot_frames.end());
  plan.triangle_material = surface.triangle_slot;
  for (std::size_t t = 0; t < surface.triangle_slot.size(); ++t) {
    const int slot = surface.triangle_slot[t];
    const texture::Substance substance = plan.materials[static_cast<std::size_t>(slot)].substance;
    plan.triangle_frame.push_back(FollowsTheWhole(substance) ? first_slot_frame + slot
                                                             : surface.pieces.triangle_frame[t]);
  }
  return plan;
}

}  // namespace simwright::asset_looks
