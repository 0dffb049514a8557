#include "workflows/texture/texturing.h"

#include <algorithm>
#include <cstdio>
#include <memory>
#include <utility>

#include "asset_looks/asset_surfaces.h"
#include "asset_looks/exemplar_source.h"
#include "asset_looks/variant_look.h"
#include "asset_looks/variant_writing.h"
#include "assets/asset_folder.h"
#include "core/elapsed_time.h"
#include "core/error.h"
#include "core/files.h"
#include "core/image.h"
#include "texture/materials/material_bake.h"
#include "texture/painting/exemplar_bake.h"
#include "texture/painting/painting.h"

namespace simwright::workflows {
namespace fs = std::filesystem;
namespace {

constexpr int kMostVariants = 1000;
constexpr int kSheetColumns = 5;

std::string VariantName(const std::string& asset, int index) {
  char number[16];
  std::snprintf(number, sizeof number, "_%03d", index);
  return asset + number;
}

// The length of the asset's longest side, m.
double LengthOf(const asset_looks::AssetSurfaces& asset) {
  if (asset.rigid) return core::Bounds(asset.rigid->visual.mesh).sizes().maxCoeff();
  return assets::BoundsAtZero(*asset.articulated).sizes().maxCoeff();
}

class Texturing {
 public:
  Texturing(const TextureRequest& request, core::Progress* progress)
      : request_(request), progress_(progress) {}

  TextureReport Run() {
    const core::SteadyTime start = core::Now();
    asset_ = asset_looks::ReadAssetSurfaces(request_.asset, request_.size);
    report_.asset = asset_.name;
    report_.findings = asset_.findings;
    for (const asset_looks::TexturedSurface& surface : asset_.surfaces) {
      for (const std::uint8_t inside : surface.map.inside) report_.texels += inside;
    }
    ReadSources();
    RequireFreeOutput();
    if (asset_.articulated) {
      report_.findings.push_back({"texture-maps-left-out", core::Severity::kInfo, asset_.name,
                                  "maps of roughness, metal and relief are not written for "
                                  "articulated assets, whose links "
                                  "have a base colour alone"});
    }
    const core::Image original = asset_looks::ViewOf(asset_);
    report_.preparation = core::SecondsSince(start);
    pictures_ = {original};
    try {
      MakeVariants();
    } catch (const core::Cancelled&) {
      // One folder with all variants appears complete or not at all.
      if (request_.as_materials || report_.variants.empty()) throw;
      report_.interrupted = static_cast<int>(report_.variants.size()) < request_.variants;
      pictures_.resize(1 + report_.variants.size());
    }
    if (request_.as_materials) CommitAppearances();
    progress_->Finish();
    WriteSheet();
    return std::move(report_);
  }

 private:
  void MakeVariants() {
    // A generator's painting shows the progress of its views.
    if (!generator_) progress_->Stage("texture", request_.variants);
    for (int v = 0; v < request_.variants; ++v) {
      core::CheckCancelled();
      MakeVariant(v);
      if (!generator_) progress_->Advance();
    }
  }

  void ReadSources() {
    generator_ = request_.generator;
    if (!request_.prompt.empty() && !generator_) {
      words_ = asset_looks::ReadAssetWords(request_.prompt, asset_, &report_.findings);
    }
    if (request_.exemplar.empty() && request_.like.empty()) return;
    swatch_ =
        request_.like.empty()
            ? asset_looks::SwatchFromPhoto(request_.exemplar, LengthOf(asset_), &report_.findings)
            : asset_looks::SwatchFromAsset(request_.like, &report_.findings);
  }

  std::vector<fs::path> Folders() const {
    if (request_.as_materials) return {request_.output / asset_.name};
    std::vector<fs::path> folders;
    for (int v = 0; v < request_.variants; ++v) {
      folders.push_back(request_.output / VariantName(asset_.name, v));
    }
    return folders;
  }

  void RequireFreeOutput() const {
    if (request_.as_materials && !asset_.rigid) {
      throw core::Error("an articulated asset has its variants in folders", asset_.name,
                        "leave --as materials out");
    }
    for (const fs::path& folder : Folders()) {
      const bool is_asset = fs::exists(folder) && fs::exists(request_.asset) &&
                            fs::equivalent(folder, request_.asset);
      if (is_asset) {
        throw core::Error("the output would replace the asset itself", folder.string(),
                          "choose another folder with -o");
      }
      if (fs::exists(folder) && !request_.force) {
        throw core::Error("the output exists already", folder.string(),
                          "choose another folder, or replace it with --force");
      }
    }
  }

