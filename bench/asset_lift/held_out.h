#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "made_photos.h"

namespace simwright::bench {

// A catalogue's piece that no training has seen.
struct HeldOutPiece {
  std::string catalogue;  // file name below the furniture folder
  std::string id, name;   // as in the catalogue
};

// The pieces of BlendSwap-CC-BY.sh3f and KatorLegaz.sh3f (in this order, and in the catalogues'
// own) that
//   - are 3 cm to 0.9 m long,
//   - have a name which the knowledge base knows and which no piece of the training catalogue
//     BlendSwap-CC-0.sh3f has, case apart: the split is by object,
//   - are the first of their name,
//   - have a texture, or a colour that is not grey, or two colours.
// More than `limit` are thinned evenly. Throws core::Error where a catalogue cannot be read.
std::vector<HeldOutPiece> ChooseHeldOut(const std::filesystem::path& furniture, int limit);

// A line a piece: catalogue, id and name, tabs between; lines that begin with # are comments.
// Reading throws core::Error for a line of another form, or a file without pieces.
std::vector<HeldOutPiece> ReadHeldOut(const std::filesystem::path& file);
void WriteHeldOut(const std::vector<HeldOutPiece>& pieces, const std::filesystem::path& file);

// The pieces' meshes with what a lift is told of their categories, in the list's order. Throws
// core::Error where one is missing, has no mesh, or its name leads to no category.
std::vector<CatalogueObject> LoadHeldOut(const std::vector<HeldOutPiece>& pieces,
                                         const std::filesystem::path& furniture);

}  // namespace simwright::bench
