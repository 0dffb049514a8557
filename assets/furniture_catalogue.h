#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include <Eigen/Core>

namespace simwright::assets {

// A piece of a Sweet Home 3D furniture catalogue (.sh3f: a zip with a properties file).
struct CataloguePiece {
  std::string id;        // unique in the catalogue, otherwise "#N"
  std::string name;      // e.g. "Coffee cup"
  std::string category;  // the catalogue's category, e.g. "Kitchen"
  std::string creator;
  std::string license;
  std::string model;                // the zip entry, e.g. "blendswap-cc-0/cup/cup.obj"
  Eigen::Vector3d size_m{0, 0, 0};  // upright width (x), depth (y), height (z), m
  // The rotation of the model (y up) applied before scaling to the size; identity if the catalogue
  // has none.
  Eigen::Matrix3d model_rotation = Eigen::Matrix3d::Identity();
};

// An open catalogue. Entries are read from memory-bounded streams; nothing is written outside
// the folder given to Extract.
class FurnitureCatalogue {
 public:
  // Throws core::Error if the file is missing, is not a zip, has no properties file or more than
  // 20,000 entries, or if an entry's name leaves the folder ("../", absolute).
  explicit FurnitureCatalogue(const std::filesystem::path& path);
  ~FurnitureCatalogue();
  FurnitureCatalogue(const FurnitureCatalogue&) = delete;
  FurnitureCatalogue& operator=(const FurnitureCatalogue&) = delete;

  const std::vector<CataloguePiece>& pieces() const { return pieces_; }

  // Unpacks the piece's model and the files beside it (materials, textures) into the existing
  // `folder`; returns the model's path there. Throws core::Error if an entry is missing, damaged or
  // unpacks to more than 512 MiB.
  std::filesystem::path Extract(const CataloguePiece& piece,
                                const std::filesystem::path& folder) const;

 private:
  struct Zip;
  std::unique_ptr<Zip> zip_;
  std::filesystem::path path_;
  std::vector<CataloguePiece> pieces_;
};

}  // namespace simwright::assets