  void MakeVariant(int index) {
    const core::SteadyTime start = core::Now();
    TextureVariant variant;
    variant.seed = request_.seed + static_cast<std::uint64_t>(index);
    const asset_looks::VariantLook look =
        asset_looks::MakeVariantLook(asset_, words_, variant.seed);
    std::vector<texture::MaterialMaps> maps;
    double unseen = 0.0;
    for (std::size_t s = 0; s < asset_.surfaces.size(); ++s) {
      const asset_looks::TexturedSurface& surface = asset_.surfaces[s];
      if (surface.mesh.mesh.empty()) {
        maps.emplace_back();
        continue;
      }
      maps.push_back(texture::BakeMaterials(surface.mesh.mesh, surface.mesh.corner_uvs, surface.map,
                                            asset_looks::PlanOf(surface, look)));
      unseen += Paint(surface, look, variant.seed, &maps.back());
    }
    TakeGeneratorFindings();
    variant.unseen_share = unseen / static_cast<double>(std::max(1, report_.texels));
    for (std::size_t s = 0; s < asset_.slots.size(); ++s) {
      const std::string& slot = asset_.slots[s].material;
      const bool is_painted = SourceName() != "materials" && look.is_main[s];
      variant.materials.push_back((slot.empty() ? "surface" : slot) + ": " +
                                  (is_painted ? SourceName() : look.materials[s].name));
    }
    std::sort(variant.materials.begin(), variant.materials.end());
    variant.materials.erase(std::unique(variant.materials.begin(), variant.materials.end()),
                            variant.materials.end());
    if (request_.as_materials) {
      AddAppearance(index, maps, &variant);
    } else {
      Write(index, maps, &variant);
    }
    Compare(&variant);
    variant.seconds = core::SecondsSince(start);
    report_.variants.push_back(std::move(variant));
  }

  // Adds the findings of the generator, each of them once.
  void TakeGeneratorFindings() {
    if (!generator_) return;
    for (core::Finding& finding : generator_->TakeFindings()) {
      const bool is_known = std::any_of(
          report_.findings.begin(), report_.findings.end(), [&](const core::Finding& known) {
            return known.code == finding.code && known.place == finding.place &&
                   known.sentence == finding.sentence;
          });
      if (!is_known) report_.findings.push_back(std::move(finding));
    }
  }

  // Gives the main surfaces the colours of the exemplar, or of the generator where there is one;
  // returns the number of texels that no view saw.
  double Paint(const asset_looks::TexturedSurface& surface, const asset_looks::VariantLook& look,
               std::uint64_t seed, texture::MaterialMaps* maps) {
    bool any_main = false;
    for (const int slot : surface.triangle_slot) any_main |= look.is_main[slot];
    if (!any_main || (!generator_ && swatch_.picture.empty())) return 0.0;
    core::Image colors;
    double unseen_share = 0.0;
    if (generator_) {
      texture::PaintingOptions options;
      options.prompt = request_.prompt;
      options.exemplar = swatch_.picture;
      options.seed = seed * 1000003u;
      texture::Painting painting =
          texture::PaintTexture(surface.mesh, surface.map, options, generator_.get(), progress_);
      colors = std::move(painting.texture);
      unseen_share = painting.unseen_share;
    } else {
      colors = texture::BakeExemplar(surface.mesh.mesh, surface.map, swatch_, seed);
    }
    double inside = 0.0;
    for (std::size_t i = 0; i < surface.map.count(); ++i) {
      if (surface.map.triangle[i] < 0) continue;
      inside += surface.map.inside[i];
      const int slot = surface.triangle_slot[static_cast<std::size_t>(surface.map.triangle[i])];
      if (!look.is_main[slot]) continue;
      for (int c = 0; c < 3; ++c) maps->color.pixels[3 * i + c] = colors.pixels[3 * i + c];
    }
    texture::FillBetweenCharts(surface.map, texture::kGutter, &maps->color);
    return unseen_share * inside;
  }

  // Returns what colours the main surfaces.
  std::string SourceName() const {
    if (generator_) return generator_->name();
    return swatch_.picture.empty() ? "materials" : "exemplar";
  }

  core::OrderedJson RecordOf(const TextureVariant& variant) const {
    core::OrderedJson record;
    record["source"] = asset_.name;
    record["prompt"] = request_.prompt;
    if (!request_.exemplar.empty()) record["exemplar"] = request_.exemplar.filename().string();
    if (!request_.like.empty()) record["like"] = request_.like.filename().string();
    record["generator"] = SourceName();
    record["seed"] = variant.seed;
    record["size"] = request_.size;
    record["materials"] = variant.materials;
    return record;
  }

  void Write(int index, const std::vector<texture::MaterialMaps>& maps, TextureVariant* variant) {
    variant->name = VariantName(asset_.name, index);
    variant->folder = request_.output / variant->name;
    core::StagedFolder staged(variant->folder, request_.force);
    pictures_.push_back(asset_looks::WriteVariant(asset_, maps, variant->name, RecordOf(*variant),
                                                  request_.asset, staged.staging()));
    assets::AddFindings(staged.staging(), report_.findings);
    staged.Commit();
  }

