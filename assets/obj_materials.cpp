#include "assets/obj_materials.h"

#include <algorithm>
#include <map>
#include <sstream>

#include "assets/texture_files.h"
#include "core/error.h"
#include "core/files.h"

namespace simwright::assets {
namespace fs = std::filesystem;
namespace {

constexpr std::uint64_t kMaxLibraryBytes = 64ull << 20;

std::string Joined(const std::vector<std::string>& names) {
  std::string text;
  for (size_t i = 0; i < names.size() && i < 5; ++i) text += (i ? ", '" : "'") + names[i] + "'";
  if (names.size() > 5) text += " and " + std::to_string(names.size() - 5) + " more";
  return text;
}

class LibraryReader {
 public:
  LibraryReader(const fs::path& path, FindingList* findings)
      : path_(path), folder_(path.parent_path()), findings_(*findings) {}

  void ReadAll(const PreparedObj& obj) {
    for (const std::string& line : obj.libraries) ReadLine(line);
    if (read_ > 0 || obj.materials.empty()) return;
    const std::string own = path_.stem().string() + ".mtl";
    if (const auto found = FindSiblingFile(folder_, own)) {
      findings_.Add(core::Severity::kInfo, "mtl-guessed",
                    "the materials are taken from '" + own + "', which has the mesh's name",
                    "name it in the OBJ: mtllib " + own);
      Read(found->path);
    }
  }

  const MtlMaterial* Find(const std::string& name) const {
    const auto found = materials_.find(name);
    return found == materials_.end() ? nullptr : &found->second;
  }
  bool any() const { return read_ > 0; }

 private:
  // Reads a line that holds one name with spaces, or several names.
  void ReadLine(const std::string& line) {
    if (const auto found = FindSiblingFile(folder_, line)) {
      Say(*found, line);
      Read(found->path);
      return;
    }
    std::istringstream words(line);
    std::vector<std::string> missing;
    for (std::string word; words >> word;) {
      if (const auto found = FindSiblingFile(folder_, word)) {
        Say(*found, word);
        Read(found->path);
      } else {
        missing.push_back(word);
      }
    }
    if (missing.empty()) return;
    findings_.Add(core::Severity::kWarning, "mtl-missing",
                  "the material library " + Joined(missing) + " is not there",
                  "put it beside the OBJ");
  }

  void Say(const SiblingFile& found, const std::string& name) {
    if (found.as_named) return;
    findings_.Add(core::Severity::kInfo, "mtl-elsewhere",
                  "the material library '" + name + "' was found beside the mesh",
                  "if it is the wrong one, correct its name in the OBJ");
  }

  void Read(const fs::path& library) {
    try {
      for (MtlMaterial& material : ReadMtl(core::ReadFile(library, kMaxLibraryBytes))) {
        materials_[material.name] = std::move(material);
      }
      ++read_;
    } catch (const core::Error& error) {
      findings_.Add(core::Severity::kWarning, "mtl-unreadable",
                    std::string("a material library is ignored: ") + error.what(),
                    "export the OBJ again");
    }
  }

  fs::path path_, folder_;
  FindingList& findings_;
  std::map<std::string, MtlMaterial> materials_;
  int read_ = 0;
};

}  // namespace

std::vector<MtlMaterial> ReadObjMaterials(const fs::path& path, const PreparedObj& obj,
                                          FindingList* findings) {
  LibraryReader reader(path, findings);
  reader.ReadAll(obj);
  std::vector<MtlMaterial> materials;
  std::vector<std::string> missing;
  std::set<std::string> unread;
  for (const std::string& name : obj.materials) {
    const MtlMaterial* found = reader.Find(name);
    if (found == nullptr) missing.push_back(name);
    materials.push_back(found != nullptr ? *found : MtlMaterial{});
    materials.back().name = name;
    unread.insert(materials.back().unread.begin(), materials.back().unread.end());
  }
  if (!missing.empty()) {
    findings->Add(core::Severity::kWarning, "material-missing",
                  (missing.size() == 1 ? "the material " : "the materials ") + Joined(missing) +
                      (reader.any() ? " is in no library: grey" : " are in no library: grey"),
                  "put the .mtl beside the OBJ, or correct the names",
                  static_cast<double>(missing.size()));
  }
  if (!unread.empty()) {
    findings->Add(core::Severity::kInfo, "mtl-not-read",
                  "not read from the materials: " +
                      Joined(std::vector<std::string>(unread.begin(), unread.end())),
                  "bake the look into map_Kd where it matters", static_cast<double>(unread.size()));
  }
  return materials;
}

std::string NumberedLibrary(const std::vector<MtlMaterial>& materials) {
  std::string text;
  for (size_t i = 0; i < materials.size(); ++i) {
    text += "newmtl m" + std::to_string(i) + "\nKd 0.8 0.8 0.8\n";
  }
  return text;
}

}  // namespace simwright::assets
