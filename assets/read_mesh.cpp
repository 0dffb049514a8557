#include "assets/read_mesh.h"

#include <algorithm>
#include <cmath>

#include "assets/texture_files.h"
#include "core/error.h"

namespace simwright::assets {
namespace fs = std::filesystem;

void FindingList::Add(core::Severity severity, const std::string& code, const std::string& sentence,
                      const std::string& remedy, double figure) {
  const bool said = std::any_of(findings_.begin(), findings_.end(), [&](const auto& finding) {
    return finding.code == code && finding.sentence == sentence;
  });
  if (!said) findings_.push_back({code, severity, file_, sentence, figure, remedy});
}

void RawMesh::AddCornerColor(const CornerColor* color) {
  constexpr CornerColor kWhite{255, 255, 255, 255};
  if (color == nullptr && corner_colors.empty()) return;
  corner_colors.resize(mesh.corner_uvs.size() - 1, kWhite);
  corner_colors.push_back(color != nullptr ? *color : kWhite);
}

int VertexIndexer::Index(const Eigen::Vector3d& position) {
  // Adding 0.0 makes -0.0 and 0.0 the same position.
  const std::array<double, 3> key{position.x() + 0.0, position.y() + 0.0, position.z() + 0.0};
  const auto [entry, fresh] = index_of_.try_emplace(key, static_cast<int>(mesh_.vertices.size()));
  if (fresh) mesh_.vertices.emplace_back(key[0], key[1], key[2]);
  return entry->second;
}

bool ReadTextureFile(const fs::path& folder, const std::string& name, FindingList* findings,
                     core::Image* image) {
  const auto found = FindTextureFile(folder, name);
  if (!found) {
    findings->Add(core::Severity::kWarning, "texture-missing",
                  "the texture '" + name + "' is missing: its colour is ignored",
                  "put it beside the mesh or into a folder 'textures' beside it");
    return false;
  }
  if (!found->as_named) {
    findings->Add(core::Severity::kInfo, "texture-elsewhere",
                  "the texture '" + name + "' was found as '" +
                      found->path.lexically_relative(folder).string() + "'",
                  "if it is the wrong image, correct its name in the file");
  }
  core::ImageReadOptions options;
  options.max_side = kMaxTextureSide;
  try {
    *image = core::ReadImage(found->path, options);
    return true;
  } catch (const core::Error& error) {
    findings->Add(core::Severity::kWarning, "texture-unreadable",
                  std::string("a texture is ignored: ") + error.what(), "");
    return false;
  }
}

core::Image WithoutAlpha(const core::Image& image) {
  if (image.channels != 4) return image;
  core::Image opaque(image.width, image.height, 3);
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) std::copy_n(image.At(x, y), 3, opaque.At(x, y));
  }
  return opaque;
}

core::Image ChannelOf(const core::Image& image, int channel) {
  core::Image grey(image.width, image.height, 1);
  const int from = std::min(channel, image.channels - 1);
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) *grey.At(x, y) = image.At(x, y)[from];
  }
  return grey;
}

CornerColor ToCornerColor(const Eigen::Vector4f& color) {
  CornerColor result;
  for (int k = 0; k < 4; ++k) {
    const float value = std::isfinite(color[k]) ? std::clamp(color[k], 0.0f, 1.0f) : 1.0f;
    result[static_cast<size_t>(k)] = static_cast<std::uint8_t>(std::lround(255.0f * value));
  }
  return result;
}

}  // namespace simwright::assets