  // Writes the maps of a variant into the one folder, which CommitAppearances completes.
  void AddAppearance(int index, const std::vector<texture::MaterialMaps>& maps,
                     TextureVariant* variant) {
    variant->name = asset_.name;
    variant->folder = request_.output / asset_.name;
    const core::OrderedJson record = RecordOf(*variant);
    if (!staged_) {
      staged_ = std::make_unique<core::StagedFolder>(variant->folder, request_.force);
      pictures_.push_back(asset_looks::WriteVariant(asset_, maps, asset_.name, record,
                                                    request_.asset, staged_->staging()));
    } else {
      pictures_.push_back(asset_looks::ViewOf(asset_, &maps.front()));
    }
    appearances_.push_back(asset_looks::WriteAppearance(
        maps.front(), static_cast<std::size_t>(index), record, staged_->staging()));
  }

  void CommitAppearances() {
    asset_looks::AddAppearances(appearances_, staged_->staging());
    assets::AddFindings(staged_->staging(), report_.findings);
    staged_->Commit();
  }

  void Compare(TextureVariant* variant) const {
    variant->from_asset = texture::ComparePictures(pictures_.front(), pictures_.back());
    variant->from_first = texture::ComparePictures(pictures_[1], pictures_.back());
  }

  void WriteSheet() {
    report_.sheet = request_.output / (asset_.name + "_sheet.png");
    const int columns = std::min(kSheetColumns, static_cast<int>(pictures_.size()));
    core::WritePng(report_.sheet, core::ContactSheet(pictures_, columns));
  }

  const TextureRequest& request_;
  core::Progress* progress_;
  asset_looks::AssetSurfaces asset_;
  texture::LookWords words_;
  std::shared_ptr<texture::ImageGenerator> generator_;
  texture::Swatch swatch_;                      // empty without an exemplar
  std::vector<core::Image> pictures_;           // of the asset, then of the variants
  std::unique_ptr<core::StagedFolder> staged_;  // the one folder of all variants
  std::vector<core::OrderedJson> appearances_;  // of asset.json
  TextureReport report_;
};

core::OrderedJson DistanceJson(const texture::PerceptualDistance& distance) {
  return {{"structure", distance.structure}, {"color_cielab", distance.color}};
}

}  // namespace

bool TextureRequest::IsValid(std::string* error) const {
  const auto fail = [error](const std::string& reason) {
    if (error) *error = reason;
    return false;
  };
  if (!exemplar.empty() && !like.empty()) return fail("both an exemplar and an asset are given");
  if (variants < 1 || variants > kMostVariants) return fail("there are 1 to 1000 variants");
  if (size < 64 || size > 4096) return fail("a texture has 64 to 4096 texels per side");
  if (generator && prompt.empty() && exemplar.empty() && like.empty()) {
    return fail("an image generator needs a prompt or an exemplar");
  }
  return true;
}

TextureReport TextureAsset(const TextureRequest& request, core::Progress* progress) {
  std::string error;
  if (!request.IsValid(&error)) throw core::Error("the asset cannot be textured: " + error);
  return Texturing(request, progress).Run();
}

std::string TextureTable(const TextureReport& report) {
  char line[256];
  std::snprintf(line, sizeof line, "%s: %d texels, prepared in %.1f s\n", report.asset.c_str(),
                report.texels, report.preparation);
  std::string text = line;
  std::snprintf(line, sizeof line, "%-28s %8s %12s %12s  %s\n", "variant", "seconds", "structure",
                "colour", "materials");
  text += line;
  for (const TextureVariant& variant : report.variants) {
    std::string materials;
    for (const std::string& one : variant.materials) {
      materials += (materials.empty() ? "" : ", ") + one;
    }
    std::snprintf(line, sizeof line, "%-28s %8.1f %12.3f %12.1f  ", variant.folder.c_str(),
                  variant.seconds, variant.from_first.structure, variant.from_first.color);
    text += line + materials + "\n";
  }
  text += "structure and colour: distance of a view to the first variant's (1 - MS-SSIM, CIELAB)\n";
  text += "sheet: " + report.sheet.string() + "\n";
  return text;
}

std::string TextureReportJson(const TextureReport& report) {
  core::OrderedJson json;
  json["asset"] = report.asset;
  json["texels"] = report.texels;
  json["preparation_s"] = report.preparation;
  json["sheet"] = report.sheet.string();
  json["interrupted"] = report.interrupted;
  json["variants"] = core::OrderedJson::array();
  for (const TextureVariant& variant : report.variants) {
    core::OrderedJson one;
    one["name"] = variant.name;
    one["folder"] = variant.folder.string();
    one["seed"] = variant.seed;
    one["seconds"] = variant.seconds;
    one["materials"] = variant.materials;
    one["unseen_share"] = variant.unseen_share;
    one["distance_from_asset"] = DistanceJson(variant.from_asset);
    one["distance_from_first"] = DistanceJson(variant.from_first);
    json["variants"].push_back(one);
  }
  return core::JsonText(json, core::InvalidUtf8::kReplace);
}

}  // namespace simwright::workflows
